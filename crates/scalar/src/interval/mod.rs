//! The type [`Interval`]: constructors, accessors and predicates.

mod arithmetic;
mod decimal;
mod exponential;
mod inverse;
mod powers;
mod taylor;
mod trigonometric;

pub use decimal::DecimalError;

use crate::rounding::{add_up, sub_down, sub_up};

/// A closed interval [lo, hi] of real numbers, lo ≤ hi, with ends rounded outwards.
///
/// Ends may be infinite (the interval is then unbounded) but never NaN, and an interval is never
/// empty. All operations are those of sets: the result encloses x ∘ y for **every** x and y of the
/// operands, so `x - x` is not zero unless x is a point. Comparison `==` compares ends.
///
/// # Guarantee
/// Every operation is outer, under the rounding of [`rounding`](crate::rounding): the exact result
/// for real numbers of the operands lies in the interval returned.
///
/// # Examples
///
/// ```
/// use reachtube_scalar::Interval;
///
/// let x = Interval::new(1.0, 2.0).unwrap();
/// let y = x * x - x;
/// assert!(y.encloses(&Interval::new(-1.0, 3.0).unwrap()));
/// assert!((Interval::point(1.0) / 3.0).width() < 3e-16);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval {
    lo: f64,
    hi: f64,
}

impl Interval {
    /// All real numbers, [-∞, ∞].
    pub const ENTIRE: Interval = Interval { lo: f64::NEG_INFINITY, hi: f64::INFINITY };
    /// The number 0.
    pub const ZERO: Interval = Interval { lo: 0.0, hi: 0.0 };
    /// The number 1.
    pub const ONE: Interval = Interval { lo: 1.0, hi: 1.0 };

    /// [lo, hi], or `None` where that holds no real number: an end is NaN, lo > hi, lo = +∞ or hi =
    /// -∞.
    ///
    /// ```
    /// use reachtube_scalar::Interval;
    ///
    /// assert!(Interval::new(1.0, 2.0).is_some());
    /// assert_eq!(Interval::new(2.0, 1.0), None);
    /// assert_eq!(Interval::new(f64::NAN, 1.0), None);
    /// ```
    #[inline]
    #[must_use]
    pub const fn new(lo: f64, hi: f64) -> Option<Interval> {
        if lo <= hi && lo < f64::INFINITY && hi > f64::NEG_INFINITY {
            Some(Interval { lo, hi })
        } else {
            None
        }
    }

    /// The number x, exactly; x must be finite, which is checked in debug builds.
    ///
    /// In release builds an infinite or NaN x gives [`ENTIRE`](Self::ENTIRE).
    #[inline]
    #[must_use]
    pub const fn point(x: f64) -> Interval {
        debug_assert!(x.is_finite(), "Interval::point needs a finite number");
        if x.is_finite() { Interval { lo: x, hi: x } } else { Interval::ENTIRE }
    }

    /// The numbers within `rad` ≥ 0 of `mid`.
    ///
    /// # Guarantee
    /// Outer: [mid - rad, mid + rad] with ends rounded outwards. A negative or NaN radius, or a NaN
    /// centre, gives [`ENTIRE`](Self::ENTIRE).
    #[inline]
    #[must_use]
    pub const fn centered(mid: f64, rad: f64) -> Interval {
        match Interval::new(sub_down(mid, rad), add_up(mid, rad)) {
            Some(x) => x,
            None => Interval::ENTIRE,
        }
    }

    /// The lower end.
    #[inline]
    #[must_use]
    pub const fn lo(self) -> f64 {
        self.lo
    }

    /// The upper end.
    #[inline]
    #[must_use]
    pub const fn hi(self) -> f64 {
        self.hi
    }

    /// A finite number of the interval, the nearest to its middle up to rounding; 0 for
    /// [`ENTIRE`](Self::ENTIRE), the largest (smallest) finite number where only the upper (lower)
    /// end is infinite.
    #[inline]
    #[must_use]
    pub fn mid(self) -> f64 {
        let sum = self.lo + self.hi;
        if sum.is_finite() { 0.5 * sum } else { self.mid_of_large_ends() }
    }

    #[cold]
    fn mid_of_large_ends(self) -> f64 {
        if self == Interval::ENTIRE {
            0.0
        } else {
            (0.5 * self.lo + 0.5 * self.hi).clamp(f64::MIN, f64::MAX)
        }
    }

    /// The radius about [`mid`](Self::mid).
    ///
    /// # Guarantee
    /// Outer: the interval lies in [mid - rad, mid + rad] taken exactly.
    #[inline]
    #[must_use]
    pub fn rad(self) -> f64 {
        let mid = self.mid();
        sub_up(mid, self.lo).max(sub_up(self.hi, mid))
    }

    /// hi - lo, rounded up.
    #[inline]
    #[must_use]
    pub const fn width(self) -> f64 {
        sub_up(self.hi, self.lo)
    }

    /// The largest |x| of the interval, exactly.
    #[inline]
    #[must_use]
    pub const fn mag(self) -> f64 {
        self.lo.abs().max(self.hi.abs())
    }

    /// The smallest |x| of the interval, exactly.
    #[inline]
    #[must_use]
    pub const fn mig(self) -> f64 {
        if self.contains_zero() { 0.0 } else { self.lo.abs().min(self.hi.abs()) }
    }

    /// Whether x lies in the interval.
    #[inline]
    #[must_use]
    pub const fn contains(self, x: f64) -> bool {
        self.lo <= x && x <= self.hi
    }

    /// Whether 0 lies in the interval.
    #[inline]
    #[must_use]
    pub const fn contains_zero(self) -> bool {
        self.contains(0.0)
    }

    /// Whether every number of `other` lies in this interval.
    #[inline]
    #[must_use]
    pub const fn encloses(self, other: &Interval) -> bool {
        self.lo <= other.lo && other.hi <= self.hi
    }

    /// The smallest interval that encloses both, exactly.
    #[inline]
    #[must_use]
    pub const fn hull(self, other: Interval) -> Interval {
        Interval { lo: self.lo.min(other.lo), hi: self.hi.max(other.hi) }
    }

    /// The numbers that lie in both, exactly; `None` where there is none.
    #[inline]
    #[must_use]
    pub const fn intersection(self, other: Interval) -> Option<Interval> {
        Interval::new(self.lo.max(other.lo), self.hi.min(other.hi))
    }
}

impl From<f64> for Interval {
    /// As [`Interval::point`].
    fn from(x: f64) -> Interval {
        Interval::point(x)
    }
}
