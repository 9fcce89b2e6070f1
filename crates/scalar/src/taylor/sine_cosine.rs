//! Sine and cosine, by a recurrence over the degree.

use super::dense::DenseSeries;
use super::polynomial::{Form, TaylorPolynomial};
use super::recurrence::{PartialSeries, dense_space, euler_derivative, zero_block};
use super::space::TaylorSpace;
use crate::sine_cosine::SineCosine;

/// Returns s = sin a and c = cos a from D s = c D a and D c = -s D a.
fn sine_cosine<C: SineCosine>(space: &TaylorSpace, a: &[C]) -> (Vec<C>, Vec<C>) {
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

impl<C: SineCosine> SineCosine for TaylorPolynomial<C> {
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
}
