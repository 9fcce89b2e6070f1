//! The space of truncated polynomials: the number of variables, the order and the numbering of
//! monomials.

use std::sync::{Arc, OnceLock};

use thiserror::Error;

use super::monomial::Packing;

/// Largest number of coefficients of a dense series.
const MAX_COEFFICIENTS: u128 = 1 << 24;
/// Largest number of entries of all product tables of a space (4 bytes each).
const MAX_TABLE_ENTRIES: u128 = 1 << 28;

/// The space of polynomials in k variables, truncated at total degree p (Liu & Althoff, IROS 2018,
/// Definition 3).
///
/// Monomials of one degree are ordered by their exponents, the last variable's first. The monomials
/// of degree 1 are x_0, x_1, and so on. A dense series stores one block of coefficients per degree.
/// A product table holds the index of the product of each two monomials of two blocks. The space
/// computes a product table or a list of monomials on first use.
///
/// # Examples
///
/// ```
/// use reachtube_scalar::{TaylorPolynomial, TaylorSpace};
///
/// let space = TaylorSpace::new(2, 3).unwrap();
/// let [x, y] = [0, 1].map(|i| TaylorPolynomial::<f64>::variable(&space, i));
/// let f = (x.clone() + y.clone()) * (x - y); // x² - y²
/// assert_eq!(f.term_count(), 2);
/// assert_eq!(f.coefficient(&[0, 2]), -1.0);
/// ```
#[derive(Debug)]
pub struct TaylorSpace {
    variables: usize,
    order: u32,
    pub(crate) packing: Packing,
    /// Start of the block of each degree in a dense series, then its length (p + 2 entries). Empty
    /// if no dense series fits.
    offsets: Vec<usize>,
    factors: Vec<OnceLock<Box<[u8]>>>,
    product_tables: Vec<OnceLock<Box<[u32]>>>,
}

/// An error: a Taylor space or a dense series of it does not fit.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum TaylorSpaceError {
    /// The number of variables is 0 or above 120.
    #[error("a Taylor space has 1 to 120 variables, not {variables}")]
    Variables {
        /// The requested number of variables.
        variables: usize,
    },
    /// The exponents of a monomial do not fit into 120 bits.
    #[error(
        "order {order} is too high for {variables} variables: their exponents fit into 120 bits up \
         to order {max_order}; use a lower order or fewer variables"
    )]
    Exponents {
        /// Number of variables k.
        variables: usize,
        /// The requested order p.
        order: u32,
        /// The highest order that fits.
        max_order: u32,
    },
    /// A dense series does not fit into the allowed memory.
    #[error(
        "a dense series in {variables} variables to order {order} has {coefficients} coefficients \
         and needs {} with its product tables, above the limit of {}; {}",
        format_bytes(*memory),
        format_bytes(MAX_COEFFICIENTS * 8 + MAX_TABLE_ENTRIES * 4),
        remedy(*max_order)
    )]
    Dense {
        /// Number of variables k.
        variables: usize,
        /// Order p of the space.
        order: u32,
        /// Number of coefficients of the series.
        coefficients: u128,
        /// Memory for the series and its product tables, in bytes.
        memory: u128,
        /// The highest order that fits, 0 if none does.
        max_order: u32,
    },
}

/// Returns the change after which a dense series fits.
fn remedy(max_order: u32) -> String {
    if max_order == 0 { "use fewer variables".into() } else { format!("order {max_order} fits") }
}

/// Formats a number of bytes with a unit, for example "2.1 MB".
fn format_bytes(count: u128) -> String {
    let units = ["B", "kB", "MB", "GB", "TB", "PB"];
    let unit = (0..units.len() - 1)
        .find(|u| count < 1000u128.pow(*u as u32 + 1))
        .unwrap_or(units.len() - 1);
    format!("{:.1} {}", count as f64 / 1000f64.powi(unit as i32), units[unit])
}

/// Returns the number of monomials of exactly `degree` in `variables` variables, or `u128::MAX`
/// where the computation overflows.
fn monomial_count(variables: usize, degree: u32) -> u128 {
    match variables {
        0 => u128::from(degree == 0),
        _ => binomial(variables as u128 + u128::from(degree) - 1, u128::from(degree)),
    }
}

fn binomial(n: u128, k: u128) -> u128 {
    let k = k.min(n - k);
    let step = |c: u128, i: u128| c.checked_mul(n - i).map(|product| product / (i + 1));
    (0..k).try_fold(1, step).unwrap_or(u128::MAX)
}

/// Returns the number of coefficients and of product table entries of a dense series.
fn dense_size(variables: usize, order: u32) -> (u128, u128) {
    let count = |degree| monomial_count(variables, degree);
    let coefficients = (0..=order).fold(0u128, |sum, d| sum.saturating_add(count(d)));
    let pair = |i: u32| {
        (i..=order - i).fold(0u128, |sum, j| sum.saturating_add(count(i).saturating_mul(count(j))))
    };
    let entries = (1..=order / 2).fold(0u128, |sum, i| sum.saturating_add(pair(i)));
    (coefficients, entries)
}

fn dense_fits(variables: usize, order: u32) -> bool {
    let (coefficients, entries) = dense_size(variables, order);
    coefficients <= MAX_COEFFICIENTS && entries <= MAX_TABLE_ENTRIES
}

impl TaylorSpace {
    /// Returns the space of polynomials in `variables` variables to total degree `order`.
    ///
    /// Sparse polynomials of the space always fit; [`check_dense`](Self::check_dense) checks dense
    /// series.
    ///
    /// # Errors
    ///
    /// - [`TaylorSpaceError::Variables`] if `variables` is 0 or above 120.
    /// - [`TaylorSpaceError::Exponents`] if the exponents of a monomial do not fit into 120 bits.
    ///   The highest order is 15 for 28 variables, 31 for 24, and 255 for 15 or fewer.
    pub fn new(variables: usize, order: u32) -> Result<Arc<Self>, TaylorSpaceError> {
        let packing = Packing::new(variables).ok_or(TaylorSpaceError::Variables { variables })?;
        let max_order = packing.largest_exponent();
        if order > max_order {
            return Err(TaylorSpaceError::Exponents { variables, order, max_order });
        }
        let mut offsets = Vec::new();
        if dense_fits(variables, order) {
            let blocks = (0..=order).map(|degree| monomial_count(variables, degree) as usize);
            offsets.push(0);
            offsets.extend(blocks.scan(0, |sum, block| {
                *sum += block;
                Some(*sum)
            }));
        }
        let pairs = (order as usize / 2 + 1) * (order as usize + 1);
        Ok(Arc::new(Self {
            variables,
            order,
            packing,
            offsets,
            factors: (0..=order).map(|_| OnceLock::new()).collect(),
            product_tables: (0..pairs).map(|_| OnceLock::new()).collect(),
        }))
    }

    /// Returns the number of variables k.
    pub fn variables(&self) -> usize {
        self.variables
    }

    /// Returns the order p, the highest total degree of a term.
    pub fn order(&self) -> u32 {
        self.order
    }

    /// Checks that a dense series fits, which division and elementary functions need.
    ///
    /// # Errors
    ///
    /// [`TaylorSpaceError::Dense`] where it does not, with the memory it needs and the highest
    /// order that fits.
    pub fn check_dense(&self) -> Result<(), TaylorSpaceError> {
        if self.fits_dense() {
            return Ok(());
        }
        let (coefficients, entries) = dense_size(self.variables, self.order);
        Err(TaylorSpaceError::Dense {
            variables: self.variables,
            order: self.order,
            coefficients,
            memory: coefficients.saturating_mul(8).saturating_add(entries.saturating_mul(4)),
            max_order: (1..self.order)
                .rev()
                .find(|order| dense_fits(self.variables, *order))
                .unwrap_or(0),
        })
    }

    pub(super) fn fits_dense(&self) -> bool {
        !self.offsets.is_empty()
    }

    /// Returns the number of coefficients of a dense series to `degree`.
    pub(super) fn dense_len(&self, degree: u32) -> usize {
        self.offsets[degree as usize + 1]
    }

    /// Iterates over the degrees that a dense series of `len` coefficients stores.
    pub(crate) fn stored_degrees(&self, len: usize) -> impl Iterator<Item = u32> {
        (0..=self.order).take_while(move |degree| self.offsets[*degree as usize + 1] <= len)
    }

    /// Returns the range of the coefficients of one degree in a dense series.
    pub(crate) fn block(&self, degree: u32) -> core::ops::Range<usize> {
        self.offsets[degree as usize]..self.offsets[degree as usize + 1]
    }

    /// Returns the monomials of one degree in order, each as its factors x_v with descending v
    /// (`degree` bytes per monomial).
    pub(super) fn factors(&self, degree: u32) -> &[u8] {
        self.factors[degree as usize].get_or_init(|| list_factors(self.variables, degree as usize))
    }

    /// Returns the product table of degrees i ≤ j, row-major with one row per monomial of degree i.
    ///
    /// Row a, column b holds the index of the product of monomials a and b in the block of degree
    /// i + j.
    pub(crate) fn product_table(&self, i: u32, j: u32) -> &[u32] {
        debug_assert!(1 <= i && i <= j && i + j <= self.order);
        let at = i as usize * (self.order as usize + 1) + j as usize;
        self.product_tables[at].get_or_init(|| self.compute_product_table(i, j))
    }

    fn compute_product_table(&self, i: u32, j: u32) -> Box<[u32]> {
        let index = ProductIndex::new(self.variables, i + j);
        let (first, second) = (self.factors(i), self.factors(j));
        let mut table = Vec::with_capacity(self.block(i).len() * self.block(j).len());
        for a in first.chunks_exact(i as usize) {
            table.extend(second.chunks_exact(j as usize).map(|b| index.of_product(a, b)));
        }
        table.into()
    }

    /// Returns the index of a monomial within the block of its degree, given its factors x_v with
    /// descending v.
    pub(super) fn index_of(&self, factors: &[u8]) -> usize {
        let degree = factors.len() as u32;
        let count =
            |(t, v): (usize, &u8)| monomial_count(usize::from(*v), degree - t as u32) as usize;
        factors.iter().enumerate().map(count).sum()
    }
}

/// Lists the monomials of one degree in order, each as its factors.
fn list_factors(variables: usize, degree: usize) -> Box<[u8]> {
    let mut list = Vec::with_capacity(monomial_count(variables, degree as u32) as usize * degree);
    let mut current = vec![0u8; degree];
    loop {
        list.extend_from_slice(&current);
        // The last factor that can increase without exceeding the one before it.
        let top = |t: usize| if t == 0 { variables as u8 - 1 } else { current[t - 1] };
        let Some(t) = (0..degree).rev().find(|&t| current[t] < top(t)) else { break };
        current[t] += 1;
        current[t + 1..].fill(0);
    }
    list.into()
}

/// The combinatorial number system, which numbers the monomials of one degree.
///
/// The monomial x_{v_0} x_{v_1} ... of degree d with v_0 ≥ v_1 ≥ ... has the index
/// Σ_t N(v_t, d - t), where N(m, r) is the number of monomials of degree r in m variables.
struct ProductIndex {
    variables: usize,
    degree: usize,
    /// N(v, r) at r · variables + v.
    count: Vec<u32>,
}

impl ProductIndex {
    fn new(variables: usize, degree: u32) -> Self {
        let row = |r: u32| (0..variables).map(move |v| monomial_count(v, r) as u32);
        Self { variables, degree: degree as usize, count: (0..=degree).flat_map(row).collect() }
    }

    /// Returns the index of the product of two monomials, given the factors of each.
    fn of_product<'a>(&self, mut a: &'a [u8], mut b: &'a [u8]) -> u32 {
        let mut index = 0;
        for rest in (1..=self.degree).rev() {
            let largest =
                if b.is_empty() || !a.is_empty() && a[0] >= b[0] { &mut a } else { &mut b };
            index += self.count[rest * self.variables + usize::from(largest[0])];
            *largest = &largest[1..];
        }
        index
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn indices_count_up_and_product_tables_match() {
        let space = TaylorSpace::new(5, 6).unwrap();
        for degree in 1..=6u32 {
            let factors = space.factors(degree);
            for (at, monomial) in factors.chunks_exact(degree as usize).enumerate() {
                assert_eq!(space.index_of(monomial), at);
            }
            assert_eq!(factors.len(), space.block(degree).len() * degree as usize);
        }
        let (a, b) = (space.factors(2), space.factors(3));
        for (row, x) in a.chunks_exact(2).enumerate() {
            for (column, y) in b.chunks_exact(3).enumerate() {
                let mut product = [x, y].concat();
                product.sort_unstable_by(|v, w| w.cmp(v));
                assert_eq!(
                    space.product_table(2, 3)[row * space.block(3).len() + column] as usize,
                    space.index_of(&product)
                );
            }
        }
    }

    #[test]
    fn sizes_are_those_of_the_literature() {
        for (variables, order, coefficients, products) in [
            (6, 6, 924, 18_564),
            (12, 4, 1_820, 20_475),
            (24, 3, 2_925, 20_825),
            (24, 4, 20_475, 270_725),
        ] {
            assert_eq!(dense_size(variables, order).0, coefficients);
            let pairs: u128 = (0..=order)
                .flat_map(|i| (0..=order - i).map(move |j| (i, j)))
                .map(|(i, j)| monomial_count(variables, i) * monomial_count(variables, j))
                .sum();
            assert_eq!(pairs, products);
        }
    }

    #[test]
    fn errors_name_the_highest_order_that_fits() {
        let space = TaylorSpace::new(24, 12).unwrap();
        let error = space.check_dense().unwrap_err().to_string();
        assert!(
            error.contains("1251677700 coefficients") && error.contains("order 7 fits"),
            "{error}"
        );
        let error = TaylorSpace::new(28, 16).unwrap_err().to_string();
        assert!(error.contains("up to order 15;"), "{error}");
        assert!(TaylorSpace::new(0, 2).is_err() && TaylorSpace::new(121, 1).is_err());
    }
}
