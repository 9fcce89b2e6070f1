//! Monomials, packed into one integer.

/// How exponents are packed: the degree in the top byte, below it `bits` for each variable,
/// variable 0 lowest.
///
/// Packed monomials multiply by addition and compare by degree, then by the exponents of the last
/// variables first: the order of [`TaylorSpace`](super::TaylorSpace).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Packing {
    bits: u32,
    /// The lowest bit of each exponent: none of them is set in a monomial that is a square.
    pub odd_exponents: u128,
}

const DEGREE_SHIFT: u32 = 120;

impl Packing {
    pub fn new(variables: usize) -> Option<Self> {
        (1..=120).contains(&variables).then(|| {
            let bits = (120 / variables as u32).min(8);
            let odd_exponents = (0..variables as u32).map(|i| 1 << (bits * i)).sum();
            Self { bits, odd_exponents }
        })
    }

    pub fn largest_exponent(self) -> u32 {
        (1 << self.bits) - 1
    }

    pub fn variable(self, i: usize) -> u128 {
        1 << DEGREE_SHIFT | 1 << (self.bits * i as u32)
    }

    pub fn degree(self, key: u128) -> u32 {
        (key >> DEGREE_SHIFT) as u32
    }

    pub fn exponent(self, key: u128, i: usize) -> u32 {
        (key >> (self.bits * i as u32)) as u32 & self.largest_exponent()
    }

    /// The bits of the exponent of variable i.
    pub fn bits_of(self, i: usize) -> u128 {
        u128::from(self.largest_exponent()) << (self.bits * i as u32)
    }

    /// The monomial without what it has of variable i.
    pub fn without(self, key: u128, i: usize) -> u128 {
        key - u128::from(self.exponent(key, i)) * self.variable(i)
    }

    /// The highest variable of the monomial; `None` for 1.
    pub fn last_variable(self, key: u128) -> Option<usize> {
        let exponents = exponents_only(key);
        (exponents != 0).then(|| ((127 - exponents.leading_zeros()) / self.bits) as usize)
    }

    /// The lowest variable of the monomial; `None` for 1.
    pub fn first_variable(self, key: u128) -> Option<usize> {
        let exponents = exponents_only(key);
        (exponents != 0).then(|| (exponents.trailing_zeros() / self.bits) as usize)
    }

    pub fn of_factors(self, factors: &[u8]) -> u128 {
        factors.iter().map(|v| self.variable(usize::from(*v))).sum()
    }

    /// The factors of the monomial, falling, into `out`.
    pub fn factors(self, key: u128, out: &mut Vec<u8>) {
        out.clear();
        let mut rest = key;
        while let Some(v) = self.last_variable(rest) {
            out.push(v as u8);
            rest -= self.variable(v);
        }
    }
}

/// The key without its degree: the order by exponents of the last variables first.
pub(crate) fn exponents_only(key: u128) -> u128 {
    key & ((1 << DEGREE_SHIFT) - 1)
}
