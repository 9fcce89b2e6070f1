//! Division and elementary functions, degree by degree.
//!
//! Euler's operator D = Σ x_i ∂/∂x_i is a derivation and multiplies the terms of degree d by d. A
//! function's differential equation so becomes a recurrence over the homogeneous parts of its
//! series, e.g. e = exp a: D e = e D a gives d e_d = Σ_i i a_i e_{d-i}; each function costs about
//! one product.

use std::sync::Arc;

use super::dense::{Series, add_inner, add_scaled};
use super::polynomial::{Form, TaylorPolynomial};
use super::space::TaylorSpace;
use crate::{Elementary, Scalar};

/// A series that becomes known degree by degree.
struct Growing<C> {
    coefficients: Vec<C>,
}

impl<C: Scalar> Growing<C> {
    fn new(space: &TaylorSpace, constant: C) -> Self {
        let mut coefficients = vec![C::zero(); space.dense_len(space.order())];
        coefficients[0] = constant;
        Self { coefficients }
    }

    fn constant(&self) -> &C {
        &self.coefficients[0]
    }

    /// Σ a_i x_{d-i} over 0 < i ≤ d for a known a: all that the next degree of a product needs but
    /// a_0 x_d.
    fn convolve(&self, space: &TaylorSpace, d: u32, a: &Series<C>, out: &mut [C]) {
        let known = Series::full(space, &self.coefficients[..space.block(d).start]);
        add_inner(space, d, a, &known, out);
        add_scaled(out, self.constant(), a.block(d));
    }

    fn set(&mut self, space: &TaylorSpace, d: u32, block: &[C], finish: impl Fn(&C) -> C) {
        let target = &mut self.coefficients[space.block(d)];
        target.iter_mut().zip(block).for_each(|(x, b)| *x = finish(b));
    }
}

/// Whether a series can be made, and in which space.
fn dense_space<C: Scalar>(
    x: &TaylorPolynomial<C>,
    y: &TaylorPolynomial<C>,
) -> Option<Arc<TaylorSpace>> {
    let space = x.space().or(y.space())?;
    if let Err(error) = space.check_dense() {
        panic!("{error}");
    }
    Some(Arc::clone(space))
}

/// D a: the terms of degree d times d.
fn euler<C: Scalar>(space: &TaylorSpace, a: &[C]) -> Vec<C> {
    let mut out = a.to_vec();
    for d in 0..=super::dense::degree(space, a.len()) {
        let k = C::from(f64::from(d));
        out[space.block(d)].iter_mut().for_each(|c| *c *= k.clone());
    }
    out
}

/// A block of zeros for degree d.
fn blank<C: Scalar>(space: &TaylorSpace, d: u32) -> Vec<C> {
    vec![C::zero(); space.block(d).len()]
}

/// b / a.
fn quotient<C: Scalar>(space: &TaylorSpace, b: &[C], a: &[C]) -> Vec<C> {
    let (b, series) = (Series::full(space, b), Series::new(space, a));
    let inverse = C::one() / a[0].clone();
    let constant = |c: &C| c.clone() / a[0].clone();
    let mut q = Growing::new(space, constant(&b.block(0)[0]));
    for d in 1..=space.order() {
        let mut block = blank(space, d);
        q.convolve(space, d, &series, &mut block);
        let own = b.block(d);
        if own.is_empty() {
            q.set(space, d, &block, |c| -c.clone() * inverse.clone());
        } else {
            block.iter_mut().zip(own).for_each(|(c, b)| *c = b.clone() - c.clone());
            q.set(space, d, &block, |c| c.clone() * inverse.clone());
        }
    }
    q.coefficients
}

impl<C: Scalar> TaylorPolynomial<C> {
    pub(super) fn quotient(&self, divisor: &Self) -> Self {
        if let Form::Constant(k) = &divisor.form {
            return self.map_coefficients(|c| c.clone() / k.clone());
        }
        let space = dense_space(self, divisor).expect("a divisor that is no constant has a space");
        let quotient = quotient(&space, &self.coefficients(&space), &divisor.coefficients(&space));
        Self::dense(&space, quotient)
    }

    /// The truncated series of 1 / self; infinite or NaN coefficients where self is zero at the
    /// expansion point.
    pub fn recip(&self) -> Self {
        Self::from(1.0).quotient(self)
    }

    /// self^n by repeated multiplication.
    pub fn powi(&self, n: u32) -> Self {
        match n {
            0 => Self::from(1.0),
            1 => self.clone(),
            _ => {
                let half = self.powi(n / 2);
                let square = &half * &half;
                if n.is_multiple_of(2) { square } else { &square * self }
            }
        }
    }
}

/// A function of one series: by its value at the constant, and by what a dense series needs.
fn lift<C: Elementary>(
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

/// Solves d e_d = Σ i a_i e_{d-i}.
fn exponential<C: Elementary>(space: &TaylorSpace, a: &[C]) -> Vec<C> {
    let slope = euler(space, a);
    let slope = Series::new(space, &slope);
    let mut e = Growing::new(space, a[0].exp());
    for d in 1..=space.order() {
        let mut block = blank(space, d);
        e.convolve(space, d, &slope, &mut block);
        e.set(space, d, &block, |c| c.clone() / C::from(f64::from(d)));
    }
    e.coefficients
}

/// a_d - Σ s_i s_{d-i} = 2 s_0 s_d.
fn square_root<C: Elementary>(space: &TaylorSpace, a: &[C]) -> Vec<C> {
    let mut s = Growing::new(space, a[0].sqrt());
    let twice = s.constant().clone() + s.constant().clone();
    let a = Series::full(space, a);
    for d in 1..=space.order() {
        let mut block = blank(space, d);
        let known = Series::full(space, &s.coefficients[..space.block(d).start]);
        add_inner(space, d, &known, &known, &mut block);
        block.iter_mut().for_each(|c| *c = -c.clone());
        add_scaled(&mut block, &C::one(), a.block(d));
        s.set(space, d, &block, |c| c.clone() / twice.clone());
    }
    s.coefficients
}

/// D s = c D a and D c = -s D a.
fn sine_cosine<C: Elementary>(space: &TaylorSpace, a: &[C]) -> (Vec<C>, Vec<C>) {
    let slope = euler(space, a);
    let slope = Series::new(space, &slope);
    let (sin, cos) = a[0].sin_cos();
    let (mut s, mut c) = (Growing::new(space, sin), Growing::new(space, cos));
    for d in 1..=space.order() {
        let k = C::from(f64::from(d));
        let (mut of_sin, mut of_cos) = (blank(space, d), blank(space, d));
        c.convolve(space, d, &slope, &mut of_sin);
        s.convolve(space, d, &slope, &mut of_cos);
        s.set(space, d, &of_sin, |x| x.clone() / k.clone());
        c.set(space, d, &of_cos, |x| -x.clone() / k.clone());
    }
    (s.coefficients, c.coefficients)
}

/// From D y = r: divides the terms of degree d by d; the constant is given.
fn integrated<C: Elementary>(space: &TaylorSpace, mut r: Vec<C>, constant: C) -> Vec<C> {
    for d in 1..=super::dense::degree(space, r.len()) {
        let k = C::from(f64::from(d));
        r[space.block(d)].iter_mut().for_each(|c| *c /= k.clone());
    }
    r[0] = constant;
    r
}

impl<C: Elementary> Elementary for TaylorPolynomial<C> {
    fn sqrt(&self) -> Self {
        lift(self, C::sqrt, square_root)
    }

    fn exp(&self) -> Self {
        lift(self, C::exp, exponential)
    }

    /// D ln a = D a / a.
    fn ln(&self) -> Self {
        let series = |space: &TaylorSpace, a: &[C]| {
            integrated(space, quotient(space, &euler(space, a), a), a[0].ln())
        };
        lift(self, C::ln, series)
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

    /// D θ = (x D y - y D x) / (x² + y²).
    fn atan2(&self, x: &Self) -> Self {
        let constant = self.constant_term().atan2(&x.constant_term());
        let Some(space) = dense_space(self, x) else { return Self::constant(constant) };
        let slope = |p: &Self| Self::dense(&space, euler(&space, &p.coefficients(&space)));
        let numerator = &(x * &slope(self)) - &(self * &slope(x));
        let radius = &(x * x) + &(self * self);
        let slope = quotient(&space, &numerator.coefficients(&space), &radius.coefficients(&space));
        Self::dense(&space, integrated(&space, slope, constant))
    }
}
