//! Sums and products of intervals, both ends at once.
//!
//! On x86-64 the two ends lie in one register as (-lo, hi), so that both round upwards. Elsewhere
//! they are computed one by one. Both ways have the same bits.

use super::closed::Interval;

#[cfg(not(target_arch = "x86_64"))]
pub(super) use one_by_one::{product, sum};
#[cfg(target_arch = "x86_64")]
pub(super) use side_by_side::{product, sum};

/// A factor for which x ± |x| · `STEP` rounds to the neighbours of x, for every |x| > [`TINY`].
///
/// The product |x| · `STEP` is slightly above half an ulp and at most one ulp. Rump, Zimmermann,
/// Boldo, Melquiond: Computing predecessor and successor in rounding to nearest, BIT 49 (2009).
const STEP: f64 = 0.5 * f64::EPSILON * (1.0 + f64::EPSILON);

/// A bound above 2⁻⁹⁶⁹ = 2e-292. Above it, |x| · [`STEP`] is a normal number and stays above half
/// an ulp.
const TINY: f64 = 1e-290;

/// Encloses the product of intervals whose ends are 0 or between 1e-140 and 1e140 in size.
pub(super) fn product_of_moderate(x: Interval, y: Interval) -> Interval {
    let (lo, hi) = rounded_product(x, y);
    // -0 + 0 is 0.
    Interval { lo: lo - lo.abs() * STEP + 0.0, hi: hi + hi.abs() * STEP + 0.0 }
}

/// Returns the ends of the product, rounded to nearest, of bounded intervals.
#[inline]
fn rounded_product(x: Interval, y: Interval) -> (f64, f64) {
    let (ll, lh) = (x.lo * y.lo, x.lo * y.hi);
    let (hl, hh) = (x.hi * y.lo, x.hi * y.hi);
    (smaller(smaller(ll, lh), smaller(hl, hh)), larger(larger(ll, lh), larger(hl, hh)))
}

/// Returns the smaller number; without the NaN handling of `f64::min` it is one instruction.
#[inline]
fn smaller(a: f64, b: f64) -> f64 {
    if a < b { a } else { b }
}

/// Returns the larger number; without the NaN handling of `f64::max` it is one instruction.
#[inline]
fn larger(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}

#[cfg(target_arch = "x86_64")]
mod side_by_side {
    use core::arch::x86_64::__m128d;

    use pulp::core_arch::x86::Sse2;

    use super::{Interval, STEP, TINY};

    /// Returns the instructions; the detection of SSE2, which every x86-64 has, costs nothing.
    #[inline(always)]
    fn sse2() -> Sse2 {
        Sse2::try_new().expect("x86-64 has SSE2")
    }

    #[inline(always)]
    fn ends(x: Interval) -> __m128d {
        sse2()._mm_set_pd(x.hi, x.lo)
    }

    /// Returns the interval whose ends are (-lo, hi).
    #[inline(always)]
    fn interval(outward: __m128d) -> Interval {
        let v = sse2();
        let ends = flipped(outward);
        Interval { lo: v._mm_cvtsd_f64(ends), hi: v._mm_cvtsd_f64(v._mm_unpackhi_pd(ends, ends)) }
    }

    #[inline(always)]
    fn flipped(x: __m128d) -> __m128d {
        sse2()._mm_xor_pd(x, sse2()._mm_set_pd(0.0, -0.0))
    }

    #[inline(always)]
    fn magnitudes(x: __m128d) -> __m128d {
        sse2()._mm_andnot_pd(sse2()._mm_set1_pd(-0.0), x)
    }

    /// Encloses the sum, as `add_down` and `add_up` do.
    #[inline(always)]
    pub(in crate::interval) fn sum(x: Interval, y: Interval) -> Interval {
        let v = sse2();
        let (x, y) = (flipped(ends(x)), flipped(ends(y)));
        let s = v._mm_add_pd(x, y);
        let is_below = v._mm_or_pd(
            v._mm_cmplt_pd(v._mm_sub_pd(s, x), y),
            v._mm_cmplt_pd(v._mm_sub_pd(s, y), x),
        );
        // The bits of the number above are 1 more for a positive number, 1 less for a negative one.
        let is_negative = v._mm_castpd_si128(v._mm_cmplt_pd(s, v._mm_set1_pd(0.0)));
        let step = v._mm_or_si128(is_negative, v._mm_set1_epi64x(1));
        let step = v._mm_and_si128(step, v._mm_castpd_si128(is_below));
        interval(v._mm_castsi128_pd(v._mm_add_epi64(v._mm_castpd_si128(s), step)))
    }

    /// Encloses the product; `None` if an end is zero or infinite, or where it may underflow.
    #[inline(always)]
    pub(in crate::interval) fn product(x: Interval, y: Interval) -> Option<Interval> {
        let v = sse2();
        let (lo, hi) = (v._mm_set1_pd(y.lo), v._mm_set1_pd(y.hi));
        let signed = |x: f64| v._mm_set_pd(x, -x);
        let (low, high) = (signed(x.lo), signed(x.hi));
        // The largest of (-z, z) over the products z of two ends. `max_pd` returns its second
        // argument if one is NaN. A NaN is 0 · ∞, and then 0 is among the other products or the
        // first one is NaN.
        let largest = v._mm_mul_pd(low, lo);
        let largest = v._mm_max_pd(v._mm_mul_pd(low, hi), largest);
        let largest = v._mm_max_pd(v._mm_mul_pd(high, lo), largest);
        let largest = v._mm_max_pd(v._mm_mul_pd(high, hi), largest);
        // The upper halves of the numbers between TINY and ∞ are consecutive integers.
        let sizes = magnitudes(largest);
        let above = v._mm_sub_epi32(v._mm_castpd_si128(sizes), v._mm_set1_epi32(FIRST));
        let is_valid = v._mm_cmplt_epi32(above, v._mm_set1_epi32(COUNT));
        (v._mm_movemask_pd(v._mm_castsi128_pd(is_valid)) == 3)
            .then(|| interval(v._mm_add_pd(largest, v._mm_mul_pd(sizes, v._mm_set1_pd(STEP)))))
    }

    /// Upper half of the bits of the first number beyond [`TINY`] with a lower half of 0, moved so
    /// that signed integers from the smallest one on stand for the numbers from there to ∞.
    const FIRST: i32 = upper_half(TINY).wrapping_add(1).wrapping_sub(i32::MIN);

    /// End of these integers.
    const COUNT: i32 = upper_half(f64::INFINITY).wrapping_sub(FIRST);

    const fn upper_half(x: f64) -> i32 {
        (x.to_bits() >> 32) as i32
    }
}

#[cfg(any(test, not(target_arch = "x86_64")))]
mod one_by_one {
    use super::{Interval, STEP, TINY, rounded_product};
    use crate::rounding::{add_down, add_up};

    /// Encloses the sum.
    #[inline]
    pub(in crate::interval) fn sum(x: Interval, y: Interval) -> Interval {
        Interval { lo: add_down(x.lo, y.lo), hi: add_up(x.hi, y.hi) }
    }

    /// Encloses the product; `None` if an end is zero or infinite, or where it may underflow.
    #[inline]
    pub(in crate::interval) fn product(x: Interval, y: Interval) -> Option<Interval> {
        let (lo, hi) = rounded_product(x, y);
        // Each of the four ends is a factor of these products. Where both are finite, none of the
        // four products is 0 · ∞.
        let (ll, hh) = (x.lo * y.lo, x.hi * y.hi);
        let is_valid = (lo.abs() > TINY) & (hi.abs() > TINY) & ((ll + hh).abs() < f64::INFINITY);
        is_valid.then(|| Interval { lo: lo - lo.abs() * STEP, hi: hi + hi.abs() * STEP })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Numbers at which rounding, overflow, underflow or signs change, and a few others.
    fn numbers() -> Vec<f64> {
        let sizes = [0.0, 5e-324, 2.3e-308, 1e-290, 1.7e-290, 0.1, 1.0 / 3.0, 1.0, 1.5, 3e9];
        let large = [1.3e154, 1e300, f64::MAX / 2.0, f64::MAX, f64::INFINITY];
        let sizes = sizes.iter().chain(&large).flat_map(|x| [*x, x.next_down()]);
        let mut all: Vec<f64> = sizes.filter(|x| *x >= 0.0).flat_map(|x| [x, -x]).collect();
        all.sort_by(f64::total_cmp);
        all
    }

    #[test]
    fn both_ways_have_the_same_bits() {
        let numbers = numbers();
        let pairs = numbers.iter().flat_map(|lo| numbers.iter().map(|hi| Interval::new(*lo, *hi)));
        let intervals: Vec<Interval> = pairs.flatten().collect();
        let bits = |x: Interval| [x.lo.to_bits(), x.hi.to_bits()];
        let mut products = 0;
        for x in intervals.iter().step_by(7) {
            for y in &intervals {
                assert_eq!(bits(sum(*x, *y)), bits(one_by_one::sum(*x, *y)), "{x:?} {y:?}");
                // One way may leave a product to the general case where the other does not.
                let general = bits(x.mul_with_zero_or_infinity(*y));
                for product in [product(*x, *y), one_by_one::product(*x, *y)].into_iter().flatten()
                {
                    assert_eq!(bits(product), general, "{x:?} {y:?}");
                    products += 1;
                }
            }
        }
        assert!(products > 100_000, "{products}");
    }
}
