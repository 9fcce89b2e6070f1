//! Powers, roots, absolute value and order.

use super::Interval;
use crate::rounding::{mul_down, mul_up, sqrt_down, sqrt_up};

impl Interval {
    /// {|x|}.
    ///
    /// # Guarantee
    /// Exact.
    ///
    /// ```
    /// use reachtube_scalar::Interval;
    ///
    /// assert_eq!(Interval::new(-3.0, 2.0).unwrap().abs(), Interval::new(0.0, 3.0).unwrap());
    /// ```
    #[inline]
    #[must_use]
    pub const fn abs(self) -> Interval {
        Interval { lo: self.mig(), hi: self.mag() }
    }

    /// {x²}, which unlike `x * x` is never negative.
    ///
    /// # Guarantee
    /// Outer, rounded as [`mul_up`] and [`mul_down`].
    ///
    /// ```
    /// use reachtube_scalar::Interval;
    ///
    /// let x = Interval::new(-1.0, 2.0).unwrap();
    /// assert_eq!(x.sqr().lo(), 0.0);
    /// assert!((x * x).lo() <= -2.0);
    /// ```
    #[inline]
    #[must_use]
    pub const fn sqr(self) -> Interval {
        let (mig, mag) = (self.mig(), self.mag());
        Interval { lo: mul_down(mig, mig), hi: mul_up(mag, mag) }
    }

    /// {xⁿ}; x⁰ is 1 for every x, and a negative power of an interval with zero is
    /// [`ENTIRE`](Self::ENTIRE).
    ///
    /// # Guarantee
    /// Outer. Each end is within 3 (n - 1) numbers of the tightest one for n > 0, since a power is
    /// a chain of products; about n are usual.
    ///
    /// ```
    /// use reachtube_scalar::Interval;
    ///
    /// let cube = Interval::new(-1.0, 2.0).unwrap().powi(3);
    /// assert!(cube.encloses(&Interval::new(-1.0, 8.0).unwrap()) && cube.width() < 9.00001);
    /// ```
    #[must_use]
    pub fn powi(self, n: i32) -> Interval {
        let power = match n.unsigned_abs() {
            0 => Interval::ONE,
            1 => self,
            n if n.is_multiple_of(2) => self.abs().increasing_power(n),
            n => self.increasing_power(n),
        };
        if n < 0 { power.recip() } else { power }
    }

    /// xⁿ where that increases over the interval.
    fn increasing_power(self, n: u32) -> Interval {
        Interval { lo: power_of(self.lo, n).lo, hi: power_of(self.hi, n).hi }
    }

    /// {√x} of the numbers x ≥ 0 of the interval; [`ENTIRE`](Self::ENTIRE) where there are none.
    ///
    /// # Guarantee
    /// Outer, rounded as [`sqrt_up`] and [`sqrt_down`].
    ///
    /// ```
    /// use reachtube_scalar::Interval;
    ///
    /// assert!(Interval::point(2.0).sqrt().sqr().contains(2.0));
    /// assert_eq!(Interval::new(-1e-20, 4.0).unwrap().sqrt().lo(), 0.0);
    /// ```
    #[must_use]
    pub fn sqrt(self) -> Interval {
        if self.hi < 0.0 {
            return Interval::ENTIRE;
        }
        Interval { lo: sqrt_down(self.lo.max(0.0)), hi: sqrt_up(self.hi) }
    }

    /// {1 / x}; [`ENTIRE`](Self::ENTIRE) where the interval contains zero.
    ///
    /// # Guarantee
    /// Outer, as the division.
    #[inline]
    #[must_use]
    pub fn recip(self) -> Interval {
        Interval::ONE / self
    }

    /// {min(x, y)}.
    ///
    /// # Guarantee
    /// Exact.
    #[inline]
    #[must_use]
    pub const fn min(self, other: Interval) -> Interval {
        Interval { lo: self.lo.min(other.lo), hi: self.hi.min(other.hi) }
    }

    /// {max(x, y)}.
    ///
    /// # Guarantee
    /// Exact.
    #[inline]
    #[must_use]
    pub const fn max(self, other: Interval) -> Interval {
        Interval { lo: self.lo.max(other.lo), hi: self.hi.max(other.hi) }
    }
}

/// xⁿ of one end, which may be infinite, by repeated squaring.
fn power_of(x: f64, mut n: u32) -> Interval {
    let mut square = Interval { lo: x, hi: x };
    let mut power = Interval::ONE;
    loop {
        if n % 2 == 1 {
            power = if power == Interval::ONE { square } else { power * square };
        }
        n /= 2;
        if n == 0 {
            return power;
        }
        square = square.sqr();
    }
}
