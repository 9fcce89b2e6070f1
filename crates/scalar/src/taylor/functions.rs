//! Elementary functions, by recurrences over the degree.

use super::dense::{DenseSeries, add_inner_products, add_scaled};
use super::division::quotient;
use super::polynomial::{Form, TaylorPolynomial};
use super::recurrence::{PartialSeries, dense_space, euler_derivative, euler_integral, zero_block};
use super::space::TaylorSpace;
use crate::elementary::Elementary;

/// Applies a function to a polynomial: `of_constant` to a constant, `of_series` to the dense series
/// of any other.
fn apply<C: Elementary>(
    a: &TaylorPolynomial<C>,
    of_constant: impl Fn(&C) -> C,
    of_series: impl Fn(&TaylorSpace, &[C]) -> Vec<C>,
) -> TaylorPolynomial<C> {
    match (&a.form, dense_space(a, a)) {
        (_, Some(space)) => {
            TaylorPolynomial::dense(&space, of_series(&space, &a.coefficients(&space)))
        }
        (Form::Constant(c), _) => TaylorPolynomial::constant(of_constant(c)),
        _ => unreachable!("only a constant has no space"),
    }
}

/// Returns e = exp a from d e_d = Σ_i i a_i e_{d-i}.
fn exponential<C: Elementary>(space: &TaylorSpace, a: &[C]) -> Vec<C> {
    let slope = euler_derivative(space, a);
    let slope = DenseSeries::new(space, &slope);
    let mut e = PartialSeries::new(space, a[0].exp());
    for d in 1..=space.order() {
        let mut block = zero_block(space, d);
        e.convolve(space, d, &slope, &mut block);
        e.set(space, d, &block, |c| c.clone() / C::from(f64::from(d)));
    }
    e.coefficients
}

/// Returns s = √a from a_d - Σ_i s_i s_{d-i} = 2 s_0 s_d, where 0 < i < d.
fn square_root<C: Elementary>(space: &TaylorSpace, a: &[C]) -> Vec<C> {
    let mut s = PartialSeries::new(space, a[0].sqrt());
    let twice = s.constant().clone() + s.constant().clone();
    let a = DenseSeries::full(space, a);
    for d in 1..=space.order() {
        let mut block = zero_block(space, d);
        let known = DenseSeries::full(space, &s.coefficients[..space.block(d).start]);
        add_inner_products(space, d, &known, &known, &mut block);
        block.iter_mut().for_each(|c| *c = -c.clone());
        add_scaled(&mut block, &C::one(), a.block(d));
        s.set(space, d, &block, |c| c.clone() / twice.clone());
    }
    s.coefficients
}

/// Returns s = sin a and c = cos a from D s = c D a and D c = -s D a.
fn sine_cosine<C: Elementary>(space: &TaylorSpace, a: &[C]) -> (Vec<C>, Vec<C>) {
    let slope = euler_derivative(space, a);
    let slope = DenseSeries::new(space, &slope);
    let (sin, cos) = a[0].sin_cos();
    let (mut s, mut c) = (PartialSeries::new(space, sin), PartialSeries::new(space, cos));
    for d in 1..=space.order() {
        let k = C::from(f64::from(d));
        let (mut sin_block, mut cos_block) = (zero_block(space, d), zero_block(space, d));
        c.convolve(space, d, &slope, &mut sin_block);
        s.convolve(space, d, &slope, &mut cos_block);
        s.set(space, d, &sin_block, |x| x.clone() / k.clone());
        c.set(space, d, &cos_block, |x| -x.clone() / k.clone());
    }
    (s.coefficients, c.coefficients)
}

impl<C: Elementary> Elementary for TaylorPolynomial<C> {
    fn sqrt(&self) -> Self {
        apply(self, C::sqrt, square_root)
    }

    fn exp(&self) -> Self {
        apply(self, C::exp, exponential)
    }

    /// Returns the truncated series of ln a from D ln a = D a / a.
    fn ln(&self) -> Self {
        let series = |space: &TaylorSpace, a: &[C]| {
            let slope = quotient(space, &euler_derivative(space, a), a);
            euler_integral(space, slope, a[0].ln())
        };
        apply(self, C::ln, series)
    }

    fn sin_cos(&self) -> (Self, Self) {
        match (&self.form, dense_space(self, self)) {
            (_, Some(space)) => {
                let (s, c) = sine_cosine(&space, &self.coefficients(&space));
                (Self::dense(&space, s), Self::dense(&space, c))
            }
            (Form::Constant(c), _) => {
                let (s, c) = c.sin_cos();
                (Self::constant(s), Self::constant(c))
            }
            _ => unreachable!("only a constant has no space"),
        }
    }

    /// Returns the truncated series of the angle θ from D θ = (x D y - y D x) / (x² + y²).
    fn atan2(&self, x: &Self) -> Self {
        let constant = self.constant_term().atan2(&x.constant_term());
        let Some(space) = dense_space(self, x) else { return Self::constant(constant) };
        let slope =
            |p: &Self| Self::dense(&space, euler_derivative(&space, &p.coefficients(&space)));
        let numerator = &(x * &slope(self)) - &(self * &slope(x));
        let squared_radius = &(x * x) + &(self * self);
        let slope =
            quotient(&space, &numerator.coefficients(&space), &squared_radius.coefficients(&space));
        Self::dense(&space, euler_integral(&space, slope, constant))
    }
}
