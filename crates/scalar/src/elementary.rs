use crate::{Interval, Scalar};

/// Numbers that elementary functions are known of.
///
/// # Guarantee
///
/// Over `Interval`, and for the coefficients of polynomials over it: outer enclosures.
pub trait Elementary: Scalar {
    /// The square root.
    fn sqrt(&self) -> Self;
    /// The exponential function.
    fn exp(&self) -> Self;
    /// The natural logarithm.
    fn ln(&self) -> Self;
    /// Sine and cosine of an angle in rad.
    fn sin_cos(&self) -> (Self, Self);
    /// The angle of the point (x, self), in (-pi, pi].
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
