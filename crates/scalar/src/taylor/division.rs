//! Quotients, and their operators.

use core::ops::{Div, DivAssign};

use super::dense::DenseSeries;
use super::polynomial::{Form, TaylorPolynomial};
use super::recurrence::{PartialSeries, dense_space, zero_block};
use super::space::TaylorSpace;
use crate::scalar::Scalar;

/// Returns q = b / a from b_d - Σ_i a_i q_{d-i} = a_0 q_d, where 0 < i ≤ d.
fn quotient<C: Scalar>(space: &TaylorSpace, b: &[C], a: &[C]) -> Vec<C> {
    let (b, series) = (DenseSeries::full(space, b), DenseSeries::new(space, a));
    let inverse = C::one() / a[0].clone();
    let constant = |c: &C| c.clone() / a[0].clone();
    let mut q = PartialSeries::new(space, constant(&b.block(0)[0]));
    for d in 1..=space.order() {
        let mut block = zero_block(space, d);
        q.convolve(space, d, &series, &mut block);
        let numerator = b.block(d);
        if numerator.is_empty() {
            q.set(space, d, &block, |c| -c.clone() * inverse.clone());
        } else {
            block.iter_mut().zip(numerator).for_each(|(c, b)| *c = b.clone() - c.clone());
            q.set(space, d, &block, |c| c.clone() * inverse.clone());
        }
    }
    q.coefficients
}

impl<C: Scalar> TaylorPolynomial<C> {
    fn quotient(&self, divisor: &Self) -> Self {
        if let Form::Constant(k) = &divisor.form {
            return self.map_coefficients(|c| c.clone() / k.clone());
        }
        let space = dense_space(self, divisor).expect("a divisor that is no constant has a space");
        let quotient = quotient(&space, &self.coefficients(&space), &divisor.coefficients(&space));
        Self::dense(&space, quotient)
    }

    /// Returns the truncated series of 1 / self. Coefficients are infinite or NaN if self is zero
    /// at the expansion point.
    pub fn recip(&self) -> Self {
        Self::from(1.0).quotient(self)
    }
}

impl<C: Scalar> Div<&TaylorPolynomial<C>> for &TaylorPolynomial<C> {
    type Output = TaylorPolynomial<C>;
    fn div(self, rhs: &TaylorPolynomial<C>) -> TaylorPolynomial<C> {
        self.quotient(rhs)
    }
}

impl<C: Scalar> Div for TaylorPolynomial<C> {
    type Output = TaylorPolynomial<C>;
    fn div(mut self, rhs: TaylorPolynomial<C>) -> TaylorPolynomial<C> {
        self /= rhs;
        self
    }
}

impl<C: Scalar> DivAssign for TaylorPolynomial<C> {
    /// Divides as a truncated series. Coefficients are infinite or NaN if the divisor is zero at
    /// the expansion point.
    fn div_assign(&mut self, rhs: Self) {
        *self = self.quotient(&rhs);
    }
}
