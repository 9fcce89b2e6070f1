//! The exponential function.

use core::f64::consts::LOG2_E;

use super::closed::Interval;
use super::power_series::{PowerSeries, inverse_factorial};
use crate::rounding::two_sum;

/// The leading 41 bits of ln 2 = `LN_2_HEAD` + `LN_2_TAIL`; the product of the head with |k| ≤ 2¹¹
/// is exact.
const LN_2_HEAD: f64 = 0.693147180559663;
const LN_2_TAIL: Interval =
    Interval { lo: 2.8235290563031577e-13, hi: 2.8235290563031577e-13_f64.next_up() };

/// An argument above which e^x overflows.
const OVERFLOW_ARGUMENT: f64 = 710.0;
/// An argument below which e^x is less than the smallest subnormal number.
const UNDERFLOW_ARGUMENT: f64 = -746.0;

/// The series of (e^r - 1 - r) / r² for |r| ≤ 0.4, with Lagrange's remainder e^ξ / 15!, e^ξ < 2.
static SERIES: PowerSeries<13> = {
    let mut c = [Interval::ZERO; 13];
    let mut i = 0;
    while i < 13 {
        c[i] = inverse_factorial(i as u32 + 2);
        i += 1;
    }
    PowerSeries::new(c, 2.0 * inverse_factorial(15).hi, 0.4)
};

impl Interval {
    /// Encloses {e^x}. It does not use the platform's `exp`.
    ///
    /// # Guarantee
    /// Outer, for every x; exact at 0. In every test, each end is within 1 ulp of the tightest
    /// interval. The upper end is infinite if e^x overflows, the lower end is 0 where it
    /// underflows.
    ///
    /// ```
    /// use reachtube_scalar::Interval;
    ///
    /// let e = Interval::ONE.exp();
    /// assert!(e.contains(std::f64::consts::E) && e.width() < 3e-15);
    /// assert_eq!(Interval::ZERO.exp(), Interval::ONE);
    /// ```
    #[must_use]
    pub fn exp(self) -> Interval {
        let lo = exp_of(self.lo);
        let hi = if self.hi == self.lo { lo } else { exp_of(self.hi) };
        Interval { lo: lo.lo, hi: hi.hi }
    }
}

/// Encloses e^x for one x, which may be infinite.
fn exp_of(x: f64) -> Interval {
    if x > OVERFLOW_ARGUMENT {
        return Interval { lo: f64::MAX, hi: f64::INFINITY };
    }
    if x < UNDERFLOW_ARGUMENT {
        return Interval { lo: 0.0, hi: 0.0_f64.next_up() };
    }
    // Reduction: x = k ln 2 + head + tail. Any integer k is valid; the nearest one gives the
    // smallest |head + tail|, at most 0.35.
    let k = (x * LOG2_E).round();
    let (head, error) = two_sum(x, -k * LN_2_HEAD);
    let tail = Interval::point(error) - LN_2_TAIL * k;
    // Series: e^r = 1 + r + r² SERIES(r), times 2^k.
    let r = tail + head;
    let correction = tail + r.sqr() * SERIES.evaluate(r);
    let power = times_power_of_two(correction + head + 1.0, k as i32);
    // e^x - 1 has the sign of x. This step keeps inclusion isotonicity, because e^0 is exact.
    if x > 0.0 { power.max(Interval::ONE) } else { power.min(Interval::ONE) }
}

/// Encloses m · 2^k for m near 1 and |k| < 1100; exact unless an end leaves the normal numbers.
fn times_power_of_two(m: Interval, k: i32) -> Interval {
    let power = |k: i32| f64::from_bits(((1023 + k) as u64) << 52);
    let (first, second) = (power(k / 2), power(k - k / 2));
    let scaled = Interval { lo: m.lo * first * second, hi: m.hi * first * second };
    if scaled.lo.is_normal() && scaled.hi.is_normal() {
        return scaled;
    }
    Interval { lo: scaled_down(m.lo * first, second), hi: scaled_up(m.hi * first, second) }
}

/// The largest number that is at most x · power, for a power of two of 2^-600 to 2^600: what was
/// rounded shows, because the quotient is exact.
fn scaled_down(x: f64, power: f64) -> f64 {
    let product = x * power;
    if product / power > x { product.next_down() } else { product }
}

/// The smallest number that is at least x · power, for a power of two of 2^-600 to 2^600.
fn scaled_up(x: f64, power: f64) -> f64 {
    let product = x * power;
    if product / power < x { product.next_up() } else { product }
}

#[cfg(test)]
mod tests {
    use num_rational::BigRational;

    use super::*;

    /// Compares the two parts with ln 2 to 60 decimals.
    #[test]
    fn parts_enclose_ln_2() {
        let exact = |x: f64| BigRational::from_float(x).unwrap();
        let digits: BigRational =
            "693147180559945309417232121458176568075500134360255254120680".parse().unwrap();
        let ten: BigRational = "10".parse().unwrap();
        let value = digits / num_traits::pow(ten, 60);
        let rest = value - exact(LN_2_HEAD);
        assert!(exact(LN_2_TAIL.lo) < rest && rest < exact(LN_2_TAIL.hi));
        assert_eq!(LN_2_HEAD.to_bits() & ((1 << 12) - 1), 0, "the head has more than 41 bits");
    }
}
