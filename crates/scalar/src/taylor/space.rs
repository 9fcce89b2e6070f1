//! The space that truncated polynomials live in: how many variables, to which order, and how
//! monomials are numbered.

use std::sync::{Arc, OnceLock};

use thiserror::Error;

use super::monomial::Packing;

/// Coefficients that a dense series may have at most.
const MOST_COEFFICIENTS: u128 = 1 << 24;
/// Entries that the product tables of a space may have at most (4 bytes each).
const MOST_ENTRIES: u128 = 1 << 28;

/// Polynomials of k variables truncated at total degree p (Liu & Althoff, IROS 2018, Definition 3).
///
/// Monomials of one degree are ordered by their exponents, that of the last variable first, so that
/// those of degree 1 are x_0, x_1, ...; a dense series stores block after block of one degree. A
/// product of two blocks is driven by a table that gives the place of each product of two
/// monomials; tables are made when first used.
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
    /// Where the block of each degree starts in a dense series; one entry more than there are
    /// degrees. Empty where no dense series fits.
    offsets: Vec<usize>,
    factors: Vec<OnceLock<Box<[u8]>>>,
    tables: Vec<OnceLock<Box<[u32]>>>,
}

/// A space or series that cannot be.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum TaylorSpaceError {
    /// No variable, or more than 120.
    #[error("{variables} variables; a Taylor space has 1 to 120")]
    Variables {
        /// What was asked for.
        variables: usize,
    },
    /// The exponents of a monomial do not fit.
    #[error(
        "order {order} with {variables} variables: exponents are packed into 120 bits, which hold order {most} at most; lower the order or leave out variables"
    )]
    Exponents {
        /// Number of variables k.
        variables: usize,
        /// Order p asked for.
        order: u32,
        /// The highest order that fits.
        most: u32,
    },
    /// A dense series does not fit.
    #[error(
        "a series of {variables} variables to order {order} has {coefficients} coefficients and with its product tables needs {}, more than is allowed ({}); \
         {}",
        size_in_words(*memory), size_in_words(MOST_COEFFICIENTS * 8 + MOST_ENTRIES * 4), remedy(*most)
    )]
    Dense {
        /// Number of variables k.
        variables: usize,
        /// Order p asked for.
        order: u32,
        /// Coefficients it would have.
        coefficients: u128,
        /// Bytes it would need with its tables.
        memory: u128,
        /// The highest order that fits.
        most: u32,
    },
}

fn remedy(most: u32) -> String {
    if most == 0 { "use fewer variables".into() } else { format!("order {most} fits") }
}

/// A size in words.
fn size_in_words(count: u128) -> String {
    let units = ["B", "kB", "MB", "GB", "TB", "PB"];
    let unit = (0..units.len() - 1)
        .find(|u| count < 1000u128.pow(*u as u32 + 1))
        .unwrap_or(units.len() - 1);
    format!("{:.1} {}", count as f64 / 1000f64.powi(unit as i32), units[unit])
}

/// Number of monomials of exactly `degree` in `variables` variables, or `u128::MAX` where that is
/// too many to tell.
pub(super) fn monomials(variables: usize, degree: u32) -> u128 {
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

/// Coefficients and table entries of dense series.
fn dense_size(variables: usize, order: u32) -> (u128, u128) {
    let count = |degree| monomials(variables, degree);
    let coefficients = (0..=order).fold(0u128, |sum, d| sum.saturating_add(count(d)));
    let pair = |i: u32| {
        (i..=order - i).fold(0u128, |sum, j| sum.saturating_add(count(i).saturating_mul(count(j))))
    };
    let entries = (1..=order / 2).fold(0u128, |sum, i| sum.saturating_add(pair(i)));
    (coefficients, entries)
}

fn fits(variables: usize, order: u32) -> bool {
    let (coefficients, entries) = dense_size(variables, order);
    coefficients <= MOST_COEFFICIENTS && entries <= MOST_ENTRIES
}

impl TaylorSpace {
    /// The space of polynomials of `variables` variables to total degree `order`.
    ///
    /// Sparse polynomials always fit; whether a dense series does says
    /// [`check_dense`](Self::check_dense).
    ///
    /// # Errors
    ///
    /// When the exponents of a monomial do not fit 120 bits: order 15 is the most for 28 variables,
    /// 31 for 24, 255 for 15 or fewer.
    pub fn new(variables: usize, order: u32) -> Result<Arc<Self>, TaylorSpaceError> {
        let packing = Packing::new(variables).ok_or(TaylorSpaceError::Variables { variables })?;
        let most = packing.largest_exponent();
        if order > most {
            return Err(TaylorSpaceError::Exponents { variables, order, most });
        }
        let mut offsets = Vec::new();
        if fits(variables, order) {
            let blocks = (0..=order).map(|degree| monomials(variables, degree) as usize);
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
            tables: (0..pairs).map(|_| OnceLock::new()).collect(),
        }))
    }

    /// Number of variables k.
    pub fn variables(&self) -> usize {
        self.variables
    }

    /// The order p: terms of a higher total degree are cut off.
    pub fn order(&self) -> u32 {
        self.order
    }

    /// Whether a dense series fits, as division and elementary functions make one.
    ///
    /// # Errors
    ///
    /// [`TaylorSpaceError::Dense`] with the memory that it would need and the order that fits.
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
            most: (1..self.order).rev().find(|order| fits(self.variables, *order)).unwrap_or(0),
        })
    }

    /// Bytes of one dense series of f64.
    pub fn dense_bytes(&self) -> u128 {
        dense_size(self.variables, self.order).0.saturating_mul(8)
    }

    pub(super) fn fits_dense(&self) -> bool {
        !self.offsets.is_empty()
    }

    /// Number of coefficients of a dense series to `degree`.
    pub(super) fn dense_len(&self, degree: u32) -> usize {
        self.offsets[degree as usize + 1]
    }

    /// The degrees of which a dense series of so many coefficients has a block.
    pub(crate) fn stored_degrees(&self, len: usize) -> impl Iterator<Item = u32> {
        (0..=self.order).take_while(move |degree| self.offsets[*degree as usize + 1] <= len)
    }

    /// Where the coefficients of one degree are.
    pub(crate) fn block(&self, degree: u32) -> core::ops::Range<usize> {
        self.offsets[degree as usize]..self.offsets[degree as usize + 1]
    }

    /// The monomials of one degree in order, each as its factors x_v with falling v: `degree` bytes
    /// a monomial.
    pub(super) fn factors(&self, degree: u32) -> &[u8] {
        self.factors[degree as usize].get_or_init(|| list_factors(self.variables, degree as usize))
    }

    /// Place of the product of monomial a of degree i and monomial b of degree j in the block of
    /// degree i + j, at a · (size of block j) + b; i ≤ j.
    pub(crate) fn table(&self, i: u32, j: u32) -> &[u32] {
        debug_assert!(1 <= i && i <= j && i + j <= self.order);
        let at = i as usize * (self.order as usize + 1) + j as usize;
        self.tables[at].get_or_init(|| self.make_table(i, j))
    }

    fn make_table(&self, i: u32, j: u32) -> Box<[u32]> {
        let weights = Weights::new(self.variables, i + j);
        let (first, second) = (self.factors(i), self.factors(j));
        let mut table = Vec::with_capacity(self.block(i).len() * self.block(j).len());
        for a in first.chunks_exact(i as usize) {
            table.extend(second.chunks_exact(j as usize).map(|b| weights.place_of_product(a, b)));
        }
        table.into()
    }

    /// Place of a monomial given by its factors (falling) within the block of its degree.
    pub(super) fn place(&self, factors: &[u8]) -> usize {
        let degree = factors.len() as u32;
        let count = |(t, v): (usize, &u8)| monomials(usize::from(*v), degree - t as u32) as usize;
        factors.iter().enumerate().map(count).sum()
    }
}

fn list_factors(variables: usize, degree: usize) -> Box<[u8]> {
    let mut list = Vec::with_capacity(monomials(variables, degree as u32) as usize * degree);
    let mut current = vec![0u8; degree];
    loop {
        list.extend_from_slice(&current);
        // The last factor that may still rise without passing the one before it.
        let top = |t: usize| if t == 0 { variables as u8 - 1 } else { current[t - 1] };
        let Some(t) = (0..degree).rev().find(|&t| current[t] < top(t)) else { break };
        current[t] += 1;
        current[t + 1..].fill(0);
    }
    list.into()
}

/// The combinatorial number system: the monomial x_{v_0} x_{v_1} ... with v_0 ≥ v_1 ≥ ... of degree
/// d has the place Σ_t N(v_t, d - t), where N(m, r) monomials of degree r have m variables.
struct Weights {
    variables: usize,
    degree: usize,
    /// N(v, r) at r · variables + v.
    count: Vec<u32>,
}

impl Weights {
    fn new(variables: usize, degree: u32) -> Self {
        let row = |r: u32| (0..variables).map(move |v| monomials(v, r) as u32);
        Self { variables, degree: degree as usize, count: (0..=degree).flat_map(row).collect() }
    }

    fn place_of_product<'a>(&self, mut a: &'a [u8], mut b: &'a [u8]) -> u32 {
        let mut place = 0;
        for rest in (1..=self.degree).rev() {
            let largest =
                if b.is_empty() || !a.is_empty() && a[0] >= b[0] { &mut a } else { &mut b };
            place += self.count[rest * self.variables + usize::from(largest[0])];
            *largest = &largest[1..];
        }
        place
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_count_up_and_products_are_found() {
        let space = TaylorSpace::new(5, 6).unwrap();
        for degree in 1..=6u32 {
            let factors = space.factors(degree);
            for (at, monomial) in factors.chunks_exact(degree as usize).enumerate() {
                assert_eq!(space.place(monomial), at);
            }
            assert_eq!(factors.len(), space.block(degree).len() * degree as usize);
        }
        let (a, b) = (space.factors(2), space.factors(3));
        for (row, x) in a.chunks_exact(2).enumerate() {
            for (column, y) in b.chunks_exact(3).enumerate() {
                let mut product = [x, y].concat();
                product.sort_unstable_by(|v, w| w.cmp(v));
                assert_eq!(
                    space.table(2, 3)[row * space.block(3).len() + column] as usize,
                    space.place(&product)
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
                .map(|(i, j)| monomials(variables, i) * monomials(variables, j))
                .sum();
            assert_eq!(pairs, products);
        }
    }

    #[test]
    fn what_does_not_fit_says_what_does() {
        let space = TaylorSpace::new(24, 12).unwrap();
        let error = space.check_dense().unwrap_err().to_string();
        assert!(
            error.contains("1251677700 coefficients") && error.contains("order 7 fits"),
            "{error}"
        );
        let error = TaylorSpace::new(28, 16).unwrap_err().to_string();
        assert!(error.contains("order 15 at most"), "{error}");
        assert!(TaylorSpace::new(0, 2).is_err() && TaylorSpace::new(121, 1).is_err());
    }
}
