//! Numbers at the start of CSV text, eight digits at a time.

use super::number::{EXACT_POWERS, EXACT_WHOLE};

/// Digits that are read at once.
const AT_ONCE: usize = 8;

/// A decimal number without an exponent at the start of a text.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Decimal {
    /// All digits, as one whole number.
    whole: u64,
    /// Number of digits after the point.
    fraction: usize,
    is_negative: bool,
    /// Number of bytes of the text that the number takes.
    pub length: usize,
}

impl Decimal {
    /// Reads the number at the start of `text`; `None` if there is none, if its digits do not fit a
    /// double without rounding, or if fewer than eight bytes follow its sign or its point.
    #[inline]
    pub(super) fn leading(text: &[u8]) -> Option<Self> {
        // Branches that mostly go one way let the processor look ahead.
        let (is_negative, start) = match text.first()? {
            b'-' => (true, 1),
            _ => (false, 0),
        };
        let (mut whole, count) = match text.get(start..start + 2)? {
            [digit @ b'0'..=b'9', b'.'] => (u64::from(digit - b'0'), 1),
            _ => digits(text, start)?,
        };
        let mut at = start + count;
        let mut fraction = 0;
        if text.get(at) == Some(&b'.') {
            let (part, count) = digits(text, at + 1)?;
            (whole, fraction) = (whole * POWERS[count] + part, count);
            if count == AT_ONCE {
                let (part, count) = digits(text, at + 1 + AT_ONCE)?;
                whole = whole.checked_mul(POWERS[count])?.checked_add(part)?;
                fraction += count;
            }
            at += 1 + fraction;
        }
        let has_digits = count + fraction > 0 && count < AT_ONCE && fraction < 2 * AT_ONCE;
        (has_digits && whole <= EXACT_WHOLE).then_some(Self {
            whole,
            fraction,
            is_negative,
            length: at,
        })
    }

    /// Returns the number, correctly rounded: the quotient of two whole numbers that are doubles
    /// (Clinger, "How to read floating point numbers accurately", 1990).
    #[inline]
    pub(super) fn value(&self) -> f64 {
        let size = self.whole as f64 / EXACT_POWERS[self.fraction];
        if self.is_negative { -size } else { size }
    }

    /// Returns a number of seconds in picoseconds; `None` if it is not a whole number of them.
    #[inline]
    pub(super) fn picoseconds(&self) -> Option<i128> {
        let shift = POWERS_OF_SECONDS.get(self.fraction)?;
        let size = i128::from(self.whole) * i128::from(*shift);
        Some(if self.is_negative { -size } else { size })
    }
}

/// Powers of ten for up to eight digits.
const POWERS: [u64; AT_ONCE + 1] =
    [1, 10, 100, 1000, 10_000, 100_000, 1_000_000, 10_000_000, 100_000_000];

/// Picoseconds in one unit of the last digit, by the number of digits after the point.
const POWERS_OF_SECONDS: [u64; 13] = [
    1_000_000_000_000,
    100_000_000_000,
    10_000_000_000,
    1_000_000_000,
    100_000_000,
    10_000_000,
    1_000_000,
    100_000,
    10_000,
    1000,
    100,
    10,
    1,
];

/// Returns the whole number that up to eight digits from byte `at` on form, and how many they are;
/// `None` if fewer than eight bytes are left.
#[inline]
fn digits(text: &[u8], at: usize) -> Option<(u64, usize)> {
    let bytes = text.get(at..at + AT_ONCE)?;
    let word = u64::from_le_bytes(bytes.try_into().ok()?) ^ repeated(b'0');
    // The highest bit of each byte that is no digit. The sums do not carry into the next byte.
    let others = (((word & repeated(0x7f)) + repeated(0x76)) | word) & repeated(0x80);
    let count = (others.trailing_zeros() / 8) as usize;
    // Zeros take the place of the digits that are missing in front.
    let word = word.checked_shl(8 * (AT_ONCE - count) as u32).unwrap_or(0);
    // Pairs of digits, then fours, then eight.
    let pairs = (word.wrapping_mul(10).wrapping_add(word >> 8)) & 0x00ff_00ff_00ff_00ff;
    let fours = (pairs.wrapping_mul(100).wrapping_add(pairs >> 16)) & 0x0000_ffff_0000_ffff;
    let eight = (fours.wrapping_mul(10_000).wrapping_add(fours >> 32)) & 0xffff_ffff;
    Some((eight, count))
}

/// Returns eight times the same byte.
const fn repeated(byte: u8) -> u64 {
    u64::from_le_bytes([byte; 8])
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::Decimal;
    use crate::decimal::picoseconds;

    fn leading(text: &str) -> Option<Decimal> {
        Decimal::leading(format!("{text},and more text").as_bytes())
    }

    proptest! {
        #[test]
        fn a_number_is_that_of_the_standard_library(
            text in "-?[0-9]{0,9}(\\.[0-9]{0,18})?"
        ) {
            if let Some(read) = leading(&text) {
                let expected: f64 = text.parse().unwrap();
                prop_assert_eq!(read.value().to_bits(), expected.to_bits());
                prop_assert_eq!(read.length, text.len());
                if let Some(time) = read.picoseconds() {
                    prop_assert_eq!(Some(time), picoseconds(&text));
                }
            }
        }

        #[test]
        fn numbers_of_few_digits_are_read(whole in 0u32..9_999_999, fraction in 0u32..9_999_999) {
            for text in [format!("-{whole}"), format!("{whole}.{fraction}")] {
                prop_assert!(leading(&text).is_some(), "{}", text);
            }
        }

        #[test]
        fn bytes_of_any_kind_do_no_harm(bytes in prop::collection::vec(any::<u8>(), 0..24)) {
            if let Some(read) = Decimal::leading(&bytes) {
                let text = std::str::from_utf8(&bytes[..read.length]).unwrap();
                prop_assert_eq!(text.parse::<f64>().ok(), Some(read.value()));
            }
        }
    }

    #[test]
    fn what_is_no_short_number_is_left_to_others() {
        for text in ["", "-", ".", "-.", "+1", "nan", "--1", "12345678", "0.1234567890123456"] {
            assert_eq!(leading(text), None, "{text}");
        }
        assert_eq!(Decimal::leading(b"1.5,2\n"), None, "too little text follows");
        assert_eq!(leading("1.5e3").map(|read| read.length), Some(3));
        assert_eq!(leading("-0").map(|read| read.value().to_bits()), Some((-0.0f64).to_bits()));
    }
}
