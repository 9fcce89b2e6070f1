use crate::interval::closed::Interval;
use crate::scalar::Scalar;

/// A scalar with sine and cosine.
///
/// # Guarantee
///
/// Over `Interval`, and for coefficients of type `Interval`: outer enclosures.
pub trait SineCosine: Scalar {
    /// Returns sine and cosine of an angle in rad.
    fn sin_cos(&self) -> (Self, Self);
}

impl SineCosine for f64 {
    fn sin_cos(&self) -> (Self, Self) {
        f64::sin_cos(*self)
    }
}

impl SineCosine for Interval {
    fn sin_cos(&self) -> (Self, Self) {
        Interval::sin_cos(*self)
    }
}
