//! Monomials, packed into one integer.

/// The layout of a packed monomial: the total degree in the top byte, below it `bits` bits for the
/// exponent of each variable, with variable 0 lowest.
///
/// The product of two monomials is the sum of their packed integers. Packed monomials compare by
/// degree, then by the exponents, the last variable's first; a `TaylorSpace` orders monomials in
/// the same way.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Packing {
    bits: u32,
    /// The lowest bit of each exponent. A monomial is a square where none of these bits is set.
    pub odd_exponents: u128,
}

const DEGREE_SHIFT: u32 = 120;

impl Packing {
    /// Returns the layout for 1 to 120 variables, else `None`.
    pub(crate) fn new(variables: usize) -> Option<Self> {
        (1..=120).contains(&variables).then(|| {
            let bits = (120 / variables as u32).min(8);
            let odd_exponents = (0..variables as u32).map(|i| 1 << (bits * i)).sum();
            Self { bits, odd_exponents }
        })
    }

    pub(crate) fn largest_exponent(self) -> u32 {
        (1 << self.bits) - 1
    }

    pub(crate) fn variable(self, i: usize) -> u128 {
        1 << DEGREE_SHIFT | 1 << (self.bits * i as u32)
    }

    pub(crate) fn degree(self, monomial: u128) -> u32 {
        (monomial >> DEGREE_SHIFT) as u32
    }

    pub(crate) fn exponent(self, monomial: u128, i: usize) -> u32 {
        (monomial >> (self.bits * i as u32)) as u32 & self.largest_exponent()
    }

    pub(crate) fn exponent_mask(self, i: usize) -> u128 {
        u128::from(self.largest_exponent()) << (self.bits * i as u32)
    }

    pub(crate) fn without(self, monomial: u128, i: usize) -> u128 {
        monomial - u128::from(self.exponent(monomial, i)) * self.variable(i)
    }

    /// Returns the highest variable that occurs in the monomial; `None` for the monomial 1.
    pub(crate) fn last_variable(self, monomial: u128) -> Option<usize> {
        let exponents = exponents_only(monomial);
        (exponents != 0).then(|| ((127 - exponents.leading_zeros()) / self.bits) as usize)
    }

    /// Returns the lowest variable that occurs in the monomial; `None` for the monomial 1.
    pub(crate) fn first_variable(self, monomial: u128) -> Option<usize> {
        let exponents = exponents_only(monomial);
        (exponents != 0).then(|| (exponents.trailing_zeros() / self.bits) as usize)
    }

    pub(crate) fn pack_exponents(self, exponents: &[u8]) -> u128 {
        exponents.iter().enumerate().map(|(i, e)| u128::from(*e) * self.variable(i)).sum()
    }

    /// Packs a monomial given by its factors x_v, each with exponent 1.
    pub(crate) fn pack_factors(self, factors: &[u8]) -> u128 {
        factors.iter().map(|v| self.variable(usize::from(*v))).sum()
    }

    /// Writes the factors x_v of the monomial into `out`, with descending v.
    pub(crate) fn factors(self, monomial: u128, out: &mut Vec<u8>) {
        out.clear();
        let mut rest = monomial;
        while let Some(v) = self.last_variable(rest) {
            out.push(v as u8);
            rest -= self.variable(v);
        }
    }
}

/// Returns the exponents of a packed monomial without its degree. They compare by the exponent of
/// the last variable first.
pub(crate) fn exponents_only(monomial: u128) -> u128 {
    monomial & ((1 << DEGREE_SHIFT) - 1)
}
