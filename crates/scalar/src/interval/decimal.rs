//! Decimal text: enclosures of literals, and literals that enclose an interval.

use core::cmp::Ordering;
use core::fmt;

use thiserror::Error;

use super::closed::Interval;
use crate::rounding::{add_up, sub_down};

/// An error: a text is not a decimal number.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[error(
    "`{text}` is not a decimal number: write digits with an optional sign, point and exponent, \
     as in -1.5e-3"
)]
pub struct DecimalError {
    /// The rejected text.
    pub text: String,
}

impl Interval {
    /// Encloses the exact value of a decimal literal such as `0.1`, `-3` or `1.5e-3`.
    ///
    /// # Guarantee
    /// The tightest enclosure: a point where the literal is an `f64` exactly, else two neighbouring
    /// numbers.
    ///
    /// # Errors
    /// `DecimalError` if the text is not a decimal number. Infinities and NaN are errors.
    ///
    /// ```
    /// use reachtube_scalar::Interval;
    ///
    /// let x = Interval::try_from_decimal("0.1").unwrap();
    /// assert_eq!((x.lo(), x.hi()), (0.1_f64.next_down(), 0.1)); // 0.1_f64 is above one tenth
    /// assert_eq!(Interval::try_from_decimal("0.25"), Ok(Interval::point(0.25)));
    /// ```
    pub fn try_from_decimal(text: &str) -> Result<Interval, DecimalError> {
        let error = || DecimalError { text: text.to_owned() };
        if text.contains(|c: char| c.is_ascii_alphabetic() && !matches!(c, 'e' | 'E')) {
            return Err(error()); // `f64` would parse "inf" and "nan"
        }
        let nearest: f64 = text.parse().map_err(|_| error())?;
        Ok(match compare(text, nearest) {
            Ordering::Less => Interval { lo: nearest.next_down(), hi: nearest },
            Ordering::Equal => Interval { lo: nearest, hi: nearest },
            Ordering::Greater => Interval { lo: nearest, hi: nearest.next_up() },
        })
    }
}

/// Formats as `[lo, hi]` in decimal, with the precision of the format if it has one.
///
/// # Guarantee
/// Outer: the decimal numbers enclose the interval.
///
/// ```
/// use reachtube_scalar::Interval;
///
/// assert_eq!(format!("{:.2}", Interval::PI), "[3.14, 3.15]");
/// assert_eq!(Interval::point(0.5).to_string(), "[0.5, 0.5]");
/// ```
impl fmt::Display for Interval {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let write = |x: f64| f.precision().map_or_else(|| format!("{x}"), |p| format!("{x:.p$}"));
        // One unit of the last written digit; 0 without a precision, where the neighbouring `f64`
        // is written instead.
        let unit = f.precision().map_or(0.0, |p| 10_f64.powi(-(p.min(400) as i32)));
        let (lo, hi) = (self.lo + 0.0, self.hi + 0.0); // -0 becomes 0
        let mut below = write(lo);
        if lo.is_finite() && compare(&below, lo) == Ordering::Greater {
            below = write(sub_down(lo, unit).min(lo.next_down()));
        }
        let mut above = write(hi);
        if hi.is_finite() && compare(&above, hi) == Ordering::Less {
            above = write(add_up(hi, unit).max(hi.next_up()));
        }
        write!(f, "[{below}, {above}]")
    }
}

/// Compares the exact value of a decimal literal with x. An infinite x is beyond every literal.
fn compare(literal: &str, x: f64) -> Ordering {
    if x.is_infinite() {
        return 0.0.partial_cmp(&x).expect("x is not NaN");
    }
    // An f64 has at most 767 significant digits.
    let exact = format!("{x:.767e}");
    let (a, b) = (Decimal::parse(literal), Decimal::parse(&exact));
    match (a.is_negative, b.is_negative) {
        (false, false) => a.magnitude().cmp(&b.magnitude()),
        (true, true) => b.magnitude().cmp(&a.magnitude()),
        (true, false) => Ordering::Less,
        (false, true) => Ordering::Greater,
    }
}

/// The number ±0.d₁d₂d₃… · 10^exponent with d₁ ≠ 0. Zero has no digits and is not negative.
struct Decimal {
    is_negative: bool,
    exponent: i64,
    digits: String,
}

impl Decimal {
    /// Parses a text that `f64` can parse.
    fn parse(text: &str) -> Decimal {
        let unsigned = text.trim_start_matches(['+', '-']);
        let (mantissa, exponent) = unsigned.split_once(['e', 'E']).unwrap_or((unsigned, "0"));
        let (whole, fraction) = mantissa.split_once('.').unwrap_or((mantissa, ""));
        let all = [whole, fraction].concat();
        let significant = all.trim_start_matches('0');
        let leading_zeros = (all.len() - significant.len()) as i64;
        let digits = significant.trim_end_matches('0').to_owned();
        // An exponent too long for i64 compares like any other exponent out of range.
        let beyond = if exponent.starts_with('-') { i64::MIN / 2 } else { i64::MAX / 2 };
        let exponent = exponent.parse().unwrap_or(beyond).clamp(i64::MIN / 2, i64::MAX / 2);
        Decimal {
            is_negative: text.starts_with('-') && !digits.is_empty(),
            exponent: exponent + whole.len() as i64 - leading_zeros,
            digits,
        }
    }

    /// Returns a key that sorts by magnitude.
    fn magnitude(&self) -> (bool, i64, &str) {
        let is_nonzero = !self.digits.is_empty();
        (is_nonzero, if is_nonzero { self.exponent } else { 0 }, &self.digits)
    }
}
