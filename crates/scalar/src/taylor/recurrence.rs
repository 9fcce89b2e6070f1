//! Series whose coefficients follow degree by degree from a recurrence.
//!
//! Euler's operator D = Σ x_i ∂/∂x_i is a derivation and multiplies the terms of degree d by d. It
//! turns the differential equation of a function into a recurrence over the homogeneous parts of
//! its series. For e = exp a, D e = e D a gives d e_d = Σ_i i a_i e_{d-i}. Each function costs
//! about one product.

use std::sync::Arc;

use super::dense::{DenseSeries, add_inner_products, add_scaled, degree};
use super::polynomial::TaylorPolynomial;
use super::space::TaylorSpace;
use crate::scalar::Scalar;

/// A dense series whose coefficients are known up to some degree.
pub(super) struct PartialSeries<C> {
    pub coefficients: Vec<C>,
}

impl<C: Scalar> PartialSeries<C> {
    /// Returns a series of which only the constant is known.
    pub(super) fn new(space: &TaylorSpace, constant: C) -> Self {
        let mut coefficients = vec![C::zero(); space.dense_len(space.order())];
        coefficients[0] = constant;
        Self { coefficients }
    }

    pub(super) fn constant(&self) -> &C {
        &self.coefficients[0]
    }

    /// Adds Σ a_i x_{d-i} over 0 < i ≤ d to `out` for this series x and a known a.
    ///
    /// The part of degree d of the product a x lacks only a_0 x_d then.
    pub(super) fn convolve(&self, space: &TaylorSpace, d: u32, a: &DenseSeries<C>, out: &mut [C]) {
        let known = DenseSeries::full(space, &self.coefficients[..space.block(d).start]);
        add_inner_products(space, d, a, &known, out);
        add_scaled(out, self.constant(), a.block(d));
    }

    /// Sets the coefficients of degree d to `finish` of each entry of `block`.
    pub(super) fn set(
        &mut self,
        space: &TaylorSpace,
        d: u32,
        block: &[C],
        finish: impl Fn(&C) -> C,
    ) {
        let target = &mut self.coefficients[space.block(d)];
        target.iter_mut().zip(block).for_each(|(x, b)| *x = finish(b));
    }
}

/// Returns the space of two operands; `None` if both are constants.
///
/// # Panics
///
/// Panics if a dense series of the space does not fit.
pub(super) fn dense_space<C: Scalar>(
    x: &TaylorPolynomial<C>,
    y: &TaylorPolynomial<C>,
) -> Option<Arc<TaylorSpace>> {
    let space = x.space().or(y.space())?;
    if let Err(error) = space.check_dense() {
        panic!("{error}");
    }
    Some(Arc::clone(space))
}

pub(super) fn zero_block<C: Scalar>(space: &TaylorSpace, d: u32) -> Vec<C> {
    vec![C::zero(); space.block(d).len()]
}

/// Returns D a: the terms of degree d times d.
pub(super) fn euler_derivative<C: Scalar>(space: &TaylorSpace, a: &[C]) -> Vec<C> {
    let mut out = a.to_vec();
    for d in 0..=degree(space, a.len()) {
        let k = C::from(f64::from(d));
        out[space.block(d)].iter_mut().for_each(|c| *c *= k.clone());
    }
    out
}
