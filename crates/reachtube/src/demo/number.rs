//! Numbers as they are recorded.

/// Decimals kept: μrad, μrad/s, μN m. It hides differences in the last bits between mathematics
/// libraries.
const SCALE: f64 = 1e6;

/// The number that is printed; never -0.
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
