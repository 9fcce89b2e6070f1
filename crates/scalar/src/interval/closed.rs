//! The type [`Interval`]: constructors, accessors, predicates and set operations.

use crate::rounding::{add_up, sub_down, sub_up};

/// A closed interval [lo, hi] of real numbers, lo ≤ hi, whose operations round outwards.
///
/// An end can be infinite, which makes the interval unbounded, but never NaN. An interval is never
/// empty. Operations are set operations: the result encloses x ∘ y for **every** x and y of the
/// operands, so `x - x` is not zero unless x is a point. The operator `==` compares the ends.
///
/// # Guarantee
/// Every operation is outer under the directed rounding of [`rounding`](crate::rounding): the
/// result contains the exact real result for all members of the operands.
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
    pub(super) lo: f64,
    pub(super) hi: f64,
}

impl Interval {
    /// The set of all real numbers, [-∞, ∞].
    pub const ENTIRE: Interval = Interval { lo: f64::NEG_INFINITY, hi: f64::INFINITY };
    /// The number 0.
    pub const ZERO: Interval = Interval { lo: 0.0, hi: 0.0 };
    /// The number 1.
    pub const ONE: Interval = Interval { lo: 1.0, hi: 1.0 };

    /// Returns [lo, hi], or `None` if it contains no real number: if an end is NaN, lo > hi, lo =
    /// +∞ or hi = -∞.
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

    /// Returns the interval [x, x] of a finite x.
    ///
    /// An infinite or NaN x gives [`ENTIRE`](Self::ENTIRE) in release builds.
    ///
    /// # Panics
    /// Panics in debug builds where x is infinite or NaN.
    #[inline]
    #[must_use]
    pub const fn point(x: f64) -> Interval {
        debug_assert!(x.is_finite(), "Interval::point needs a finite number");
        if x.is_finite() { Interval { lo: x, hi: x } } else { Interval::ENTIRE }
    }

    /// Encloses the numbers within `rad` ≥ 0 of `mid`.
    ///
    /// # Guarantee
    /// The tightest enclosure of [mid - rad, mid + rad]. A negative or NaN radius, or a NaN centre,
    /// gives [`ENTIRE`](Self::ENTIRE).
    #[inline]
    #[must_use]
    pub const fn centred(mid: f64, rad: f64) -> Interval {
        match Interval::new(sub_down(mid, rad), add_up(mid, rad)) {
            Some(x) => x,
            None => Interval::ENTIRE,
        }
    }

    /// Returns the lower end.
    #[inline]
    #[must_use]
    pub const fn lo(self) -> f64 {
        self.lo
    }

    /// Returns the upper end.
    #[inline]
    #[must_use]
    pub const fn hi(self) -> f64 {
        self.hi
    }

    /// Returns the midpoint, rounded to a finite number of the interval.
    ///
    /// The midpoint of [`ENTIRE`](Self::ENTIRE) is 0. Where only the upper (lower) end is infinite,
    /// it is the largest (smallest) finite number.
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

    /// Returns the radius about [`mid`](Self::mid), rounded up.
    ///
    /// # Guarantee
    /// Outer: the interval lies in [mid - rad, mid + rad], computed exactly.
    #[inline]
    #[must_use]
    pub fn rad(self) -> f64 {
        let mid = self.mid();
        sub_up(mid, self.lo).max(sub_up(self.hi, mid))
    }

    /// Returns hi - lo, rounded up.
    #[inline]
    #[must_use]
    pub const fn width(self) -> f64 {
        sub_up(self.hi, self.lo)
    }

    /// Returns the magnitude: the largest |x| of the interval, exactly.
    #[inline]
    #[must_use]
    pub const fn mag(self) -> f64 {
        self.lo.abs().max(self.hi.abs())
    }

    /// Returns the mignitude: the smallest |x| of the interval, exactly.
    #[inline]
    #[must_use]
    pub const fn mig(self) -> f64 {
        if self.contains_zero() { 0.0 } else { self.lo.abs().min(self.hi.abs()) }
    }

    /// Returns whether x lies in the interval.
    #[inline]
    #[must_use]
    pub const fn contains(self, x: f64) -> bool {
        self.lo <= x && x <= self.hi
    }

    /// Returns whether 0 lies in the interval.
    #[inline]
    #[must_use]
    pub const fn contains_zero(self) -> bool {
        self.contains(0.0)
    }

    /// Returns whether every number of `other` lies in this interval.
    #[inline]
    #[must_use]
    pub const fn encloses(self, other: &Interval) -> bool {
        self.lo <= other.lo && other.hi <= self.hi
    }

    /// Returns the smallest interval that encloses both, exactly.
    #[inline]
    #[must_use]
    pub const fn hull(self, other: Interval) -> Interval {
        Interval { lo: self.lo.min(other.lo), hi: self.hi.max(other.hi) }
    }

    /// Returns the intersection of both, exactly; `None` if it is empty.
    #[inline]
    #[must_use]
    pub const fn intersection(self, other: Interval) -> Option<Interval> {
        Interval::new(self.lo.max(other.lo), self.hi.min(other.hi))
    }
}

impl From<f64> for Interval {
    /// Converts like [`Interval::point`].
    fn from(x: f64) -> Interval {
        Interval::point(x)
    }
}
