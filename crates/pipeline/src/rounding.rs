/// Rounds up to a number of digits.
pub(crate) fn rounded_up(value: f64, digits: i32) -> f64 {
    if value <= 0.0 {
        return 0.0;
    }
    if !value.is_finite() {
        return value;
    }
    let exponent = value.log10().floor() as i32 + 1 - digits;
    let digits = (value / 10f64.powi(exponent)).ceil();
    // The shortest number with these digits.
    format!("{digits}e{exponent}").parse().unwrap_or(value)
}

/// Returns the ratio of a set's width to the motion, in words.
pub(crate) fn percent(ratio: f64) -> String {
    if ratio.is_finite() { format!("{:.0} %", 100.0 * ratio) } else { "of no bounded size".into() }
}

#[cfg(test)]
mod tests {
    use super::rounded_up;

    #[test]
    fn numbers_are_rounded_up_to_their_digits() {
        let rounded = [0.0, 1.2301e-3, 1.25, 98.71, 1e301, f64::INFINITY];
        let rounded = rounded.map(|value| rounded_up(value, 3));
        assert_eq!(rounded, [0.0, 1.24e-3, 1.25, 98.8, 1e301, f64::INFINITY]);
    }
}
