//! Helper functions for monomials, given by their lists of exponents.

use std::collections::BTreeSet;

/// Inserts a monomial and all its divisors, each with its degree.
pub(crate) fn insert_divisors(monomials: &mut BTreeSet<(u32, Vec<u8>)>, monomial: &[u8]) {
    if monomials.insert((degree(monomial), monomial.to_vec())) {
        for i in (0..monomial.len()).filter(|i| monomial[*i] > 0) {
            insert_divisors(monomials, &with_exponent(monomial, i, monomial[i] - 1));
        }
    }
}

/// Returns the monomial with another exponent of one variable.
pub(crate) fn with_exponent(monomial: &[u8], variable: usize, exponent: u8) -> Vec<u8> {
    let mut other = monomial.to_vec();
    other[variable] = exponent;
    other
}

/// Returns the first variable of a monomial that is not constant.
pub(crate) fn first_variable(monomial: &[u8]) -> usize {
    monomial.iter().position(|e| *e > 0).expect("not a constant")
}

pub(crate) fn degree(exponents: &[u8]) -> u32 {
    exponents.iter().map(|e| u32::from(*e)).sum()
}
