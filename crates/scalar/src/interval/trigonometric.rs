//! Sine and cosine, and the constants π, π/2 and 2π.

use core::f64::consts;

use super::Interval;
use super::taylor::{Series, inverse_factorial};
use crate::rounding::two_sum;

/// π/2 = Σ `FRAC_PI_2_PARTS` + `FRAC_PI_2_REST`; each part has at most 32 bits, so that its product
/// with |k| < 2²⁰ is exact. Four parts, because an `f64` below 2²⁰ can be as near to a multiple of
/// π/2 as 2⁻⁶⁰ or so.
const FRAC_PI_2_PARTS: [f64; 3] =
    [1.5707963267341256, 6.077100506303966e-11, 2.0222662487111665e-21];
const FRAC_PI_2_REST: Interval =
    Interval { lo: 8.4784276603689e-32, hi: 8.4784276603689e-32_f64.next_up() };

/// Beyond it [-1, 1] is returned: the reduction would no longer be exact.
const LARGEST_ANGLE: f64 = (1 << 20) as f64;

const RANGE: Interval = Interval { lo: -1.0, hi: 1.0 };

/// The series in r² of the coefficients ±1 / (2i + first)!, of alternating sign, for r² ≤ 0.64,
/// with Lagrange's remainder: a derivative of sine somewhere, which lies in [-1, 1], for the sign.
const fn alternating(first: u32, first_is_negative: bool) -> Series<8> {
    let mut c = [Interval::ZERO; 8];
    let mut i = 0;
    while i < 8 {
        let a = inverse_factorial(2 * i as u32 + first);
        c[i] =
            if (i % 2 == 0) == first_is_negative { Interval { lo: -a.hi, hi: -a.lo } } else { a };
        i += 1;
    }
    Series::new(c, inverse_factorial(16 + first).hi, 0.64)
}

/// (sin r - r) / r³.
static SINE: Series<8> = alternating(3, true);
/// (cos r - 1 + r²/2) / r⁴.
static COSINE: Series<8> = alternating(4, false);

/// An angle as quadrant · π/2 + (head + tail), |head + tail| ≤ 0.8.
#[derive(Clone, Copy)]
struct Reduced {
    quadrant: i64,
    head: f64,
    tail: Interval,
}

impl Reduced {
    /// Of |x| ≤ [`LARGEST_ANGLE`] (Cody & Waite's reduction with every rounding error kept).
    fn new(x: f64) -> Reduced {
        // Any integer would be right; the nearest makes the rest least.
        let k = (x * consts::FRAC_2_PI).round();
        let (mut head, mut tail) = (x, Interval::ZERO);
        let mut errors = [0.0; 3];
        for (part, error) in FRAC_PI_2_PARTS.iter().zip(&mut errors) {
            (head, *error) = two_sum(head, -k * part);
        }
        tail -= FRAC_PI_2_REST * k;
        // Small ones first: the later the error, the smaller.
        for error in errors.iter().rev() {
            tail += *error;
        }
        Reduced { quadrant: k as i64, head, tail }
    }

    fn rest(&self) -> Interval {
        self.tail + self.head
    }

    /// sin(head + tail), where adding the head last costs one rounding only.
    fn sin_of_rest(&self) -> Interval {
        let r = self.rest();
        let square = r.sqr();
        (self.tail + r * square * SINE.at(square)) + self.head
    }

    /// cos(head + tail) = 1 - b²/2 - (r - b)(r + b)/2 + …, where b is r to 26 bits, so that b² is
    /// exact.
    fn cos_of_rest(&self) -> Interval {
        let r = self.rest();
        let b = leading_bits(self.head);
        let (one_less, error) = two_sum(1.0, -0.5 * b * b);
        let beyond_b = (r - b) * (r + b) * 0.5;
        let square = r.sqr();
        (square.sqr() * COSINE.at(square) - beyond_b + error) + one_less
    }

    /// sin(x + shift · π/2).
    fn sin(&self, shift: i64) -> Interval {
        match (self.quadrant + shift).rem_euclid(4) {
            0 => self.sin_of_rest(),
            1 => self.cos_of_rest(),
            2 => -self.sin_of_rest(),
            _ => -self.cos_of_rest(),
        }
    }

    /// An integer at or below ⌊x / (π/2)⌋, and one at or above; they agree unless the rest has no
    /// certain sign.
    fn floor(&self) -> (i64, i64) {
        let rest = self.rest();
        (self.quadrant - i64::from(rest.lo < 0.0), self.quadrant - i64::from(rest.hi < 0.0))
    }
}

/// The leading 26 bits of x, of which the square is exact; 0 where that might underflow.
fn leading_bits(x: f64) -> f64 {
    if x.abs() < 1e-9 { 0.0 } else { f64::from_bits(x.to_bits() >> 27 << 27) }
}

/// Both ends of an interval, reduced; `None` where an end is beyond [`LARGEST_ANGLE`].
fn reduce(x: Interval) -> Option<[Reduced; 2]> {
    if x.mag() > LARGEST_ANGLE {
        return None;
    }
    let lo = Reduced::new(x.lo);
    Some([lo, if x.lo == x.hi { lo } else { Reduced::new(x.hi) }])
}

/// The values of sin(x + shift · π/2) between the two ends: the hull of those at the ends, and ±1
/// where a multiple j of π/2 with an extremum lies between.
fn sin_between([lo, hi]: [Reduced; 2], shift: i64) -> Interval {
    let mut values = lo.sin(shift).hull(hi.sin(shift));
    let (before, last) = (lo.floor().0 + shift, hi.floor().1 + shift);
    // Multiples in (before, last] that leave `remainder` when divided by 4.
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
    /// π.
    ///
    /// # Guarantee
    /// The tightest enclosure.
    pub const PI: Interval = Interval { lo: consts::PI, hi: consts::PI.next_up() };
    /// π/2.
    ///
    /// # Guarantee
    /// The tightest enclosure.
    pub const FRAC_PI_2: Interval =
        Interval { lo: consts::FRAC_PI_2, hi: consts::FRAC_PI_2.next_up() };
    /// 2π.
    ///
    /// # Guarantee
    /// The tightest enclosure.
    pub const TAU: Interval = Interval { lo: consts::TAU, hi: consts::TAU.next_up() };

    /// The sine of an angle in rad; see [`sin_cos`](Self::sin_cos).
    ///
    /// # Guarantee
    /// As [`sin_cos`](Self::sin_cos).
    #[must_use]
    pub fn sin(self) -> Interval {
        reduce(self).map_or(RANGE, |ends| sin_between(ends, 0))
    }

    /// The cosine of an angle in rad; see [`sin_cos`](Self::sin_cos).
    ///
    /// # Guarantee
    /// As [`sin_cos`](Self::sin_cos).
    #[must_use]
    pub fn cos(self) -> Interval {
        reduce(self).map_or(RANGE, |ends| sin_between(ends, 1))
    }

    /// (sin x, cos x) of an angle x in rad.
    ///
    /// # Guarantee
    /// Outer, for every x, and within [-1, 1]; sin 0 and cos 0 are exact. For angles up to 2²⁰ ≈
    /// 10⁶ rad each end is the tightest `f64` or (as far as the tests have seen) the next one, also
    /// beside the zeros; beyond, [-1, 1] is returned. The platform's `sin` and `cos` are not used.
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

    /// π to 60 decimals.
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
