//! Numbers as text: few digits, but never so few that a small number becomes 0.

/// Below this magnitude, four decimals would hide most digits.
const SMALL: f64 = 1e-3;

/// Below this magnitude, six decimals would hide most digits.
const TINY: f64 = 1e-5;

/// From this magnitude on, decimals add nothing.
const LARGE: f64 = 1e5;

/// Returns a number with four decimals, or in scientific notation where it is very small or large.
pub fn number(value: f64) -> String {
    match value.abs() {
        0.0 => "0".into(),
        size if (SMALL..LARGE).contains(&size) => format!("{value:.4}"),
        _ => format!("{value:.1e}"),
    }
}

/// Returns a number with up to six significant digits, without trailing zeros.
pub fn digits(value: f64) -> String {
    let rounded = format!("{value:.5e}").parse::<f64>().unwrap_or(value);
    if rounded != 0.0 && rounded.abs() < SMALL {
        format!("{rounded:e}")
    } else {
        rounded.to_string()
    }
}

/// Returns an interval by its ends, or by centre and radius where the ends would look the same.
pub fn interval((low, high): (f64, f64)) -> String {
    let (size, radius) = (low.abs().max(high.abs()), 0.5 * (high - low));
    let centre = 0.5 * (low + high);
    if radius == 0.0 {
        number(centre)
    } else if radius < SMALL * size {
        format!("{} ± {radius:.1e}", number(centre))
    } else if (TINY..LARGE).contains(&size) {
        let digits = (1.0 - radius.log10().floor()).clamp(4.0, 6.0) as usize;
        format!("[{}, {}]", fixed(low, digits), fixed(high, digits))
    } else {
        format!("[{low:.2e}, {high:.2e}]")
    }
}

/// Returns a number with a fixed count of decimals; a zero has no sign.
pub fn fixed(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$}");
    text.strip_prefix('-')
        .filter(|rest| rest.bytes().all(|b| b == b'0' || b == b'.'))
        .map_or(text.clone(), String::from)
}

#[cfg(test)]
mod tests {
    use super::{digits, interval, number};

    #[test]
    fn small_numbers_keep_their_digits() {
        let shown = [0.0, 2.1e-9, -0.25, 12.34567, 3.2e7].map(number);
        assert_eq!(shown, ["0", "2.1e-9", "-0.2500", "12.3457", "3.2e7"]);
    }

    #[test]
    fn long_numbers_are_cut_and_short_ones_kept() {
        let shown = [0.0, 0.079, -23.13210017081165, 4.1e-18, 160.0].map(digits);
        assert_eq!(shown, ["0", "0.079", "-23.1321", "4.1e-18", "160"]);
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
            (0.5, 0.5),
        ];
        let expected = [
            "0",
            "[-0.1000, 0.2500]",
            "[0.0000, 0.2500]",
            "[-0.00068, 0.00039]",
            "[-2.10e-9, 2.10e-9]",
            "0.5000 ± 3.0e-8",
            "0.5000",
        ];
        assert_eq!(shown.map(interval), expected);
    }
}
