//! Evaluation, composition, change of the expansion point, derivatives.

use std::sync::Arc;

use super::dense;
use super::monomial::exponents_only;
use super::polynomial::{Form, TaylorPolynomial};
use super::space::TaylorSpace;
use super::sparse::{self, Term};
use crate::scalar::Scalar;

impl<C: Scalar> TaylorPolynomial<C> {
    /// Evaluates the polynomial by Horner's rule at offsets `at` from the expansion point, one per
    /// variable. The offsets may be of any scalar type that coefficients convert to.
    ///
    /// With polynomials as arguments, the result is the composition, truncated in their space. It
    /// is exact to the order of that space where the arguments are.
    ///
    /// # Guarantee
    ///
    /// Over `Interval`: an outer enclosure of the range of the polynomial over the box `at`.
    ///
    /// # Panics
    ///
    /// Panics if a variable occurs for which `at` has no entry.
    pub fn evaluate<T: Scalar + From<C>>(&self, at: &[T]) -> T {
        let Some(space) = self.space() else { return T::from(self.constant_term()) };
        let mut terms = self.packed_terms();
        terms.sort_by_key(|(m, _)| exponents_only(*m));
        horner(space, &terms, space.variables(), at)
    }

    /// Returns the partial derivative in variable i. For a truncated series, it is exact to one
    /// order less.
    pub fn derivative(&self, i: usize) -> Self {
        match &self.form {
            Form::Constant(_) => Self::constant(C::zero()),
            Form::Sparse(space, terms) => {
                Self::sparse(space, sparse::derivative(space.packing, terms, i))
            }
            Form::Dense(space, coefficients) => {
                Self::dense(space, dense::derivative(space, coefficients, i))
            }
        }
    }

    /// Returns the polynomial without its terms of total degree above `order`.
    pub fn truncated(&self, order: u32) -> Self {
        let Some(space) = self.space().cloned() else { return self.clone() };
        let mut terms = self.packed_terms();
        terms.retain(|(m, _)| space.packing.degree(*m) <= order);
        Self::sparse(&space, terms)
    }

    /// Returns the Taylor shift f(x + h) as a polynomial in x: the same polynomial about another
    /// expansion point. It is exact up to rounding, because the degree does not rise.
    ///
    /// # Panics
    ///
    /// Panics if `h` does not have one entry per variable.
    pub fn shifted(&self, h: &[C]) -> Self {
        let Some(space) = self.space().cloned() else { return self.clone() };
        assert_eq!(h.len(), space.variables(), "a shift needs one offset per variable");
        let mut terms = self.packed_terms();
        for (i, h) in h.iter().enumerate().filter(|(_, h)| !h.is_zero()) {
            terms = shifted_terms(&space, &terms, i, h);
        }
        Self::sparse(&space, terms)
    }

    /// Returns the polynomial in another space, where variable i becomes variable `indices[i]`.
    /// Terms above the order of that space are dropped.
    ///
    /// # Panics
    ///
    /// Panics if `indices` names a variable that the space does not have.
    pub fn embedded(&self, space: &Arc<TaylorSpace>, indices: &[usize]) -> Self {
        let Some(own) = self.space() else { return self.clone() };
        assert!(
            indices.iter().all(|i| *i < space.variables()),
            "{indices:?} names a variable beyond the {} of the space",
            space.variables()
        );
        let mut factors = Vec::new();
        let mut terms = Vec::new();
        self.for_each_term(|m, c| {
            if own.packing.degree(m) <= space.order() {
                own.packing.factors(m, &mut factors);
                let renamed =
                    factors.iter().map(|v| space.packing.variable(indices[usize::from(*v)])).sum();
                terms.push((renamed, c.clone()));
            }
        });
        Self::sparse(space, sparse::collect_like_terms(terms))
    }
}

/// Evaluates terms in the variables below `end` by Horner's rule in the highest of them, and
/// recursively its coefficients. The terms are sorted by the exponent of the last variable first.
fn horner<C: Scalar, T: Scalar + From<C>>(
    space: &TaylorSpace,
    terms: &[Term<C>],
    end: usize,
    at: &[T],
) -> T {
    let packing = space.packing;
    let Some((highest, c)) = terms.last() else { return T::zero() };
    let Some(i) = (0..end).rev().find(|i| packing.exponent(*highest, *i) > 0) else {
        return T::from(c.clone());
    };
    let exponent = |term: &Term<C>| packing.exponent(term.0, i);
    let mut power = exponent(&terms[terms.len() - 1]);
    let (mut rest, mut value) = (terms, T::zero());
    while !rest.is_empty() {
        let here = exponent(&rest[rest.len() - 1]);
        (here..power).for_each(|_| value *= at[i].clone());
        let start = rest.partition_point(|term| exponent(term) < here);
        value += horner(space, &rest[start..], i, at);
        (rest, power) = (&rest[..start], here);
    }
    (0..power).for_each(|_| value *= at[i].clone());
    value
}

/// Replaces x_i by x_i + h in a list of terms.
fn shifted_terms<C: Scalar>(
    space: &TaylorSpace,
    terms: &[Term<C>],
    i: usize,
    h: &C,
) -> Vec<Term<C>> {
    let packing = space.packing;
    let mut all = Vec::with_capacity(2 * terms.len());
    for (m, c) in terms {
        let mut binomial = c.clone();
        let (mut monomial, mut exponent) = (*m, packing.exponent(*m, i));
        all.push((monomial, c.clone()));
        // C(e, j) h^{e-j} follows from one j to the next lower. The product comes before the
        // division, so that binomial coefficients below 2^53 stay exact.
        for step in 1..=packing.exponent(*m, i) {
            binomial =
                binomial * h.clone() * C::from(f64::from(exponent)) / C::from(f64::from(step));
            monomial -= packing.variable(i);
            exponent -= 1;
            all.push((monomial, binomial.clone()));
        }
    }
    sparse::collect_like_terms(all)
}
