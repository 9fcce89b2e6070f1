//! Sizes and intervals, rounded outward.

use super::digits::{LARGE, SMALL, TINY, fixed, four_decimals};

/// Sizes whose two digits decimals show.
const DECIMALS_SHOW: std::ops::Range<f64> = 1e-4..1e6;

/// Formats an interval by its ends, or by centre ± radius where its ends would look equal.
///
/// # Guarantee
///
/// Outer: the printed ends, or centre and radius, read back as `f64`, enclose the interval.
///
/// # Examples
///
/// ```
/// use reachtube_scalar::number::interval;
///
/// assert_eq!(interval((-0.10001, 0.25)), "[-0.1001, 0.2500]");
/// assert_eq!(interval((0.5, 0.5)), "0.5000");
/// ```
#[must_use]
pub fn interval((low, high): (f64, f64)) -> String {
    let (size, radius) = (low.abs().max(high.abs()), 0.5 * (high - low));
    if low == high {
        let short = four_decimals(low);
        return if short.parse() == Ok(low) { short } else { format!("{low:e}") };
    }
    // The width has three digits, and no end has more than four decimals without need.
    let digits = (2.0 - radius.log10().floor()).clamp(4.0, 17.0) as usize;
    if radius < SMALL * size && size < LARGE {
        return about(low, high, digits);
    }
    if !(TINY..LARGE).contains(&size) {
        return format!(
            "[{}, {}]",
            downward_with_exponent(low),
            upward(high, downward_with_exponent)
        );
    }
    let [low, high] = outward([low, high], digits.min(7));
    format!("[{low}, {high}]")
}

/// Formats an interval as centre ± radius, the radius rounded up.
fn about(low: f64, high: f64, decimals: usize) -> String {
    let centre = fixed(0.5 * (low + high), decimals);
    let read: f64 = centre.parse().unwrap_or(f64::NAN);
    // Differences of numbers this close are exact.
    let radius = (high - read).max(read - low);
    let two_digits = |value| downward_to(value, |value| format!("{value:.1e}"));
    format!("{centre} ± {}", upward(radius, two_digits))
}

/// Formats a radius or width like [`four_decimals`], rounded up.
///
/// # Examples
///
/// ```
/// use reachtube_scalar::number::at_least;
///
/// assert_eq!([0.25, 0.00201, 2.14e-9].map(at_least), ["0.2500", "0.0021", "2.2e-9"]);
/// ```
#[must_use]
pub fn at_least(value: f64) -> String {
    upward(value, |value| downward_to(value, four_decimals))
}

/// Formats a size in two digits, rounded up.
///
/// # Examples
///
/// ```
/// use reachtube_scalar::number::two_digits_up;
///
/// assert_eq!([1.91, 0.0312, 2.14e-9].map(two_digits_up), ["2.0", "0.032", "2.2e-9"]);
/// ```
#[must_use]
pub fn two_digits_up(size: f64) -> String {
    if size == 0.0 {
        return "0".into();
    }
    if !DECIMALS_SHOW.contains(&size) {
        return at_least(size);
    }
    let [_, up] = outward([0.0, size], decimals_of_two_digits(size));
    up
}

/// Formats an interval so that its larger bound has two digits, rounded outward.
///
/// # Examples
///
/// ```
/// use reachtube_scalar::number::two_digits_outward;
///
/// assert_eq!(two_digits_outward((-5.661, 7.612)), "[-5.7, 7.7]");
/// ```
#[must_use]
pub fn two_digits_outward((low, high): (f64, f64)) -> String {
    let size = high.max(-low);
    if low == high && low == 0.0 {
        return "0".into();
    }
    if !DECIMALS_SHOW.contains(&size) {
        return interval((low, high));
    }
    let [low, high] = outward([low, high], decimals_of_two_digits(size));
    format!("[{low}, {high}]")
}

fn decimals_of_two_digits(size: f64) -> usize {
    (1.0 - size.log10().floor()).clamp(0.0, 6.0) as usize
}

/// Formats the bounds `[lower, upper]` with `decimals` decimals, each rounded away from the
/// interval.
///
/// # Guarantee
///
/// Outer: the printed bounds, read back as `f64`, enclose the interval.
///
/// # Examples
///
/// ```
/// use reachtube_scalar::number::outward;
///
/// assert_eq!(outward([-0.00311, 0.00311], 4), ["-0.0032", "0.0032"]);
/// ```
#[must_use]
pub fn outward(bounds: [f64; 2], decimals: usize) -> [String; 2] {
    [downward(bounds[0], decimals), upward(bounds[1], |value| downward(value, decimals))]
}

/// Rounds up where `downward` rounds down.
fn upward(value: f64, downward: impl Fn(f64) -> String) -> String {
    let text = downward(-value);
    match text.strip_prefix('-') {
        Some(positive) => positive.to_string(),
        None if text == "0" => text,
        None => format!("-{text}"),
    }
}

/// Formats the largest number with `decimals` decimals that is not above `value`.
fn downward(value: f64, decimals: usize) -> String {
    downward_to(value, |value| format!("{value:.decimals$}"))
}

fn downward_with_exponent(value: f64) -> String {
    downward_to(value, |value| format!("{value:.2e}"))
}

/// Formats the largest number in a format that is not above `value`.
fn downward_to(value: f64, format: impl Fn(f64) -> String) -> String {
    let nearest = format(value);
    let read = |text: &str| text.parse::<f64>().unwrap_or(f64::NAN);
    let text = if value == 0.0 || read(&nearest) <= value {
        nearest
    } else {
        format(read(&nearest) - last_digit(&nearest))
    };
    if read(&text) == 0.0 { "0".into() } else { text }
}

/// Returns the value of one unit in the last digit of a number.
fn last_digit(text: &str) -> f64 {
    let (mantissa, exponent) = text.split_once('e').unwrap_or((text, "0"));
    let decimals = mantissa.split_once('.').map_or(0, |(_, decimals)| decimals.len() as i32);
    10f64.powi(exponent.parse::<i32>().unwrap_or(0) - decimals)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn two_digits_are_rounded_outward() {
        let all = [0.0, 0.0461, 0.99, 1.0, 12.34, 123.4, 2.14e-9].map(two_digits_up);
        assert_eq!(all, ["0", "0.047", "0.99", "1.0", "13", "124", "2.2e-9"]);
        assert_eq!(two_digits_outward((-0.001, 0.052)), "[-0.001, 0.052]");
        assert_eq!(two_digits_outward((0.0, 0.0)), "0");
    }

    proptest! {
        #[test]
        fn printed_bounds_enclose(
            a in -1e4..1e4_f64,
            width in 0.0..1e-2_f64,
            decimals in 1..8_usize,
        ) {
            let printed = outward([a, a + width], decimals).map(|t| t.parse::<f64>().unwrap());
            prop_assert!(printed[0] <= a && a + width <= printed[1]);
            let digit = 1.000_001 * 10f64.powi(-(decimals as i32));
            prop_assert!(a - printed[0] <= digit && printed[1] - (a + width) <= digit);
        }

        #[test]
        fn printed_intervals_enclose(
            a in -1.0..1.0_f64,
            width in 0.0..1.0_f64,
            [size, narrow] in [-12..9_i32, -14..1_i32],
        ) {
            let low = a * 10f64.powi(size);
            let high = low + width * 10f64.powi(size + narrow);
            let text = interval((low, high));
            let number = |text: &str| text.parse::<f64>().unwrap();
            let encloses = match text.split_once(" ± ") {
                Some((centre, radius)) => {
                    (high - number(centre)).max(number(centre) - low) <= number(radius)
                }
                None => match text.trim_matches(['[', ']']).split_once(", ") {
                    Some((from, to)) => number(from) <= low && high <= number(to),
                    None => number(&text) == low && low == high,
                },
            };
            prop_assert!(encloses, "{text} of {low:e}, {high:e}");
        }

        #[test]
        fn widths_are_rounded_up(width in 0.0..1.0_f64, size in -12..9_i32) {
            let width = width * 10f64.powi(size);
            let printed: f64 = at_least(width).parse().unwrap();
            prop_assert!(printed >= width && printed <= 1.12 * width, "{printed} of {width}");
        }
    }

    #[test]
    fn intervals_show_their_width() {
        let shown = [
            (0.0, 0.0),
            (-0.1, 0.25),
            (-1e-6, 0.25),
            (-6.8e-4, 3.94e-4),
            (-2.1e-9, 2.1e-9),
            (0.5 - 3e-8, 0.5 + 3e-8),
            (0.12345 - 3e-8, 0.12345 + 3.1e-8),
            (0.5, 0.5),
            (0.12345, 0.12345),
            (-2e6, 1.2345e6),
        ];
        let expected = [
            "0",
            "[-0.1000, 0.2500]",
            "[-0.0001, 0.2500]",
            "[-0.000680, 0.000394]",
            "[-2.10e-9, 2.10e-9]",
            "0.5000000000 ± 3.1e-8",
            "0.1234500005 ± 3.1e-8",
            "0.5000",
            "1.2345e-1",
            "[-2.00e6, 1.24e6]",
        ];
        assert_eq!(shown.map(interval), expected);
    }

    #[test]
    fn bounds_of_table_two_are_printed_as_in_the_paper() {
        assert_eq!(outward([-0.0317, 1.2140], 4), ["-0.0317", "1.2140"]);
        assert_eq!(outward([0.0, 0.0], 4), ["0", "0"]);
        assert_eq!(outward([-0.00311, 0.00311], 4), ["-0.0032", "0.0032"]);
        assert_eq!(outward([-0.5, -0.12345], 4), ["-0.5000", "-0.1234"]);
        assert_eq!(outward([0.00001, 0.00002], 4), ["0", "0.0001"]);
        assert_eq!(outward([-0.00002, -0.00001], 4), ["-0.0001", "0"]);
    }
}
