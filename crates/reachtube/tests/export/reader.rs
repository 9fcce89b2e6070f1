//! Readers of polynomials and numbers, which share no code with the writers.

use reachtube::export::{Factor, Polynomial, Term};

/// Reads a sum of terms such as `+ 1.5*qd1^2*(u1 - 0.25)`; `variable` knows the texts of variables.
pub(crate) fn polynomial(text: &str, variable: &dyn Fn(&str) -> Option<usize>) -> Polynomial {
    let mut terms = Vec::new();
    let mut sign = 1.0;
    for part in split(text, ' ') {
        match part.as_str() {
            "" | "+" => {}
            "-" => sign = -1.0,
            part => {
                terms.push(term(sign, part, variable));
                sign = 1.0;
            }
        }
    }
    // A zero stands for an empty sum, and starts some others.
    terms.retain(|term: &Term| term.coefficient != 0.0);
    Polynomial { terms }
}

fn term(sign: f64, text: &str, variable: &dyn Fn(&str) -> Option<usize>) -> Term {
    let mut factors = split(text, '*').into_iter();
    let coefficient = sign * number(&factors.next().unwrap());
    Term { coefficient, factors: factors.map(|text| factor(&text, variable)).collect() }
}

fn factor(text: &str, variable: &dyn Fn(&str) -> Option<usize>) -> Factor {
    let parts = split(text, '^');
    let power = parts.get(1).map_or(1, |power| power.parse().unwrap());
    if let Some(variable) = variable(&parts[0]) {
        return Factor { variable, origin: 0.0, power };
    }
    let inner = parts[0].strip_prefix('(').unwrap().strip_suffix(')').unwrap();
    let words = split(inner, ' ');
    let [name, sign, origin] = &words[..] else { panic!("{text}") };
    let sign = if sign == "-" { 1.0 } else { -1.0 };
    Factor { variable: variable(name).expect(text), origin: sign * number(origin), power }
}

/// Splits at a separator outside of brackets.
fn split(text: &str, separator: char) -> Vec<String> {
    let (mut parts, mut depth) = (vec![String::new()], 0);
    for c in text.chars() {
        match c {
            '(' | '[' => depth += 1,
            ')' | ']' => depth -= 1,
            _ => {}
        }
        match c == separator && depth == 0 {
            true => parts.push(String::new()),
            false => parts.last_mut().unwrap().push(c),
        }
    }
    parts
}

pub(crate) fn number(text: &str) -> f64 {
    text.trim().parse().unwrap_or_else(|_| panic!("\"{text}\" is no number"))
}

/// Reads every number between `start` and `end`, in their order.
pub(crate) fn numbers_between(text: &str, start: &str, end: &str) -> Vec<f64> {
    let between = between(text, start, end);
    let words = between.split(|c: char| c.is_whitespace() || "[],;".contains(c));
    words.filter(|word| !word.is_empty()).map(number).collect()
}

/// Returns the text between `start` and the next `end`.
pub(crate) fn between<'a>(text: &'a str, start: &str, end: &str) -> &'a str {
    let from = text.find(start).unwrap_or_else(|| panic!("no {start}")) + start.len();
    let length = text[from..].find(end).unwrap_or_else(|| panic!("no {end} after {start}"));
    &text[from..from + length]
}

/// Asserts that two lists have the same bits.
pub(crate) fn assert_bits(read: &[f64], written: &[f64], what: &str) {
    let bits = |values: &[f64]| values.iter().map(|value| value.to_bits()).collect::<Vec<_>>();
    assert_eq!(bits(read), bits(written), "{what}: {read:?} is not {written:?}");
}
