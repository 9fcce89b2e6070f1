//! Powers, roots, absolute value, minimum and maximum.

use super::closed::Interval;
use crate::rounding::{mul_down, mul_up, sqrt_down, sqrt_up};

impl Interval {
    /// Returns {|x|}.
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

    /// Encloses {x²}, which unlike `x * x` contains no negative numbers.
    ///
    /// # Guarantee
    /// Outer, with the rounding of [`mul_up`] and [`mul_down`].
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

    /// Encloses {xⁿ}; x⁰ is 1 for every x.
    ///
    /// A negative power of an interval that contains zero is [`ENTIRE`](Self::ENTIRE).
    ///
    /// # Guarantee
    /// Outer. For n > 0, each end is within 3 (n - 1) ulps of the tightest interval, because a
    /// power is a chain of products; about n ulps are usual.
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

    /// Encloses {xⁿ} where xⁿ increases over the interval.
    fn increasing_power(self, n: u32) -> Interval {
        Interval { lo: power_of(self.lo, n).lo, hi: power_of(self.hi, n).hi }
    }

    /// Encloses {√x} over the numbers x ≥ 0 of the interval; it is [`ENTIRE`](Self::ENTIRE) if
    /// there are none.
    ///
    /// # Guarantee
    /// Outer, with the rounding of [`sqrt_up`] and [`sqrt_down`].
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

    /// Encloses {1 / x}; it is [`ENTIRE`](Self::ENTIRE) if the interval contains zero.
    ///
    /// # Guarantee
    /// Outer, with the rounding of the division.
    #[inline]
    #[must_use]
    pub fn recip(self) -> Interval {
        Interval::ONE / self
    }

    /// Returns {min(x, y)} over all x and y of the intervals.
    ///
    /// # Guarantee
    /// Exact.
    #[inline]
    #[must_use]
    pub const fn min(self, other: Interval) -> Interval {
        Interval { lo: self.lo.min(other.lo), hi: self.hi.min(other.hi) }
    }

    /// Returns {max(x, y)} over all x and y of the intervals.
    ///
    /// # Guarantee
    /// Exact.
    #[inline]
    #[must_use]
    pub const fn max(self, other: Interval) -> Interval {
        Interval { lo: self.lo.max(other.lo), hi: self.hi.max(other.hi) }
    }
}

/// Encloses xⁿ for one x, which may be infinite, by repeated squaring.
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
