//! Directed rounding of single operations, on stable Rust and any platform with IEEE 754 `f64`.
//!
//! The processor's rounding mode is never touched: each operation is computed in round-to-nearest,
//! which is within half a unit in the last place (ulp), and then widened to the neighbouring number
//! unless it is known to be a bound: a sum tells on which side of the exact one it lies; a product
//! with zero, zero divided and √0 are exact.
//!
//! NaN in, NaN out: a bound that rests on a NaN never looks like a number. NaN also marks ∞ - ∞, ∞
//! / ∞, a division by zero and the root of a negative number. Only 0 · ∞ has a value: 0, as for
//! sets of real numbers.
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

/// x ± |x| · `STEP` rounds to the neighbours of x, for every |x| > [`TINY`]: |x| · `STEP` is a
/// little above half an ulp and at most one.
///
/// Rump, Zimmermann, Boldo, Melquiond: Computing predecessor and successor in rounding to nearest,
/// BIT 49 (2009).
const STEP: f64 = 0.5 * f64::EPSILON * (1.0 + f64::EPSILON);

/// Far above 2⁻⁹⁶⁹ = 2e-292, where |x| · [`STEP`] is a normal number and does not lose the little
/// above half an ulp.
const TINY: f64 = 1e-290;

/// Whether [`bounds_of_rounded`] may be used for [lo, hi].
#[inline]
pub(crate) const fn is_far_from_underflow(lo: f64, hi: f64) -> bool {
    (lo.abs() > TINY) & (hi.abs() > TINY)
}

/// The number below `lo` < ∞ and the number above `hi` > -∞: as [`f64::next_down`] and
/// [`f64::next_up`], without a branch.
#[inline]
pub(crate) const fn bounds_of_rounded(lo: f64, hi: f64) -> (f64, f64) {
    (lo - lo.abs() * STEP, hi + hi.abs() * STEP)
}

/// The number above x if `wanted`, which x = 0, ∞ and NaN must not be; else x. Without a branch,
/// unlike [`f64::next_up`].
#[inline]
const fn above_if(wanted: bool, x: f64) -> f64 {
    let bits = x.to_bits() as i64;
    // Away from zero for positive, towards it for negative numbers.
    let step = ((bits >> 63) | 1) * wanted as i64;
    f64::from_bits((bits + step) as u64)
}

/// An upper bound of the non-zero numbers that round to x.
#[inline]
const fn above(x: f64) -> f64 {
    let is_negative_underflow = x == 0.0 && x.is_sign_negative();
    if is_negative_underflow { 0.0 } else { x.next_up() }
}

/// A lower bound of the non-zero numbers that round to x.
#[inline]
const fn below(x: f64) -> f64 {
    -above(-x)
}

/// (s, e) with s = round(a + b) and s + e = a + b exactly, where nothing overflows.
///
/// Knuth, The Art of Computer Programming 2, section 4.2.2, Theorem B. It holds for subnormal
/// numbers too.
pub(crate) const fn two_sum(a: f64, b: f64) -> (f64, f64) {
    let s = a + b;
    let a_part = s - b;
    let b_part = s - a_part;
    (s, (a - a_part) + (b - b_part))
}

/// a + b rounded towards +∞.
///
/// # Guarantee
/// The smallest `f64` at or above the exact sum, of which infinite operands are part.
#[inline]
#[must_use]
pub const fn add_up(a: f64, b: f64) -> f64 {
    let s = a + b;
    // s < a + b if and only if one of the comparisons holds: the difference of s and the larger of
    // a and b has no rounding error (Dekker 1971), so its comparison is that of the exact numbers;
    // the other one can only say the same, because rounding is monotone. None holds for s = 0, ∞
    // and NaN. `|` makes no branch, whose misprediction would cost more than the comparison.
    above_if((s - a < b) | (s - b < a), s)
}

/// a + b rounded towards -∞.
///
/// # Guarantee
/// The largest `f64` at or below the exact sum, of which infinite operands are part.
#[inline]
#[must_use]
pub const fn add_down(a: f64, b: f64) -> f64 {
    -add_up(-a, -b)
}

/// a - b rounded towards +∞.
///
/// # Guarantee
/// As [`add_up`].
#[inline]
#[must_use]
pub const fn sub_up(a: f64, b: f64) -> f64 {
    add_up(a, -b)
}

/// a - b rounded towards -∞.
///
/// # Guarantee
/// As [`add_down`].
#[inline]
#[must_use]
pub const fn sub_down(a: f64, b: f64) -> f64 {
    add_down(a, -b)
}

/// 0, the product of a and b of which one is zero, or NaN.
const fn product_with_zero(a: f64, b: f64) -> f64 {
    if a.is_nan() || b.is_nan() { f64::NAN } else { 0.0 }
}

/// a · b rounded towards +∞. A product with zero is zero, also that of an infinite bound.
///
/// # Guarantee
/// An upper bound of the exact product, the number beside the rounded one; never of the wrong sign.
#[inline]
#[must_use]
pub const fn mul_up(a: f64, b: f64) -> f64 {
    if a == 0.0 || b == 0.0 { product_with_zero(a, b) } else { above(a * b) }
}

/// a · b rounded towards -∞. A product with zero is zero, also that of an infinite bound.
///
/// # Guarantee
/// A lower bound of the exact product, the number beside the rounded one; never of the wrong sign.
#[inline]
#[must_use]
pub const fn mul_down(a: f64, b: f64) -> f64 {
    if a == 0.0 || b == 0.0 { product_with_zero(a, b) } else { below(a * b) }
}

/// a / b rounded towards +∞; NaN for b = 0.
///
/// # Guarantee
/// An upper bound of the exact quotient, the number beside the rounded one; never of the wrong
/// sign.
#[inline]
#[must_use]
pub const fn div_up(a: f64, b: f64) -> f64 {
    if a == 0.0 || b == 0.0 { product_with_zero(a, 0.0 / b) } else { above(a / b) }
}

/// a / b rounded towards -∞; NaN for b = 0.
///
/// # Guarantee
/// A lower bound of the exact quotient, the number beside the rounded one; never of the wrong sign.
#[inline]
#[must_use]
pub const fn div_down(a: f64, b: f64) -> f64 {
    -div_up(-a, b)
}

/// √x rounded towards +∞; NaN for x < 0.
///
/// # Guarantee
/// An upper bound of the exact root, the number beside the rounded one; exact at 0.
#[inline]
#[must_use]
pub fn sqrt_up(x: f64) -> f64 {
    if x == 0.0 { 0.0 } else { above(x.sqrt()) }
}

/// √x rounded towards -∞; NaN for x < 0.
///
/// # Guarantee
/// A lower bound of the exact root, the number beside the rounded one; exact at 0.
#[inline]
#[must_use]
pub fn sqrt_down(x: f64) -> f64 {
    if x == 0.0 { 0.0 } else { below(x.sqrt()) }
}
