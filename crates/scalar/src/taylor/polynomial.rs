//! The type [`TaylorPolynomial`]: constructors and accessors.

use std::sync::Arc;

use super::dense;
use super::space::TaylorSpace;
use super::sparse::{self, Term};
use crate::Scalar;

/// A polynomial in a [`TaylorSpace`]: terms of total degree above the order are cut off.
///
/// The variables are offsets from an expansion point; where they are angles' sines or a robot's
/// velocities is the user's to know. Three forms, chosen as results need: a constant, which belongs
/// to every space, so that code written over [`Scalar`] can make one from a number; a sorted list
/// of terms, for the sparse exact polynomials of a robot's M, g and c; and a dense series, as
/// division makes it. Copies share memory until one is changed.
///
/// Sums and products are truncated to the order; with coefficients of type
/// [`Interval`](crate::Interval) each coefficient encloses the exact one.
///
/// # Panics
///
/// Operations panic where operands belong to spaces that differ in variables or order, and where
/// division or an elementary function would need a dense series that does not fit
/// ([`TaylorSpace::check_dense`]).
///
/// # Examples
///
/// ```
/// use reachtube_scalar::{TaylorPolynomial, TaylorSpace};
///
/// let space = TaylorSpace::new(1, 4).unwrap();
/// let x = TaylorPolynomial::<f64>::variable(&space, 0);
/// let f = TaylorPolynomial::from(1.0) / (TaylorPolynomial::from(1.0) - x); // 1 + x + x² + x³ + x⁴
/// assert_eq!(f.coefficient(&[4]), 1.0);
/// assert_eq!(f.evaluate(&[0.5]), 1.9375);
/// ```
#[derive(Clone, Debug)]
pub struct TaylorPolynomial<C = f64> {
    pub(crate) form: Form<C>,
}

/// How a polynomial is stored.
#[derive(Clone, Debug)]
pub(crate) enum Form<C> {
    Constant(C),
    Sparse(Arc<TaylorSpace>, Arc<Vec<Term<C>>>),
    Dense(Arc<TaylorSpace>, Arc<Vec<C>>),
}

/// A term of a polynomial.
#[derive(Clone, Debug, PartialEq)]
pub struct TaylorTerm<C> {
    /// Exponent of each variable.
    pub exponents: Vec<u8>,
    /// Coefficient.
    pub coefficient: C,
}

impl<C: Scalar> TaylorPolynomial<C> {
    /// The variable x_i, an offset from the expansion point.
    pub fn variable(space: &Arc<TaylorSpace>, i: usize) -> Self {
        assert!(i < space.variables(), "variable {i} of a space of {}", space.variables());
        let terms = if space.order() == 0 {
            Vec::new()
        } else {
            vec![(space.packing.variable(i), C::one())]
        };
        Self::sparse(space, terms)
    }

    /// value + x_i: the variable i near an expansion point.
    pub fn variable_at(space: &Arc<TaylorSpace>, i: usize, value: C) -> Self {
        Self::variable(space, i) + Self::constant(value)
    }

    /// A constant; it belongs to every space.
    pub fn constant(value: C) -> Self {
        Self { form: Form::Constant(value) }
    }

    /// A polynomial by its terms, in any order; terms above the space's order are cut off.
    ///
    /// ```
    /// use reachtube_scalar::{TaylorPolynomial, TaylorSpace, TaylorTerm};
    ///
    /// let space = TaylorSpace::new(2, 3).unwrap();
    /// let f = TaylorPolynomial::from_terms(&space, [TaylorTerm { exponents: vec![2, 1], coefficient: 4.0 }]);
    /// assert_eq!(f.evaluate(&[3.0, 0.5]), 18.0);
    /// ```
    ///
    /// # Panics
    ///
    /// Where a term has not one exponent a variable.
    pub fn from_terms(
        space: &Arc<TaylorSpace>,
        terms: impl IntoIterator<Item = TaylorTerm<C>>,
    ) -> Self {
        let fits = |term: &TaylorTerm<C>| {
            assert_eq!(term.exponents.len(), space.variables(), "one exponent a variable");
            term.exponents.iter().map(|e| u32::from(*e)).sum::<u32>() <= space.order()
        };
        let key = |exponents: &[u8]| -> u128 {
            exponents
                .iter()
                .enumerate()
                .map(|(i, e)| u128::from(*e) * space.packing.variable(i))
                .sum()
        };
        let all =
            terms.into_iter().filter(fits).map(|term| (key(&term.exponents), term.coefficient));
        Self::sparse(space, sparse::collected(all.collect()))
    }

    pub(crate) fn sparse(space: &Arc<TaylorSpace>, terms: Vec<Term<C>>) -> Self {
        Self { form: Form::Sparse(Arc::clone(space), Arc::new(terms)) }
    }

    pub(crate) fn dense(space: &Arc<TaylorSpace>, coefficients: Vec<C>) -> Self {
        Self { form: Form::Dense(Arc::clone(space), Arc::new(coefficients)) }
    }

    /// The space; `None` for a constant.
    pub fn space(&self) -> Option<&Arc<TaylorSpace>> {
        match &self.form {
            Form::Constant(_) => None,
            Form::Sparse(space, _) | Form::Dense(space, _) => Some(space),
        }
    }

    /// Calls `visit` with the packed monomial and coefficient of each non-zero term, in order.
    pub(crate) fn for_each_term(&self, mut visit: impl FnMut(u128, &C)) {
        match &self.form {
            Form::Constant(c) if c.is_zero() => {}
            Form::Constant(c) => visit(0, c),
            Form::Sparse(_, terms) => terms.iter().for_each(|(m, c)| visit(*m, c)),
            Form::Dense(space, coefficients) => {
                dense::terms(space, coefficients).for_each(|(m, c)| visit(m, c));
            }
        }
    }

    pub(super) fn packed_terms(&self) -> Vec<Term<C>> {
        let mut terms = Vec::new();
        self.for_each_term(|m, c| terms.push((m, c.clone())));
        terms
    }

    /// The non-zero terms, by degree, then by the exponents of the last variables. A constant's
    /// term has no exponents.
    pub fn terms(&self) -> Vec<TaylorTerm<C>> {
        let exponents = |m: u128| match self.space() {
            None => Vec::new(),
            Some(space) => {
                (0..space.variables()).map(|i| space.packing.exponent(m, i) as u8).collect()
            }
        };
        let mut terms = Vec::new();
        self.for_each_term(|m, c| {
            terms.push(TaylorTerm { exponents: exponents(m), coefficient: c.clone() });
        });
        terms
    }

    /// Number of non-zero terms.
    pub fn term_count(&self) -> usize {
        let mut count = 0;
        self.for_each_term(|_, _| count += 1);
        count
    }

    /// The highest total degree of a non-zero term; 0 for the zero polynomial.
    pub fn degree(&self) -> u32 {
        let mut degree = 0;
        if let Some(space) = self.space() {
            self.for_each_term(|m, _| degree = degree.max(space.packing.degree(m)));
        }
        degree
    }

    /// The coefficient of the monomial with the given exponents; zero where there is no such term.
    pub fn coefficient(&self, exponents: &[u8]) -> C {
        let Some(space) = self.space() else {
            return if exponents.iter().all(|e| *e == 0) {
                self.constant_term()
            } else {
                C::zero()
            };
        };
        let mut found = C::zero();
        let wanted: u128 = exponents
            .iter()
            .enumerate()
            .map(|(i, e)| u128::from(*e) * space.packing.variable(i))
            .sum();
        self.for_each_term(|m, c| {
            if m == wanted {
                found = c.clone();
            }
        });
        found
    }

    /// The value at the expansion point.
    pub fn constant_term(&self) -> C {
        match &self.form {
            Form::Constant(c) => c.clone(),
            Form::Sparse(_, terms) => match terms.first() {
                Some((0, c)) => c.clone(),
                _ => C::zero(),
            },
            Form::Dense(_, coefficients) => coefficients[0].clone(),
        }
    }

    /// Whether variable i occurs.
    pub fn depends_on(&self, i: usize) -> bool {
        let mut depends = false;
        if let Some(space) = self.space() {
            self.for_each_term(|m, _| depends |= space.packing.exponent(m, i) > 0);
        }
        depends
    }

    /// Each coefficient mapped, as to intervals or back; zeros are dropped.
    pub fn map_coefficients<D: Scalar>(&self, map: impl Fn(&C) -> D) -> TaylorPolynomial<D> {
        match &self.form {
            Form::Constant(c) => TaylorPolynomial::constant(map(c)),
            Form::Dense(space, coefficients) => {
                TaylorPolynomial::dense(space, coefficients.iter().map(map).collect())
            }
            Form::Sparse(space, terms) => {
                let mapped = terms.iter().map(|(m, c)| (*m, map(c))).filter(|(_, c)| !c.is_zero());
                TaylorPolynomial::sparse(space, mapped.collect())
            }
        }
    }
}

impl TaylorPolynomial<f64> {
    /// Whether no coefficient is infinite or NaN.
    pub(crate) fn is_finite(&self) -> bool {
        match &self.form {
            Form::Constant(c) => c.is_finite(),
            Form::Sparse(_, terms) => terms.iter().all(|(_, c)| c.is_finite()),
            Form::Dense(_, coefficients) => coefficients.iter().all(|c| c.is_finite()),
        }
    }
}

impl<C: Scalar> PartialEq for TaylorPolynomial<C> {
    /// Whether all terms are the same; the forms may differ.
    fn eq(&self, other: &Self) -> bool {
        self.packed_terms() == other.packed_terms()
    }
}
