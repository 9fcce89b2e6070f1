use crate::interval::closed::Interval;
use crate::scalar::Scalar;

/// A scalar with elementary functions.
///
/// # Guarantee
///
/// Over `Interval`, and for coefficients of type `Interval`: outer enclosures.
pub trait Elementary: Scalar {
    /// Returns the square root.
    fn sqrt(&self) -> Self;
    /// Returns the exponential function.
    fn exp(&self) -> Self;
    /// Returns the natural logarithm.
    fn ln(&self) -> Self;
    /// Returns sine and cosine of an angle in rad.
    fn sin_cos(&self) -> (Self, Self);
    /// Returns the angle of the point (x, self) in rad, in (-π, π].
    fn atan2(&self, x: &Self) -> Self;
}

impl Elementary for f64 {
    fn sqrt(&self) -> Self {
        f64::sqrt(*self)
    }

    fn exp(&self) -> Self {
        f64::exp(*self)
    }

    fn ln(&self) -> Self {
        f64::ln(*self)
    }

    fn sin_cos(&self) -> (Self, Self) {
        f64::sin_cos(*self)
    }

    fn atan2(&self, x: &Self) -> Self {
        f64::atan2(*self, *x)
    }
}

impl Elementary for Interval {
    fn sqrt(&self) -> Self {
        Interval::sqrt(*self)
    }

    fn exp(&self) -> Self {
        Interval::exp(*self)
    }

    fn ln(&self) -> Self {
        Interval::ln(*self)
    }

    fn sin_cos(&self) -> (Self, Self) {
        Interval::sin_cos(*self)
    }

    fn atan2(&self, x: &Self) -> Self {
        Interval::atan2(*self, *x)
    }
}
