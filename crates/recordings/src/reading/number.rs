//! Numbers of CSV text, without copies.

/// Largest power of ten that is a double without rounding.
pub(super) const EXACT_POWERS: [f64; 23] = [
    1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15, 1e16,
    1e17, 1e18, 1e19, 1e20, 1e21, 1e22,
];

/// Whole numbers below this are doubles without rounding.
pub(super) const EXACT_WHOLE: u64 = 1 << 53;

/// Digits that a `u64` holds in any case.
const MOST_DIGITS: usize = 19;

/// Returns the finite number that a field holds; `None` for any other text.
///
/// A number of few digits is the quotient of two whole numbers that are doubles, hence exact to
/// rounding (Clinger, "How to read floating point numbers accurately", 1990). Any other is read by
/// the standard library.
pub(super) fn number(field: &[u8]) -> Option<f64> {
    few_digits(field).or_else(|| {
        let number = std::str::from_utf8(field).ok()?.parse::<f64>().ok()?;
        number.is_finite().then_some(number)
    })
}

/// Returns a number without an exponent whose digits are few enough.
fn few_digits(field: &[u8]) -> Option<f64> {
    let (is_negative, digits) = match field {
        [b'-', rest @ ..] => (true, rest),
        [b'+', rest @ ..] => (false, rest),
        _ => (false, field),
    };
    if digits.len() > MOST_DIGITS {
        return None;
    }
    let (mut whole, mut point) = (0u64, None);
    for (at, byte) in digits.iter().enumerate() {
        match byte {
            b'0'..=b'9' => whole = 10 * whole + u64::from(byte - b'0'),
            b'.' if point.is_none() => point = Some(at),
            _ => return None,
        }
    }
    let fraction = point.map_or(0, |at| digits.len() - 1 - at);
    let has_digits = digits.len() > usize::from(point.is_some());
    if !has_digits || whole > EXACT_WHOLE {
        return None;
    }
    let size = whole as f64 / EXACT_POWERS[fraction];
    Some(if is_negative { -size } else { size })
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::number;

    fn standard(text: &str) -> Option<u64> {
        text.parse::<f64>().ok().filter(|number| number.is_finite()).map(f64::to_bits)
    }

    proptest! {
        #[test]
        fn numbers_are_those_of_the_standard_library(
            text in "[+-]?[0-9]{0,21}(\\.[0-9]{0,12})?([eE][+-]?[0-9]{1,3})?"
        ) {
            prop_assert_eq!(number(text.as_bytes()).map(f64::to_bits), standard(&text));
        }

        #[test]
        fn doubles_are_read_as_they_were_written(bits: u64) {
            let value = f64::from_bits(bits);
            prop_assume!(value.is_finite());
            for text in [format!("{value}"), format!("{value:e}"), format!("{value:.6}")] {
                prop_assert_eq!(number(text.as_bytes()).map(f64::to_bits), standard(&text));
            }
        }
    }

    #[test]
    fn text_that_is_no_finite_number_is_none() {
        for text in ["", ".", "-", "+.", "1,5", "nan", "inf", "1e999", "--1", "1.2.3", "1 ", "٣"] {
            assert_eq!(number(text.as_bytes()), None, "{text}");
        }
        assert_eq!(number(b"-0").map(f64::to_bits), Some((-0.0f64).to_bits()));
        assert_eq!((number(b".5"), number(b"5.")), (Some(0.5), Some(5.0)));
    }
}
