//! Times of messages, which count nanoseconds.

use crate::message::SECOND;

/// Returns nanoseconds as seconds with all nine decimals.
pub(crate) fn decimal(nanoseconds: i64) -> String {
    let sign = if nanoseconds < 0 { "-" } else { "" };
    let size = nanoseconds.unsigned_abs();
    let second = SECOND.unsigned_abs();
    format!("{sign}{}.{:09}", size / second, size % second)
}

#[cfg(test)]
mod tests {
    use super::decimal;

    #[test]
    fn times_keep_their_digits() {
        let cases = [(0, "0.000000000"), (-1, "-0.000000001"), (1_500_000_002, "1.500000002")];
        cases.iter().for_each(|(time, text)| assert_eq!(decimal(*time), *text));
        assert_eq!(decimal(i64::MIN), "-9223372036.854775808");
    }
}
