//! Numbers and counts in few digits.

/// Magnitude below which four decimals would hide a number.
pub(super) const SMALL: f64 = 1e-3;

/// Magnitude below which six decimals would hide a number.
pub(super) const TINY: f64 = 1e-5;

/// Magnitude from which decimals carry no information.
pub(super) const LARGE: f64 = 1e5;

/// Decimals of the uncertainty sets in Table II of the paper.
const PAPER_DECIMALS: i32 = 4;

/// Formats a number for prose: with four digits before and after the point together, and at most
/// four decimals; all digits before the point; with an exponent where it is very small or large.
///
/// # Examples
///
/// ```
/// use reachtube_scalar::number::four_decimals;
///
/// assert_eq!([-0.25, 2.1e-9].map(four_decimals), ["-0.2500", "2.1e-9"]);
/// assert_eq!([6048.047985, 36.123].map(four_decimals), ["6048", "36.12"]);
/// ```
#[must_use]
pub fn four_decimals(value: f64) -> String {
    match value.abs() {
        0.0 => "0".into(),
        size if (SMALL..LARGE).contains(&size) => {
            let whole = if size < 1.0 { 0 } else { 1 + size.log10().floor() as usize };
            format!("{value:.*}", 4usize.saturating_sub(whole))
        }
        _ => format!("{value:.1e}"),
    }
}

/// Formats a number as it was typed, rounded to at most six significant digits.
#[must_use]
pub fn six_digits(value: f64) -> String {
    let rounded = format!("{value:.5e}").parse::<f64>().unwrap_or(value);
    if rounded != 0.0 && rounded.abs() < SMALL {
        format!("{rounded:e}")
    } else {
        rounded.to_string()
    }
}

/// Returns the word in the number that `count` asks for.
#[must_use]
pub fn plural(count: usize, word: &str) -> String {
    format!("{word}{}", if count == 1 { "" } else { "s" })
}

/// Returns a number with its word.
///
/// # Examples
///
/// ```
/// use reachtube_scalar::number::counted;
///
/// assert_eq!([1, 3].map(|count| counted(count, "suite")), ["1 suite", "3 suites"]);
/// ```
#[must_use]
pub fn counted(count: usize, word: &str) -> String {
    format!("{count} {}", plural(count, word))
}

/// Formats a number with `decimals` decimals; a result of zero has no sign.
#[must_use]
pub fn fixed(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$}");
    text.strip_prefix('-')
        .filter(|rest| rest.bytes().all(|b| b == b'0' || b == b'.'))
        .map_or(text.clone(), String::from)
}

/// Formats a number with `digits` significant digits and without trailing zeros; below 1e-4 and
/// from 1e6 on with an exponent.
#[must_use]
pub fn significant(value: f64, digits: usize) -> String {
    if value == 0.0 {
        return "0".into();
    }
    let exponent = value.abs().log10().floor() as i32;
    if !(-4..=5).contains(&exponent) {
        return format!("{value:.*e}", digits.saturating_sub(1));
    }
    let decimals = (digits as i32 - 1 - exponent).max(0) as usize;
    without_trailing_zeros(format!("{value:.decimals$}"))
}

/// Formats the label of a tick at `value` on an axis of length `span`, in the axis' unit.
#[must_use]
pub fn tick_label(value: f64, span: f64) -> String {
    if value.abs() < 1e-9 * span {
        return "0".into();
    }
    if !(1e-3..1e6).contains(&span) {
        return significant(value, 2);
    }
    let decimals = (1 - span.log10().floor() as i32).max(0) as usize;
    without_trailing_zeros(format!("{value:.decimals$}"))
}

fn without_trailing_zeros(text: String) -> String {
    if !text.contains('.') {
        return text;
    }
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0".into() } else { text.into() }
}

/// Returns the number of decimals that shows three digits of the largest bound of a table's
/// column: 4, as in the paper's Table II, to 12.
#[must_use]
pub fn column_decimals(column: &[[f64; 2]]) -> usize {
    let largest = column.iter().flatten().fold(0.0_f64, |most, bound| most.max(bound.abs()));
    if largest == 0.0 {
        PAPER_DECIMALS as usize
    } else {
        (2 - largest.log10().floor() as i32).clamp(PAPER_DECIMALS, 12) as usize
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn significant_digits_are_kept(value in -1e8..1e8_f64) {
            let read: f64 = significant(value, 4).parse().unwrap();
            prop_assert!((read - value).abs() <= 5.1e-4 * value.abs());
        }
    }

    #[test]
    fn small_numbers_keep_their_digits() {
        let shown = [0.0, 2.1e-9, -0.25, 12.34567, 3.2e7].map(four_decimals);
        assert_eq!(shown, ["0", "2.1e-9", "-0.2500", "12.35", "3.2e7"]);
        let shown = [0.99999, 9.99999, 999.96, 4687.9665].map(four_decimals);
        assert_eq!(shown, ["1.0000", "10.000", "1000.0", "4688"]);
    }

    #[test]
    fn long_numbers_are_rounded_and_short_ones_kept() {
        let shown = [0.0, 0.079, -23.13210017081165, 4.1e-18, 160.0].map(six_digits);
        assert_eq!(shown, ["0", "0.079", "-23.1321", "4.1e-18", "160"]);
    }

    #[test]
    fn decimals_follow_the_largest_bound() {
        assert_eq!(column_decimals(&[[-1.0, 7.1559]]), 4);
        assert_eq!(column_decimals(&[[-0.0075, 0.0012]]), 5);
        assert_eq!(column_decimals(&[[0.0, 0.0]]), 4);
    }

    #[test]
    fn ticks_have_the_digits_of_their_step() {
        assert_eq!(tick_label(0.300_000_000_000_000_04, 0.8), "0.3");
        assert_eq!(tick_label(-0.25, 1.1), "-0.2");
        assert_eq!(tick_label(1e-17, 1.0), "0");
        assert_eq!(tick_label(2e-5, 1e-4), "2.0e-5");
    }

    #[test]
    fn significant_digits_have_no_trailing_zeros() {
        assert_eq!(significant(3.744, 4), "3.744");
        assert_eq!(significant(0.25, 4), "0.25");
        assert_eq!(significant(1.25e-7, 3), "1.25e-7");
        assert_eq!(significant(1200.0, 2), "1200");
    }
}
