//! Sums and products, and their operators.

use core::ops::{Add, AddAssign, Mul, MulAssign, Neg, Sub, SubAssign};
use std::sync::Arc;

use num_traits::{One, Zero};

use super::addition::{Addition, PlainAddition, negated_if};
use super::dense::{self, pad_with_zeros};
use super::polynomial::{Form, TaylorPolynomial};
use super::space::TaylorSpace;
use super::sparse;
use crate::scalar::Scalar;

/// Returns the common space of two operands.
fn common_space<'a>(a: &'a Arc<TaylorSpace>, b: &Arc<TaylorSpace>) -> &'a Arc<TaylorSpace> {
    assert!(
        Arc::ptr_eq(a, b) || a.variables() == b.variables() && a.order() == b.order(),
        "polynomials of {} variables to order {} and of {} variables to order {} do not mix",
        a.variables(),
        a.order(),
        b.variables(),
        b.order()
    );
    a
}

impl<C: Scalar> TaylorPolynomial<C> {
    /// Returns self + other, or self - other where `minus`.
    fn sum(&self, other: &Self, minus: bool) -> Self {
        self.sum_with(other, minus, &mut PlainAddition)
    }

    /// Returns self + other, or self - other where `minus`, by the given addition of coefficients.
    fn sum_with(&self, other: &Self, minus: bool, addition: &mut impl Addition<C>) -> Self {
        use Form::{Constant, Dense, Sparse};
        let mut merged = |a: &[_], b: &[_]| sparse::sum_with(a, b, minus, addition);
        match (&self.form, &other.form) {
            (Constant(a), Constant(b)) => Self::constant(addition.sum(a, negated_if(minus, b))),
            (_, Constant(b)) if b.is_zero() => self.clone(),
            (Constant(a), _) if a.is_zero() && !minus => other.clone(),
            (Sparse(space, a), Constant(b)) => Self::sparse(space, merged(a, &sparse::constant(b))),
            (Constant(a), Sparse(space, b)) => Self::sparse(space, merged(&sparse::constant(a), b)),
            (Sparse(s, a), Sparse(t, b)) => {
                Self::sparse(common_space(s, t), merged(a, b)).densified()
            }
            (Dense(..), _) => {
                let mut sum = self.clone();
                sum.accumulate_with(other, minus, addition);
                sum
            }
            (_, Dense(..)) if minus => -other.sum_with(self, true, addition),
            (_, Dense(..)) => other.sum_with(self, false, addition),
        }
    }

    /// Adds `other` in place, or subtracts it where `minus`.
    fn accumulate(&mut self, other: &Self, minus: bool) {
        self.accumulate_with(other, minus, &mut PlainAddition);
    }

    /// Adds `other` in place, or subtracts it where `minus`, by the given addition of coefficients.
    /// A dense series whose memory is not shared is not copied.
    pub(crate) fn accumulate_with(
        &mut self,
        other: &Self,
        minus: bool,
        addition: &mut impl Addition<C>,
    ) {
        let Form::Dense(space, coefficients) = &mut self.form else {
            *self = self.sum_with(other, minus, addition);
            return;
        };
        let coefficients = Arc::make_mut(coefficients);
        match &other.form {
            Form::Constant(c) => {
                coefficients[0] = addition.sum(&coefficients[0], negated_if(minus, c));
            }
            Form::Sparse(t, terms) => {
                common_space(space, t);
                let degree = terms.last().map_or(0, |(m, _)| space.packing.degree(*m));
                pad_with_zeros(coefficients, space.dense_len(degree));
                dense::add_terms(space, coefficients, terms, minus, addition);
            }
            Form::Dense(t, others) => {
                common_space(space, t);
                pad_with_zeros(coefficients, others.len());
                addition.accumulate(coefficients, others, minus);
            }
        }
    }

    /// Returns self · other, truncated at the order.
    pub(super) fn product(&self, other: &Self) -> Self {
        use Form::{Constant, Dense, Sparse};
        match (&self.form, &other.form) {
            (Constant(k), _) => other.scaled(k),
            (_, Constant(k)) => self.scaled(k),
            (Sparse(s, a), Sparse(t, b)) => {
                let space = common_space(s, t);
                if is_better_dense(space, sparse::count_kept_products(space, a, b)) {
                    let (short, long) = if a.len() <= b.len() { (a, other) } else { (b, self) };
                    let product =
                        dense::product_with_terms(space, short, &long.coefficients(space));
                    return Self::dense(space, product);
                }
                Self::sparse(space, sparse::product(space, a, b))
            }
            (Sparse(s, a), Dense(t, b)) | (Dense(t, b), Sparse(s, a)) => {
                let space = common_space(t, s);
                Self::dense(space, dense::product_with_terms(space, a, b))
            }
            (Dense(s, a), Dense(t, b)) => {
                let space = common_space(s, t);
                Self::dense(space, dense::product(space, a, b))
            }
        }
    }

    /// Returns k · self; zero where k is zero.
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

    /// Returns self^n by repeated multiplication.
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

    /// Converts a list of terms to a dense series where it fills much of its space.
    fn densified(self) -> Self {
        match &self.form {
            Form::Sparse(space, terms) if is_better_dense(space, 2 * terms.len()) => {
                Self::dense(space, self.coefficients(space))
            }
            _ => self,
        }
    }
}

/// Returns whether `terms` terms are better stored as a dense series.
fn is_better_dense(space: &TaylorSpace, terms: usize) -> bool {
    space.fits_dense() && terms > space.dense_len(space.order())
}

impl<C: Scalar> Neg for TaylorPolynomial<C> {
    type Output = Self;
    fn neg(self) -> Self {
        self.map_coefficients(|c| -c.clone())
    }
}

macro_rules! operations {
    ($(
        $Op:ident $op:ident $OpAssign:ident $op_assign:ident |$a:ident, $b:ident| $value:expr;
    )*) => {$(
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
