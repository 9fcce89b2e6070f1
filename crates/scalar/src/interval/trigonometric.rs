//! Sine and cosine, and the constants π, π/2 and 2π.

use core::f64::consts;

use super::closed::Interval;
use super::power_series::{PowerSeries, inverse_factorial};
use crate::rounding::two_sum;

/// The leading parts of π/2 = Σ `FRAC_PI_2_PARTS` + `FRAC_PI_2_REST`.
///
/// Each part has at most 32 bits, so that its product with |k| < 2²⁰ is exact. There are four parts
/// because an `f64` below 2²⁰ can be as near to a multiple of π/2 as about 2⁻⁶⁰.
const FRAC_PI_2_PARTS: [f64; 3] =
    [1.5707963267341256, 6.077100506303966e-11, 2.0222662487111665e-21];
const FRAC_PI_2_REST: Interval =
    Interval { lo: 8.4784276603689e-32, hi: 8.4784276603689e-32_f64.next_up() };

/// The largest |x| in rad for which the reduction is exact. Beyond it, sine and cosine are [-1, 1].
const LARGEST_ANGLE: f64 = (1 << 20) as f64;

const RANGE: Interval = Interval { lo: -1.0, hi: 1.0 };

/// Returns the series in r² with coefficients ±1 / (2i + first)! of alternating sign, for r² ≤
/// 0.64.
///
/// Lagrange's remainder is a derivative of sine or cosine, which lies in [-1, 1], over (16 +
/// first)!.
const fn alternating(first: u32, first_is_negative: bool) -> PowerSeries<8> {
    let mut c = [Interval::ZERO; 8];
    let mut i = 0;
    while i < 8 {
        let a = inverse_factorial(2 * i as u32 + first);
        c[i] =
            if (i % 2 == 0) == first_is_negative { Interval { lo: -a.hi, hi: -a.lo } } else { a };
        i += 1;
    }
    PowerSeries::new(c, inverse_factorial(16 + first).hi, 0.64)
}

/// The series of (sin r - r) / r³.
static SINE: PowerSeries<8> = alternating(3, true);
/// The series of (cos r - 1 + r²/2) / r⁴.
static COSINE: PowerSeries<8> = alternating(4, false);

/// An angle reduced to quadrant · π/2 + (head + tail) in rad, |head + tail| ≤ 0.8.
#[derive(Clone, Copy)]
struct ReducedAngle {
    quadrant: i64,
    head: f64,
    tail: Interval,
}

impl ReducedAngle {
    /// Reduces |x| ≤ [`LARGEST_ANGLE`] by Cody & Waite's method and keeps every rounding error.
    fn new(x: f64) -> ReducedAngle {
        // Any integer is valid; the nearest one gives the smallest rest.
        let k = (x * consts::FRAC_2_PI).round();
        let (mut head, mut tail) = (x, Interval::ZERO);
        let mut errors = [0.0; 3];
        for (part, error) in FRAC_PI_2_PARTS.iter().zip(&mut errors) {
            (head, *error) = two_sum(head, -k * part);
        }
        tail -= FRAC_PI_2_REST * k;
        // Later errors are smaller and are added first.
        for error in errors.iter().rev() {
            tail += *error;
        }
        ReducedAngle { quadrant: k as i64, head, tail }
    }

    /// Encloses head + tail.
    fn rest(&self) -> Interval {
        self.tail + self.head
    }

    /// Encloses sin(head + tail). The head is added last, which costs one rounding.
    fn sin_of_rest(&self) -> Interval {
        let r = self.rest();
        let square = r.sqr();
        (self.tail + r * square * SINE.evaluate(square)) + self.head
    }

    /// Encloses cos(head + tail) = 1 - b²/2 - (r - b)(r + b)/2 + r⁴ COSINE(r²) for r = head + tail.
    ///
    /// b holds the leading 26 bits of r, so that b² is exact.
    fn cos_of_rest(&self) -> Interval {
        let r = self.rest();
        let b = leading_bits(self.head);
        let (one_less, error) = two_sum(1.0, -0.5 * b * b);
        let beyond_b = (r - b) * (r + b) * 0.5;
        let square = r.sqr();
        (square.sqr() * COSINE.evaluate(square) - beyond_b + error) + one_less
    }

    /// Encloses sin(x + quarter_turns · π/2).
    fn sin(&self, quarter_turns: i64) -> Interval {
        match (self.quadrant + quarter_turns).rem_euclid(4) {
            0 => self.sin_of_rest(),
            1 => self.cos_of_rest(),
            2 => -self.sin_of_rest(),
            _ => -self.cos_of_rest(),
        }
    }

    /// Returns a lower and an upper bound of ⌊x / (π/2)⌋. They are equal unless the enclosure of
    /// the rest contains numbers of both signs.
    fn floor(&self) -> (i64, i64) {
        let rest = self.rest();
        (self.quadrant - i64::from(rest.lo < 0.0), self.quadrant - i64::from(rest.hi < 0.0))
    }
}

/// Returns the leading 26 bits of x, whose square is exact; 0 if the square might underflow.
fn leading_bits(x: f64) -> f64 {
    if x.abs() < 1e-9 { 0.0 } else { f64::from_bits(x.to_bits() >> 27 << 27) }
}

/// Reduces both ends of an interval; `None` if an end is beyond [`LARGEST_ANGLE`].
fn reduce(x: Interval) -> Option<[ReducedAngle; 2]> {
    if x.mag() > LARGEST_ANGLE {
        return None;
    }
    let lo = ReducedAngle::new(x.lo);
    Some([lo, if x.lo == x.hi { lo } else { ReducedAngle::new(x.hi) }])
}

/// Encloses sin(x + quarter_turns · π/2) for x between two ends.
///
/// The result is the hull of the values at the ends, and of ±1 where an extremum lies between.
fn sin_between([lo, hi]: [ReducedAngle; 2], quarter_turns: i64) -> Interval {
    let mut values = lo.sin(quarter_turns).hull(hi.sin(quarter_turns));
    let (before, last) = (lo.floor().0 + quarter_turns, hi.floor().1 + quarter_turns);
    // Whether (before, last] contains an integer j ≡ remainder (mod 4); jπ/2 is then an extremum.
    let is_between = |remainder: i64| before + 1 + (remainder - before - 1).rem_euclid(4) <= last;
    if is_between(1) {
        values.hi = 1.0;
    }
    if is_between(3) {
        values.lo = -1.0;
    }
    Interval { lo: values.lo.max(-1.0), hi: values.hi.min(1.0) }
}

impl Interval {
    /// An enclosure of π.
    ///
    /// # Guarantee
    /// The tightest enclosure.
    pub const PI: Interval = Interval { lo: consts::PI, hi: consts::PI.next_up() };
    /// An enclosure of π/2.
    ///
    /// # Guarantee
    /// The tightest enclosure.
    pub const FRAC_PI_2: Interval =
        Interval { lo: consts::FRAC_PI_2, hi: consts::FRAC_PI_2.next_up() };
    /// An enclosure of 2π.
    ///
    /// # Guarantee
    /// The tightest enclosure.
    pub const TAU: Interval = Interval { lo: consts::TAU, hi: consts::TAU.next_up() };

    /// Encloses the sine of an angle in rad.
    ///
    /// # Guarantee
    /// Outer, with the accuracy of [`sin_cos`](Self::sin_cos).
    #[must_use]
    pub fn sin(self) -> Interval {
        reduce(self).map_or(RANGE, |ends| sin_between(ends, 0))
    }

    /// Encloses the cosine of an angle in rad.
    ///
    /// # Guarantee
    /// Outer, with the accuracy of [`sin_cos`](Self::sin_cos).
    #[must_use]
    pub fn cos(self) -> Interval {
        reduce(self).map_or(RANGE, |ends| sin_between(ends, 1))
    }

    /// Encloses {sin x} and {cos x} of an angle x in rad. It does not use the platform's `sin` and
    /// `cos`.
    ///
    /// # Guarantee
    /// Outer, for every x, and within [-1, 1]; sin 0 and cos 0 are exact. In every test with
    /// |x| ≤ 2²⁰ rad, each end is within 1 ulp of the tightest interval, also beside the zeros.
    /// Beyond 2²⁰ ≈ 10⁶ rad, both results are [-1, 1].
    ///
    /// ```
    /// use reachtube_scalar::Interval;
    ///
    /// let (sin, cos) = Interval::new(0.0, 2.0).unwrap().sin_cos();
    /// assert_eq!((sin.lo(), sin.hi(), cos.hi()), (0.0, 1.0, 1.0));
    /// assert!(Interval::PI.sin().contains_zero());
    /// ```
    #[must_use]
    pub fn sin_cos(self) -> (Interval, Interval) {
        reduce(self).map_or((RANGE, RANGE), |ends| (sin_between(ends, 0), sin_between(ends, 1)))
    }
}

#[cfg(test)]
mod tests {
    use num_rational::BigRational;

    use super::*;

    /// Compares the parts with π to 60 decimals.
    #[test]
    fn parts_enclose_half_pi() {
        let exact = |x: f64| BigRational::from_float(x).unwrap();
        let digits: BigRational =
            "3141592653589793238462643383279502884197169399375105820974944".parse().unwrap();
        let ten: BigRational = "10".parse().unwrap();
        let value = digits / num_traits::pow(ten, 60) / exact(2.0);
        let rest = value - FRAC_PI_2_PARTS.iter().map(|&part| exact(part)).sum::<BigRational>();
        assert!(exact(FRAC_PI_2_REST.lo) < rest && rest < exact(FRAC_PI_2_REST.hi));
        let has_32_bits = |part: f64| (part.to_bits() & ((1 << 21) - 1)) == 0;
        assert!(FRAC_PI_2_PARTS.into_iter().all(has_32_bits));
    }
}
