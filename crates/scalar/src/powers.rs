use crate::interval::closed::Interval;
use crate::scalar::Scalar;

/// A number whose powers are computed one after the other.
pub trait Powers: Scalar {
    /// Returns self^e for e ≥ 1; `previous` is self^(e-1) where e > 1.
    #[inline(always)]
    fn power(&self, e: u32, previous: Option<&Self>) -> Self {
        match previous {
            Some(previous) if e > 1 => previous.clone() * self.clone(),
            _ => self.clone(),
        }
    }
}

impl Powers for f64 {}

impl Powers for Interval {
    /// Encloses self^e by [`Interval::powi`]: even powers are not negative, which a product of
    /// intervals would not use.
    fn power(&self, e: u32, _: Option<&Self>) -> Self {
        self.powi(e as i32)
    }
}
