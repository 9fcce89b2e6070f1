/// Returns a decimal number of seconds in picoseconds, rounded to nearest; `None` for text that is
/// not a finite decimal number or has too many digits.
///
/// The digits are read as written, so that differences of times since 1970 are exact. In double
/// precision, such times are only known to about 0.2 µs.
///
/// # Examples
///
/// ```
/// use reachtube_recordings::picoseconds;
///
/// assert_eq!(picoseconds("0.004"), Some(4_000_000_000));
/// assert_eq!(picoseconds("1,5"), None);
/// ```
#[must_use]
pub fn picoseconds(text: &str) -> Option<i128> {
    let (mantissa, exponent) = match text.split_once(['e', 'E']) {
        Some((mantissa, exponent)) => (mantissa, exponent.parse::<i32>().ok()?),
        None => (text, 0),
    };
    let unsigned = mantissa.strip_prefix(['+', '-']).unwrap_or(mantissa);
    let (whole, fraction) = unsigned.split_once('.').unwrap_or((unsigned, ""));
    if whole.is_empty() && fraction.is_empty() {
        return None;
    }
    let digits = whole.bytes().chain(fraction.bytes()).try_fold(0i128, |all, byte| {
        let digit = byte.is_ascii_digit().then(|| i128::from(byte - b'0'))?;
        all.checked_mul(10)?.checked_add(digit)
    })?;
    let shift = exponent.checked_add(12)?.checked_sub_unsigned(fraction.len() as u32)?;
    let size = match 10i128.checked_pow(shift.unsigned_abs()) {
        Some(power) if shift >= 0 => digits.checked_mul(power)?,
        Some(power) => (digits + power / 2) / power,
        None if shift < 0 || digits == 0 => 0,
        None => return None,
    };
    Some(if mantissa.starts_with('-') { -size } else { size })
}

#[cfg(test)]
mod tests {
    use super::picoseconds;

    #[test]
    fn numbers_are_read_as_written() {
        let cases = [
            ("0", 0),
            ("-0.0", 0),
            ("0.004", 4_000_000_000),
            ("+.5", 500_000_000_000),
            ("5.", 5_000_000_000_000),
            ("-1.5e-3", -1_500_000_000),
            ("4E-3", 4_000_000_000),
            ("1e-400", 0),
            ("0.0000000000015", 2),
            ("1700000000.004", 1_700_000_000_004_000_000_000),
        ];
        for (text, expected) in cases {
            assert_eq!(picoseconds(text), Some(expected), "{text}");
        }
    }

    #[test]
    fn text_that_is_not_a_number_or_does_not_fit_gives_none() {
        for text in ["", ".", "-", "1,5", "nan", "inf", "--1", "1e", "1e99", "1.-5"] {
            assert_eq!(picoseconds(text), None, "{text}");
        }
    }
}
