//! Rounding of recorded numbers.

/// Steps per unit: numbers are recorded in μrad, μrad/s and μN m. The last bits differ between
/// mathematics libraries, and rounding hides this.
const SCALE: f64 = 1e6;

/// Rounds a number to six decimals; the result is never -0.
pub(super) fn rounded(x: f64) -> f64 {
    (x * SCALE).round() / SCALE + 0.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_print_short_and_read_back() {
        for (x, text) in [
            (-1e-9, "0"),
            (0.1 + 0.2, "0.3"),
            (-12.345_678_949, "-12.345679"),
            (2.5e-6, "0.000003"),
        ] {
            assert_eq!(rounded(x).to_string(), text);
            assert_eq!(text.parse::<f64>().unwrap(), rounded(x));
        }
    }
}
