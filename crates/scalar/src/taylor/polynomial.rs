//! The type [`TaylorPolynomial`]: storage forms, constructors and accessors.

use std::sync::Arc;

use super::addition::PlainAddition;
use super::dense::{self, pad_with_zeros};
use super::space::TaylorSpace;
use super::sparse::{self, Term};
use crate::scalar::Scalar;

/// A polynomial in a [`TaylorSpace`], truncated at the order of the space.
///
/// The variables are offsets from an expansion point. Their units and meaning are the caller's.
/// Each result takes one of three storage forms:
///
/// - a constant, which belongs to every space, so that code over [`Scalar`] can convert a number;
/// - a sorted list of terms, for sparse polynomials such as a robot's M, g and c;
/// - a dense series, as division and elementary functions compute it.
///
/// Clones share memory until one of them is changed.
///
/// Sums and products are truncated at the order. With coefficients of type
/// [`Interval`](crate::Interval), each coefficient encloses the exact one.
///
/// # Panics
///
/// Operations panic where the operands belong to spaces that differ in variables or order. Division
/// and elementary functions panic where the dense series does not fit
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

/// The storage form of a polynomial.
#[derive(Clone, Debug)]
pub(crate) enum Form<C> {
    Constant(C),
    Sparse(Arc<TaylorSpace>, Arc<Vec<Term<C>>>),
    Dense(Arc<TaylorSpace>, Arc<Vec<C>>),
}

/// A term of a polynomial: a coefficient times a monomial.
#[derive(Clone, Debug, PartialEq)]
pub struct TaylorTerm<C> {
    /// Exponent of each variable (k entries).
    pub exponents: Vec<u8>,
    /// Coefficient.
    pub coefficient: C,
}

impl<C: Scalar> TaylorPolynomial<C> {
    /// Returns the variable x_i, an offset from the expansion point.
    ///
    /// # Panics
    ///
    /// Panics if the space has no variable i.
    pub fn variable(space: &Arc<TaylorSpace>, i: usize) -> Self {
        Self::variable_at(space, i, C::zero())
    }

    /// Returns value + x_i: variable i about the expansion point `value`.
    ///
    /// # Panics
    ///
    /// Panics if the space has no variable i.
    pub fn variable_at(space: &Arc<TaylorSpace>, i: usize, value: C) -> Self {
        let variables = space.variables();
        assert!(i < variables, "variable {i} of a Taylor space with {variables} variables");
        let mut terms = sparse::constant(&value);
        if space.order() > 0 {
            terms.push((space.packing.variable(i), C::one()));
        }
        Self::sparse(space, terms)
    }

    /// Returns a constant, which belongs to every space.
    pub fn constant(value: C) -> Self {
        Self { form: Form::Constant(value) }
    }

    /// Returns the polynomial with the given terms, in any order. Terms above the order of the
    /// space are dropped.
    ///
    /// ```
    /// use reachtube_scalar::{TaylorPolynomial, TaylorSpace, TaylorTerm};
    ///
    /// let space = TaylorSpace::new(2, 3).unwrap();
    /// let term = TaylorTerm { exponents: vec![2, 1], coefficient: 4.0 };
    /// let f = TaylorPolynomial::from_terms(&space, [term]);
    /// assert_eq!(f.evaluate(&[3.0, 0.5]), 18.0);
    /// ```
    ///
    /// # Panics
    ///
    /// Panics if a term does not have one exponent per variable.
    pub fn from_terms(
        space: &Arc<TaylorSpace>,
        terms: impl IntoIterator<Item = TaylorTerm<C>>,
    ) -> Self {
        let fits = |term: &TaylorTerm<C>| {
            assert_eq!(
                term.exponents.len(),
                space.variables(),
                "a term needs one exponent per variable"
            );
            term.exponents.iter().map(|e| u32::from(*e)).sum::<u32>() <= space.order()
        };
        let pack =
            |term: TaylorTerm<C>| (space.packing.pack_exponents(&term.exponents), term.coefficient);
        let packed = terms.into_iter().filter(fits).map(pack).collect();
        Self::sparse(space, sparse::collect_like_terms(packed))
    }

    /// Returns the polynomial stored as a list of terms, which must be sorted.
    pub(crate) fn sparse(space: &Arc<TaylorSpace>, terms: Vec<Term<C>>) -> Self {
        Self { form: Form::Sparse(Arc::clone(space), Arc::new(terms)) }
    }

    /// Returns the polynomial stored as a dense series of whole blocks.
    pub(crate) fn dense(space: &Arc<TaylorSpace>, coefficients: Vec<C>) -> Self {
        Self { form: Form::Dense(Arc::clone(space), Arc::new(coefficients)) }
    }

    /// Returns the space of the polynomial; `None` for a constant.
    pub fn space(&self) -> Option<&Arc<TaylorSpace>> {
        match &self.form {
            Form::Constant(_) => None,
            Form::Sparse(space, _) | Form::Dense(space, _) => Some(space),
        }
    }

    /// Calls `visit` with the packed monomial and the coefficient of each non-zero term, in order.
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

    /// Returns the non-zero terms with packed monomials, in order.
    pub(super) fn packed_terms(&self) -> Vec<Term<C>> {
        let mut terms = Vec::new();
        self.for_each_term(|m, c| terms.push((m, c.clone())));
        terms
    }

    /// Returns the coefficients of a polynomial that belongs to `space`, as a dense series.
    pub(super) fn coefficients(&self, space: &TaylorSpace) -> Vec<C> {
        let mut out = vec![C::zero(); space.dense_len(0)];
        match &self.form {
            Form::Dense(_, coefficients) => return coefficients.to_vec(),
            Form::Constant(c) => out[0] = c.clone(),
            Form::Sparse(_, terms) => {
                let degree = terms.last().map_or(0, |(m, _)| space.packing.degree(*m));
                pad_with_zeros(&mut out, space.dense_len(degree));
                dense::add_terms(space, &mut out, terms, false, &mut PlainAddition);
            }
        }
        out
    }

    /// Returns the non-zero terms, sorted by degree, then by the exponent of the last variable
    /// first. The term of a constant has an empty list of exponents.
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

    /// Returns the number of non-zero terms.
    pub fn term_count(&self) -> usize {
        let mut count = 0;
        self.for_each_term(|_, _| count += 1);
        count
    }

    /// Returns the highest total degree of a non-zero term; 0 for the zero polynomial.
    pub fn degree(&self) -> u32 {
        let mut degree = 0;
        if let Some(space) = self.space() {
            self.for_each_term(|m, _| degree = degree.max(space.packing.degree(m)));
        }
        degree
    }

    /// Returns the coefficient of the monomial with the given exponents, one per variable; zero if
    /// there is no such term.
    pub fn coefficient(&self, exponents: &[u8]) -> C {
        let Some(space) = self.space() else {
            return if exponents.iter().all(|e| *e == 0) {
                self.constant_term()
            } else {
                C::zero()
            };
        };
        let mut found = C::zero();
        let wanted = space.packing.pack_exponents(exponents);
        self.for_each_term(|m, c| {
            if m == wanted {
                found = c.clone();
            }
        });
        found
    }

    /// Returns the value at the expansion point.
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

    /// Returns whether variable i occurs in a non-zero term.
    pub fn depends_on(&self, i: usize) -> bool {
        let mut depends = false;
        if let Some(space) = self.space() {
            self.for_each_term(|m, _| depends |= space.packing.exponent(m, i) > 0);
        }
        depends
    }

    /// Applies `map` to each stored coefficient, for example to convert it to an interval. Terms
    /// that become zero are dropped from a list of terms.
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
    /// Returns whether all coefficients are finite.
    pub(crate) fn is_finite(&self) -> bool {
        match &self.form {
            Form::Constant(c) => c.is_finite(),
            Form::Sparse(_, terms) => terms.iter().all(|(_, c)| c.is_finite()),
            Form::Dense(_, coefficients) => coefficients.iter().all(|c| c.is_finite()),
        }
    }
}

impl<C: Scalar> PartialEq for TaylorPolynomial<C> {
    /// Returns whether all terms are equal; the storage forms may differ.
    fn eq(&self, other: &Self) -> bool {
        self.packed_terms() == other.packed_terms()
    }
}
