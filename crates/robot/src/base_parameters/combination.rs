//! Combinations of parameters as formulas.

use crate::parameter::Parameter;

/// Relative distance up to which a coefficient is printed as a nearby short number.
const SNAP: f64 = 1e-9;

/// Formats a row of K as `Ixx2 - Iyy2 + Izz2 + J2`, with the independent parameter `leader` first
/// and terms of equal coefficients in brackets.
pub(super) fn format_combination(parameters: &[Parameter], leader: usize, row: &[f64]) -> String {
    // Terms of equal magnitude form a group: (magnitude, [(sign, index)]).
    let mut groups: Vec<(f64, Vec<(f64, usize)>)> = vec![(1.0, vec![(1.0, leader)])];
    for (k, &value) in row.iter().enumerate().filter(|(k, v)| *k != leader && v.abs() > SNAP) {
        let same =
            groups.iter_mut().find(|(size, _)| (*size - value.abs()).abs() <= SNAP * size.max(1.0));
        match same {
            Some((_, members)) => members.push((value.signum(), k)),
            None => groups.push((value.abs(), vec![(value.signum(), k)])),
        }
    }
    let mut out = String::new();
    for (size, members) in groups {
        let factor = ReadableFactor::of(size);
        let bracket = members.len() > 1 && factor != ReadableFactor::One;
        let outer = if bracket { members[0].0 } else { 1.0 };
        let names: Vec<_> =
            members.iter().map(|(sign, k)| (sign * outer, parameters[*k].to_string())).collect();
        if bracket {
            out += &term(outer, &factor.times(&format!("({})", sum(&names))), out.is_empty());
        } else {
            for (sign, name) in names {
                out += &term(sign, &factor.times(&name), out.is_empty());
            }
        }
    }
    out
}

fn sum(terms: &[(f64, String)]) -> String {
    terms.iter().enumerate().map(|(i, (sign, name))| term(*sign, name, i == 0)).collect()
}

fn term(sign: f64, what: &str, first: bool) -> String {
    match (first, sign < 0.0) {
        (true, false) => what.into(),
        (true, true) => format!("-{what}"),
        (false, false) => format!(" + {what}"),
        (false, true) => format!(" - {what}"),
    }
}

/// Number of digits of a length that is squared or a divisor. With more digits, an arbitrary number
/// would have such a form by chance.
const LENGTH: i32 = 5;

/// A positive coefficient in a readable form.
#[derive(Debug, PartialEq)]
enum ReadableFactor {
    One,
    Times(String),
    Over(String),
}

impl ReadableFactor {
    /// Returns the form with the fewest digits: the number, its inverse, a square or an inverse
    /// square.
    fn of(size: f64) -> Self {
        if (size - 1.0).abs() <= SNAP {
            return Self::One;
        }
        let (inverse, root) = (1.0 / size, size.sqrt());
        let squared = |(cost, text): (i32, String)| (cost + 1, format!("{text}²"));
        let forms = [
            shortest(size, 7).map(|(cost, text)| (cost, Self::Times(text))),
            shortest(inverse, LENGTH).map(|(cost, text)| (cost + 1, Self::Over(text))),
            shortest(root, LENGTH).map(squared).map(|(cost, text)| (cost, Self::Times(text))),
            shortest(1.0 / root, LENGTH)
                .map(squared)
                .map(|(cost, text)| (cost + 1, Self::Over(text))),
        ];
        let best = forms.into_iter().flatten().min_by_key(|(cost, _)| *cost);
        best.map_or_else(|| Self::Times(rounded(size, 1e6).to_string()), |(_, factor)| factor)
    }

    fn times(&self, what: &str) -> String {
        match self {
            Self::One => what.into(),
            Self::Times(factor) => format!("{factor} {what}"),
            Self::Over(divisor) => format!("{what}/{divisor}"),
        }
    }
}

/// Returns the smallest number of digits, up to `most`, that represents x, and x with these digits.
fn shortest(x: f64, most: i32) -> Option<(i32, String)> {
    (1..=most).find_map(|digits| {
        let unit = 10f64.powi(digits - 1 - x.log10().floor() as i32);
        let rounded = rounded(x, unit);
        ((rounded - x).abs() <= SNAP * x).then(|| (digits, rounded.to_string()))
    })
}

/// Returns the multiple of 1/`unit` nearest to x.
fn rounded(x: f64, unit: f64) -> f64 {
    (x * unit).round() / unit
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn coefficients_have_their_shortest_form() {
        let formatted = |x: f64| ReadableFactor::of(x).times("x");
        let third = "0.333333 x";
        let cases = [
            (1.0, "x"),
            (0.3012, "0.3012 x"),
            (0.3012 * 0.3012, "0.3012² x"),
            (2.0, "2 x"),
            (1.0 / 0.35, "x/0.35"),
            (0.384 * 0.384 + 0.0825 * 0.0825, "0.154262 x"),
        ];
        cases.iter().for_each(|(x, text)| assert_eq!(formatted(*x), *text));
        assert_eq!(formatted(1.0 / (0.35 * 0.35)), "x/0.35²");
        assert_eq!(formatted(0.25), "0.25 x");
        assert_eq!(formatted(0.089159), "0.089159 x");
        assert_eq!(formatted(1.0 / 3.0 + 1e-7), third);
    }
}
