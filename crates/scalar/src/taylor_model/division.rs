//! Quotients and the operator `/`.

use core::ops::{Div, DivAssign};

use super::model::TaylorModel;
use crate::interval::closed::Interval;

impl TaylorModel {
    /// Returns self / divisor with an a posteriori remainder.
    ///
    /// For any polynomial Q, self / divisor = Q + (self - divisor Q) / divisor. Q is the truncated
    /// series of the quotient of the polynomials. The defect self - divisor Q consists of the
    /// truncation error, rounding errors and both remainders.
    pub(super) fn quotient(&self, divisor: &Self) -> Self {
        match divisor.as_number() {
            Some(0.0) => return Self::entire(),
            Some(k) => return self.divided(k),
            None => {}
        }
        let range = divisor.range();
        let whole = self.range() / range;
        if whole == Interval::ENTIRE || self.as_number() == Some(0.0) {
            return Self::from(whole);
        }
        let quotient = &self.polynomial / &divisor.polynomial;
        if !quotient.is_finite() {
            return Self::from(whole);
        }
        let quotient = Self::new(quotient, Interval::ZERO);
        let defect = self - &(divisor * &quotient);
        let rest = defect.range() / range;
        quotient.widened(rest).or_enclosure(whole)
    }

    /// Returns 1 / self. The remainder is [`Interval::ENTIRE`] where the range contains zero.
    ///
    /// # Guarantee
    ///
    /// Outer.
    #[must_use]
    pub fn recip(&self) -> Self {
        Self::from(1.0).quotient(self)
    }

    /// Returns the model, or the enclosure of its range alone where the remainder is as wide.
    pub(super) fn or_enclosure(self, range: Interval) -> Self {
        if self.remainder.width() < range.width() { self } else { Self::from(range) }
    }
}

impl Div<&TaylorModel> for &TaylorModel {
    type Output = TaylorModel;
    fn div(self, rhs: &TaylorModel) -> TaylorModel {
        self.quotient(rhs)
    }
}

impl Div for TaylorModel {
    type Output = TaylorModel;
    fn div(mut self, rhs: TaylorModel) -> TaylorModel {
        self /= rhs;
        self
    }
}

impl DivAssign for TaylorModel {
    /// Divides in place. The remainder is [`Interval::ENTIRE`] where the range of the divisor
    /// contains zero.
    fn div_assign(&mut self, rhs: Self) {
        *self = self.quotient(&rhs);
    }
}
