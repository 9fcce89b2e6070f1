//! The four operations.

use core::ops::{Add, AddAssign, Div, DivAssign, Mul, MulAssign, Neg, Sub, SubAssign};
use std::sync::Arc;

use num_traits::{One, Zero};

use super::dense;
use super::polynomial::{Form, TaylorPolynomial};
use super::space::TaylorSpace;
use super::sparse;
use crate::Scalar;

/// The space of two operands.
fn common<'a>(a: &'a Arc<TaylorSpace>, b: &Arc<TaylorSpace>) -> &'a Arc<TaylorSpace> {
    assert!(
        Arc::ptr_eq(a, b) || a.variables() == b.variables() && a.order() == b.order(),
        "polynomials of {} variables to order {} and of {} to {} do not mix",
        a.variables(),
        a.order(),
        b.variables(),
        b.order()
    );
    a
}

/// How coefficients are added.
pub(crate) trait Addition<C: Scalar> {
    /// a + b.
    fn sum(&mut self, a: &C, b: C) -> C;

    /// a_i ± b_i in the place of each a_i.
    fn accumulate(&mut self, a: &mut [C], b: &[C], minus: bool) {
        for (a, b) in a.iter_mut().zip(b) {
            *a = self.sum(a, signed(b, minus));
        }
    }
}

/// The addition of the scalar.
pub(super) struct Plain;

impl<C: Scalar> Addition<C> for Plain {
    fn sum(&mut self, a: &C, b: C) -> C {
        a.clone() + b
    }
}

impl<C: Scalar> TaylorPolynomial<C> {
    /// self ± other.
    fn sum(&self, other: &Self, minus: bool) -> Self {
        self.sum_by(other, minus, &mut Plain)
    }

    /// self ± other, by the given addition of coefficients.
    fn sum_by(&self, other: &Self, minus: bool, add: &mut impl Addition<C>) -> Self {
        use Form::{Constant, Dense, Sparse};
        let mut merged = |a: &[_], b: &[_]| sparse::sum_by(a, b, minus, add);
        match (&self.form, &other.form) {
            (Constant(a), Constant(b)) => Self::constant(add.sum(a, signed(b, minus))),
            (_, Constant(b)) if b.is_zero() => self.clone(),
            (Constant(a), _) if a.is_zero() && !minus => other.clone(),
            (Sparse(space, a), Constant(b)) => Self::sparse(space, merged(a, &constant_terms(b))),
            (Constant(a), Sparse(space, b)) => Self::sparse(space, merged(&constant_terms(a), b)),
            (Sparse(s, a), Sparse(t, b)) => Self::sparse(common(s, t), merged(a, b)).densified(),
            (Dense(..), _) => {
                let mut sum = self.clone();
                sum.accumulate_by(other, minus, add);
                sum
            }
            (_, Dense(..)) if minus => -other.sum_by(self, true, add),
            (_, Dense(..)) => other.sum_by(self, false, add),
        }
    }

    /// self ± other in place.
    fn accumulate(&mut self, other: &Self, minus: bool) {
        self.accumulate_by(other, minus, &mut Plain);
    }

    /// self ± other in place, by the given addition of coefficients; a dense self that nobody
    /// shares is not copied.
    pub(crate) fn accumulate_by(&mut self, other: &Self, minus: bool, add: &mut impl Addition<C>) {
        let Form::Dense(space, coefficients) = &mut self.form else {
            *self = self.sum_by(other, minus, add);
            return;
        };
        let coefficients = Arc::make_mut(coefficients);
        match &other.form {
            Form::Constant(c) => coefficients[0] = add.sum(&coefficients[0], signed(c, minus)),
            Form::Sparse(t, terms) => {
                common(space, t);
                let degree = terms.last().map_or(0, |(m, _)| space.packing.degree(*m));
                grow(coefficients, space.dense_len(degree));
                dense::add_terms(space, coefficients, terms, minus, add);
            }
            Form::Dense(t, others) => {
                common(space, t);
                grow(coefficients, others.len());
                add.accumulate(coefficients, others, minus);
            }
        }
    }

    fn product(&self, other: &Self) -> Self {
        use Form::{Constant, Dense, Sparse};
        match (&self.form, &other.form) {
            (Constant(k), _) => other.scaled(k),
            (_, Constant(k)) => self.scaled(k),
            (Sparse(s, a), Sparse(t, b)) => {
                let space = common(s, t);
                if is_better_dense(space, sparse::pairs(space, a, b)) {
                    let (few, many) = if a.len() <= b.len() { (a, other) } else { (b, self) };
                    let product = dense::product_with_terms(space, few, &many.coefficients(space));
                    return Self::dense(space, product);
                }
                Self::sparse(space, sparse::product(space, a, b))
            }
            (Sparse(s, a), Dense(t, b)) | (Dense(t, b), Sparse(s, a)) => {
                let space = common(t, s);
                Self::dense(space, dense::product_with_terms(space, a, b))
            }
            (Dense(s, a), Dense(t, b)) => {
                let space = common(s, t);
                Self::dense(space, dense::product(space, a, b))
            }
        }
    }

    /// k self; zero where k is zero.
    pub fn scaled(&self, k: &C) -> Self {
        if k.is_zero() {
            return Self::zero();
        }
        if k.is_one() {
            return self.clone();
        }
        match &self.form {
            Form::Constant(c) => Self::constant(c.clone() * k.clone()),
            Form::Sparse(space, terms) => Self::sparse(space, sparse::scaled(terms, k)),
            Form::Dense(space, c) => {
                Self::dense(space, c.iter().map(|c| c.clone() * k.clone()).collect())
            }
        }
    }

    /// The dense coefficients of a polynomial that belongs to `space`.
    pub(super) fn coefficients(&self, space: &TaylorSpace) -> Vec<C> {
        let mut out = vec![C::zero(); space.dense_len(0)];
        match &self.form {
            Form::Dense(_, coefficients) => return coefficients.to_vec(),
            Form::Constant(c) => out[0] = c.clone(),
            Form::Sparse(_, terms) => {
                let degree = terms.last().map_or(0, |(m, _)| space.packing.degree(*m));
                grow(&mut out, space.dense_len(degree));
                dense::add_terms(space, &mut out, terms, false, &mut Plain);
            }
        }
        out
    }

    /// A list of terms that fills much of its space as a dense series.
    fn densified(self) -> Self {
        match &self.form {
            Form::Sparse(space, terms) if is_better_dense(space, 2 * terms.len()) => {
                Self::dense(space, self.coefficients(space))
            }
            _ => self,
        }
    }
}

/// Whether so many terms are better kept in a dense series.
fn is_better_dense(space: &TaylorSpace, terms: usize) -> bool {
    space.fits_dense() && terms > space.dense_len(space.order())
}

fn grow<C: Scalar>(coefficients: &mut Vec<C>, len: usize) {
    if coefficients.len() < len {
        coefficients.resize(len, C::zero());
    }
}

fn constant_terms<C: Scalar>(c: &C) -> Vec<sparse::Term<C>> {
    if c.is_zero() { Vec::new() } else { vec![(0, c.clone())] }
}

pub(super) fn signed<C: Scalar>(c: &C, minus: bool) -> C {
    if minus { -c.clone() } else { c.clone() }
}

impl<C: Scalar> Neg for TaylorPolynomial<C> {
    type Output = Self;
    fn neg(self) -> Self {
        self.map_coefficients(|c| -c.clone())
    }
}

macro_rules! operations {
    ($($Op:ident $op:ident $OpAssign:ident $op_assign:ident |$a:ident, $b:ident| $value:expr;)*) => {$(
        impl<C: Scalar> $Op<&TaylorPolynomial<C>> for &TaylorPolynomial<C> {
            type Output = TaylorPolynomial<C>;
            fn $op(self, rhs: &TaylorPolynomial<C>) -> TaylorPolynomial<C> {
                let ($a, $b) = (self, rhs);
                $value
            }
        }
        impl<C: Scalar> $Op for TaylorPolynomial<C> {
            type Output = TaylorPolynomial<C>;
            fn $op(mut self, rhs: TaylorPolynomial<C>) -> TaylorPolynomial<C> {
                self.$op_assign(rhs);
                self
            }
        }
    )*};
}
operations! {
    Add add AddAssign add_assign |a, b| a.sum(b, false);
    Sub sub SubAssign sub_assign |a, b| a.sum(b, true);
    Mul mul MulAssign mul_assign |a, b| a.product(b);
    Div div DivAssign div_assign |a, b| a.quotient(b);
}

impl<C: Scalar> AddAssign for TaylorPolynomial<C> {
    fn add_assign(&mut self, rhs: Self) {
        self.accumulate(&rhs, false);
    }
}

impl<C: Scalar> SubAssign for TaylorPolynomial<C> {
    fn sub_assign(&mut self, rhs: Self) {
        self.accumulate(&rhs, true);
    }
}

impl<C: Scalar> MulAssign for TaylorPolynomial<C> {
    fn mul_assign(&mut self, rhs: Self) {
        *self = self.product(&rhs);
    }
}

impl<C: Scalar> DivAssign for TaylorPolynomial<C> {
    /// The truncated series of the quotient; infinite or NaN coefficients where the divisor is zero
    /// at the expansion point.
    fn div_assign(&mut self, rhs: Self) {
        *self = self.quotient(&rhs);
    }
}

impl<C: Scalar> From<f64> for TaylorPolynomial<C> {
    fn from(x: f64) -> Self {
        Self::constant(C::from(x))
    }
}

impl<C: Scalar> Zero for TaylorPolynomial<C> {
    fn zero() -> Self {
        Self::constant(C::zero())
    }

    fn is_zero(&self) -> bool {
        match &self.form {
            Form::Constant(c) => c.is_zero(),
            Form::Sparse(_, terms) => terms.is_empty(),
            Form::Dense(_, coefficients) => coefficients.iter().all(C::is_zero),
        }
    }
}

impl<C: Scalar> One for TaylorPolynomial<C> {
    fn one() -> Self {
        Self::constant(C::one())
    }
}
