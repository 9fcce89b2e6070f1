//! Directed rounding of single operations, on stable Rust and any platform with IEEE 754 `f64`.
//!
//! The functions never change the rounding mode of the processor. Each operation is computed in
//! round-to-nearest, which is within half a unit in the last place (ulp). The result is then moved
//! to the neighbouring number unless it is known to be a bound. For a sum, the rounding error
//! decides. A product with zero, a quotient of zero and √0 are exact.
//!
//! A bound of an operation with NaN is NaN. NaN is also the result of ∞ - ∞, ∞ / ∞, a division by
//! zero and the root of a negative number. The product 0 · ∞ is 0, as for sets of real numbers.
//!
//! # Examples
//!
//! ```
//! use reachtube_scalar::rounding::{add_down, add_up, mul_up};
//!
//! assert!(add_down(0.1, 0.2) < add_up(0.1, 0.2));
//! assert_eq!(add_up(0.25, 0.5), 0.75);
//! assert!(mul_up(0.1, 0.1) > 0.1 * 0.1);
//! assert_eq!(mul_up(0.0, 0.1), 0.0);
//! ```

/// Returns the number above x where `condition`, else x, without the branch of [`f64::next_up`].
///
/// `condition` must be false for x = 0, ∞ and NaN.
#[inline]
const fn next_up_if(condition: bool, x: f64) -> f64 {
    let bits = x.to_bits() as i64;
    // The bits increase away from zero for positive numbers, towards zero for negative ones.
    let step = ((bits >> 63) | 1) * condition as i64;
    f64::from_bits((bits + step) as u64)
}

/// Returns an upper bound of the non-zero numbers that round to x.
#[inline]
const fn above(x: f64) -> f64 {
    let is_negative_underflow = x == 0.0 && x.is_sign_negative();
    if is_negative_underflow { 0.0 } else { x.next_up() }
}

/// Returns a lower bound of the non-zero numbers that round to x.
#[inline]
const fn below(x: f64) -> f64 {
    -above(-x)
}

/// Returns (s, e) with s = round(a + b) and s + e = a + b exactly, if nothing overflows.
///
/// Knuth, The Art of Computer Programming 2, section 4.2.2, Theorem B. The theorem also holds for
/// subnormal numbers.
pub(crate) const fn two_sum(a: f64, b: f64) -> (f64, f64) {
    let s = a + b;
    let a_part = s - b;
    let b_part = s - a_part;
    (s, (a - a_part) + (b - b_part))
}

/// Returns a + b rounded towards +∞.
///
/// # Guarantee
/// The result is the smallest `f64` at or above the exact sum, also for infinite operands.
#[inline]
#[must_use]
pub const fn add_up(a: f64, b: f64) -> f64 {
    let s = a + b;
    // s < a + b if and only if one of the comparisons holds. The difference of s and the larger of
    // a and b has no rounding error (Dekker 1971), so it compares like the exact numbers. The other
    // comparison cannot contradict it, because rounding is monotone. None holds for s = 0, ∞ and
    // NaN. `|` avoids a branch, whose misprediction would cost more than the comparison.
    next_up_if((s - a < b) | (s - b < a), s)
}

/// Returns a + b rounded towards -∞.
///
/// # Guarantee
/// The result is the largest `f64` at or below the exact sum, also for infinite operands.
#[inline]
#[must_use]
pub const fn add_down(a: f64, b: f64) -> f64 {
    -add_up(-a, -b)
}

/// Returns a - b rounded towards +∞.
///
/// # Guarantee
/// The result is the smallest `f64` at or above the exact difference.
#[inline]
#[must_use]
pub const fn sub_up(a: f64, b: f64) -> f64 {
    add_up(a, -b)
}

/// Returns a - b rounded towards -∞.
///
/// # Guarantee
/// The result is the largest `f64` at or below the exact difference.
#[inline]
#[must_use]
pub const fn sub_down(a: f64, b: f64) -> f64 {
    add_down(a, -b)
}

/// Returns the product of a and b, one of which is zero: 0, or NaN if the other is NaN.
const fn product_with_zero(a: f64, b: f64) -> f64 {
    if a.is_nan() || b.is_nan() { f64::NAN } else { 0.0 }
}

/// Returns a · b rounded towards +∞. A product with zero is zero, also for an infinite factor.
///
/// # Guarantee
/// The result is an upper bound of the exact product, within 1 ulp of the tightest one. It never
/// has the wrong sign.
#[inline]
#[must_use]
pub const fn mul_up(a: f64, b: f64) -> f64 {
    if a == 0.0 || b == 0.0 { product_with_zero(a, b) } else { above(a * b) }
}

/// Returns a · b rounded towards -∞. A product with zero is zero, also for an infinite factor.
///
/// # Guarantee
/// The result is a lower bound of the exact product, within 1 ulp of the tightest one. It never has
/// the wrong sign.
#[inline]
#[must_use]
pub const fn mul_down(a: f64, b: f64) -> f64 {
    if a == 0.0 || b == 0.0 { product_with_zero(a, b) } else { below(a * b) }
}

/// Returns a / b rounded towards +∞; NaN for b = 0.
///
/// # Guarantee
/// The result is an upper bound of the exact quotient, within 1 ulp of the tightest one. It never
/// has the wrong sign.
#[inline]
#[must_use]
pub const fn div_up(a: f64, b: f64) -> f64 {
    if a == 0.0 || b == 0.0 { product_with_zero(a, 0.0 / b) } else { above(a / b) }
}

/// Returns a / b rounded towards -∞; NaN for b = 0.
///
/// # Guarantee
/// The result is a lower bound of the exact quotient, within 1 ulp of the tightest one. It never
/// has the wrong sign.
#[inline]
#[must_use]
pub const fn div_down(a: f64, b: f64) -> f64 {
    -div_up(-a, b)
}

/// Returns √x rounded towards +∞; NaN for x < 0.
///
/// # Guarantee
/// The result is an upper bound of the exact root, within 1 ulp of the tightest one; exact at 0.
#[inline]
#[must_use]
pub fn sqrt_up(x: f64) -> f64 {
    if x == 0.0 { 0.0 } else { above(x.sqrt()) }
}

/// Returns √x rounded towards -∞; NaN for x < 0.
///
/// # Guarantee
/// The result is a lower bound of the exact root, within 1 ulp of the tightest one; exact at 0.
#[inline]
#[must_use]
pub fn sqrt_down(x: f64) -> f64 {
    if x == 0.0 { 0.0 } else { below(x.sqrt()) }
}
