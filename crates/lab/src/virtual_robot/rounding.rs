//! Rounding of recorded numbers.

/// Rounds a number to `decimals`; the result is never -0.
pub(super) fn rounded(x: f64, decimals: usize) -> f64 {
    /// Powers of ten that are exact.
    const SCALES: [f64; 7] = [1.0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6];
    let scale = SCALES[decimals];
    (x * scale).round() / scale + 0.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_print_short_and_read_back() {
        for (x, decimals, text) in [
            (-1e-9, 6, "0"),
            (0.1 + 0.2, 6, "0.3"),
            (-12.345_678_949, 6, "-12.345679"),
            (-12.345_678_949, 3, "-12.346"),
            (2.5e-6, 6, "0.000003"),
        ] {
            assert_eq!(rounded(x, decimals).to_string(), text);
            assert_eq!(text.parse::<f64>().unwrap(), rounded(x, decimals));
        }
    }
}
