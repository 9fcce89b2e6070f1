//! Quotients.

use super::TaylorModel;
use crate::Interval;

impl TaylorModel {
    /// self / divisor, a posteriori: for any polynomial Q, self / divisor = Q + (self - divisor Q)
    /// / divisor.
    ///
    /// Q is the series of the quotient of the polynomials; the defect is what it was cut off by,
    /// rounding and both remainders.
    pub(super) fn quotient(&self, divisor: &Self) -> Self {
        match divisor.as_number() {
            Some(0.0) => return Self::unknown(),
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
        quotient.widened(rest).or_values(whole)
    }

    /// 1 / self; the remainder is [`Interval::ENTIRE`] where the range holds zero.
    ///
    /// # Guarantee
    ///
    /// Outer, as every operation.
    #[must_use]
    pub fn recip(&self) -> Self {
        Self::from(1.0).quotient(self)
    }

    /// The model, or its values alone where those say more than its remainder.
    pub(super) fn or_values(self, values: Interval) -> Self {
        if self.remainder.width() < values.width() { self } else { Self::from(values) }
    }
}
