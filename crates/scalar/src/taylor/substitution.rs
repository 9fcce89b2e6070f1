//! Evaluation, composition, change of expansion point, derivatives.

use std::sync::Arc;

use super::dense;
use super::monomial::exponents_only;
use super::polynomial::{Form, TaylorPolynomial};
use super::space::TaylorSpace;
use super::sparse::{self, Term};
use crate::Scalar;

impl<C: Scalar> TaylorPolynomial<C> {
    /// The value at offsets `at` from the expansion point, one a variable, by Horner's rule; over
    /// any scalar that coefficients turn into.
    ///
    /// With polynomials as arguments this is composition, truncated in their space: exact to its
    /// order where they are.
    ///
    /// # Guarantee
    ///
    /// Over `Interval`: an outer enclosure of the polynomial's range over the box.
    ///
    /// # Panics
    ///
    /// Where fewer arguments are given than variables occur.
    pub fn evaluate<T: Scalar + From<C>>(&self, at: &[T]) -> T {
        let Some(space) = self.space() else { return T::from(self.constant_term()) };
        let mut terms = self.packed_terms();
        terms.sort_by_key(|(m, _)| exponents_only(*m));
        horner(space, &terms, space.variables(), at)
    }

    /// The partial derivative in variable i. Of a truncated series, it is exact to one order less.
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

    /// Terms of total degree above `order` cut off.
    pub fn truncated(&self, order: u32) -> Self {
        let Some(space) = self.space().cloned() else { return self.clone() };
        let mut terms = self.packed_terms();
        terms.retain(|(m, _)| space.packing.degree(*m) <= order);
        Self::sparse(&space, terms)
    }

    /// The same polynomial about another point: f(x + h) as a polynomial in x. Exact but for
    /// rounding, for the degree does not rise.
    ///
    /// # Panics
    ///
    /// Where `h` has not one entry a variable.
    pub fn shifted(&self, h: &[C]) -> Self {
        let Some(space) = self.space().cloned() else { return self.clone() };
        assert_eq!(h.len(), space.variables(), "one offset a variable");
        let mut terms = self.packed_terms();
        for (i, h) in h.iter().enumerate().filter(|(_, h)| !h.is_zero()) {
            terms = shifted_terms(&space, &terms, i, h);
        }
        Self::sparse(&space, terms)
    }

    /// The polynomial in another space, variable i becoming variable `places[i]`; terms above that
    /// space's order are cut off.
    ///
    /// # Panics
    ///
    /// Where `places` names a variable that the space does not have.
    pub fn embedded(&self, space: &Arc<TaylorSpace>, places: &[usize]) -> Self {
        let Some(own) = self.space() else { return self.clone() };
        assert!(
            places.iter().all(|p| *p < space.variables()),
            "a place beyond the space's variables"
        );
        let mut factors = Vec::new();
        let mut terms = Vec::new();
        self.for_each_term(|m, c| {
            if own.packing.degree(m) <= space.order() {
                own.packing.factors(m, &mut factors);
                let key =
                    factors.iter().map(|v| space.packing.variable(places[usize::from(*v)])).sum();
                terms.push((key, c.clone()));
            }
        });
        Self::sparse(space, sparse::collected(terms))
    }
}

/// Horner's rule in the variable before `end` and those below it; terms sorted by the exponents of
/// the last variables.
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

/// x_i replaced by x_i + h.
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
        let (mut key, mut exponent) = (*m, packing.exponent(*m, i));
        all.push((key, c.clone()));
        // C(e, j) h^{e-j} from one j to the next lower; a ratio of integers below 2^53 is exact
        // enough only if multiplied first.
        for step in 1..=packing.exponent(*m, i) {
            binomial =
                binomial * h.clone() * C::from(f64::from(exponent)) / C::from(f64::from(step));
            key -= packing.variable(i);
            exponent -= 1;
            all.push((key, binomial.clone()));
        }
    }
    sparse::collected(all)
}
