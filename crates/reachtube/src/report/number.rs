//! Numbers as a reader meets them: few digits, and the bounds of a set never rounded inward.

use super::Bounds;

/// `value` to `digits` significant digits, without trailing zeros; with an exponent where it is far
/// from 1.
pub(super) fn short(value: f64, digits: usize) -> String {
    if value == 0.0 {
        return "0".into();
    }
    let exponent = value.abs().log10().floor() as i32;
    if !(-4..=5).contains(&exponent) {
        return format!("{value:.*e}", digits.saturating_sub(1));
    }
    let decimals = (digits as i32 - 1 - exponent).max(0) as usize;
    trim(format!("{value:.decimals$}"))
}

fn trim(text: String) -> String {
    if !text.contains('.') {
        return text;
    }
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0".into() } else { text.into() }
}

/// The label of a tick on an axis that spans `span`.
pub(super) fn tick(value: f64, span: f64) -> String {
    if value.abs() < 1e-9 * span {
        return "0".into();
    }
    if !(1e-3..1e6).contains(&span) {
        return short(value, 2);
    }
    let decimals = (1 - span.log10().floor() as i32).max(0) as usize;
    trim(format!("{value:.decimals$}"))
}

/// Decimals that show three digits of the largest bound of a column, and at least the paper's four.
pub(super) fn decimals(column: &[Bounds]) -> usize {
    let largest = column.iter().flatten().fold(0.0_f64, |most, bound| most.max(bound.abs()));
    if largest == 0.0 { 4 } else { (2 - largest.log10().floor() as i32).clamp(4, 12) as usize }
}

/// `[lower, upper]` with `decimals` decimals.
///
/// # Guarantee
///
/// Outer: the printed bounds, read back as `f64`, enclose the interval.
pub(super) fn outward(bounds: Bounds, decimals: usize) -> [String; 2] {
    let upper = downward(-bounds[1], decimals);
    let upper = match upper.strip_prefix('-') {
        Some(positive) => positive.to_string(),
        None if upper == "0" => upper,
        None => format!("-{upper}"),
    };
    [downward(bounds[0], decimals), upper]
}

/// The largest decimal of so many decimals that is not above `value`.
fn downward(value: f64, decimals: usize) -> String {
    if value == 0.0 {
        return "0".into();
    }
    let nearest = format!("{value:.decimals$}");
    let read: f64 = nearest.parse().unwrap_or(f64::NAN);
    let text = if read <= value {
        nearest
    } else {
        format!("{:.decimals$}", read - 10f64.powi(-(decimals as i32)))
    };
    if text.parse() == Ok(0.0) { "0".into() } else { text }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn printed_bounds_enclose(a in -1e4..1e4_f64, width in 0.0..1e-2_f64, decimals in 1..8_usize) {
            let printed = outward([a, a + width], decimals).map(|text| text.parse::<f64>().unwrap());
            prop_assert!(printed[0] <= a && a + width <= printed[1]);
            let digit = 10f64.powi(-(decimals as i32));
            prop_assert!(a - printed[0] <= 1.000_001 * digit && printed[1] - (a + width) <= 1.000_001 * digit);
        }

        #[test]
        fn short_keeps_the_digits(value in -1e8..1e8_f64) {
            let read: f64 = short(value, 4).parse().unwrap();
            prop_assert!((read - value).abs() <= 5.1e-4 * value.abs());
        }
    }

    #[test]
    fn table_two_prints_as_printed_in_the_paper() {
        assert_eq!(outward([-0.0317, 1.2140], 4), ["-0.0317", "1.2140"]);
        assert_eq!(outward([0.0, 0.0], 4), ["0", "0"]);
        assert_eq!(outward([-0.00311, 0.00311], 4), ["-0.0032", "0.0032"]);
        assert_eq!(outward([-0.5, -0.12345], 4), ["-0.5000", "-0.1234"]);
        assert_eq!(outward([0.00001, 0.00002], 4), ["0", "0.0001"]);
        assert_eq!(outward([-0.00002, -0.00001], 4), ["-0.0001", "0"]);
    }

    #[test]
    fn decimals_follow_the_largest_bound() {
        assert_eq!(decimals(&[[-1.0, 7.1559]]), 4);
        assert_eq!(decimals(&[[-0.0075, 0.0012]]), 5);
        assert_eq!(decimals(&[[0.0, 0.0]]), 4);
    }

    #[test]
    fn ticks_have_the_digits_of_their_step() {
        assert_eq!(tick(0.300_000_000_000_000_04, 0.8), "0.3");
        assert_eq!(tick(-0.25, 1.1), "-0.2");
        assert_eq!(tick(1e-17, 1.0), "0");
        assert_eq!(tick(2e-5, 1e-4), "2.0e-5");
    }

    #[test]
    fn short_numbers() {
        assert_eq!(short(3.744, 4), "3.744");
        assert_eq!(short(0.25, 4), "0.25");
        assert_eq!(short(1.25e-7, 3), "1.25e-7");
        assert_eq!(short(1200.0, 2), "1200");
    }
}
