//! The monomials of f as a chain of products, for power series in time.

use std::collections::BTreeMap;

use reachtube_scalar::{Interval, TaylorPolynomial};

/// The monomials of f and the sums that form its components.
///
/// The first N + m monomials are the variables; each further one is a product of two earlier ones.
#[derive(Debug)]
pub(crate) struct Monomials {
    pub variables: usize,
    /// Indices of the two factors of each further monomial.
    pub products: Vec<[usize; 2]>,
    /// Constant term of each component.
    pub constants: Vec<Interval>,
    /// Monomials of each component, with their coefficients.
    pub rows: Vec<Vec<(usize, Interval)>>,
}

impl Monomials {
    pub(crate) fn new(variables: usize, components: &[TaylorPolynomial<Interval>]) -> Self {
        let unit = |i: usize| (0..variables).map(|j| u8::from(i == j)).collect::<Vec<_>>();
        let mut indices: BTreeMap<Vec<u8>, usize> = (0..variables).map(|i| (unit(i), i)).collect();
        let mut all = Self { variables, products: vec![], constants: vec![], rows: vec![] };
        for component in components {
            all.constants.push(component.constant_term());
            let terms =
                component.terms().into_iter().filter(|term| term.exponents.iter().any(|e| *e > 0));
            let row = terms
                .map(|term| (all.index(term.exponents, &mut indices), term.coefficient))
                .collect();
            all.rows.push(row);
        }
        all
    }

    /// Returns the index of a monomial; appends a new one after its divisors.
    fn index(&mut self, exponents: Vec<u8>, indices: &mut BTreeMap<Vec<u8>, usize>) -> usize {
        if let Some(index) = indices.get(&exponents) {
            return *index;
        }
        let variable = exponents.iter().position(|e| *e > 0).expect("not a constant");
        let mut divisor = exponents.clone();
        divisor[variable] -= 1;
        let divisor = self.index(divisor, indices);
        self.products.push([divisor, variable]);
        let index = self.variables + self.products.len() - 1;
        indices.insert(exponents, index);
        index
    }

    pub(crate) fn count(&self) -> usize {
        self.variables + self.products.len()
    }
}
