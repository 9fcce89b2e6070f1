//! Bounds of polynomials over [-1, 1]^k. There, the magnitude of a monomial is at most 1, and a
//! monomial with even exponents lies in [0, 1].

use crate::interval::closed::Interval;
use crate::taylor::polynomial::{Form, TaylorPolynomial};
use crate::taylor::space::TaylorSpace;

/// Returns an upper bound of the exact value of a sum that was computed as x.
///
/// The summands are non-negative numbers, or products of two of them. Each passes through at most
/// `operations` roundings.
///
/// One rounding costs a factor of at most 1/(1 - u), u = ε/2; k roundings cost less than 1 + 2ku
/// for ku < 1/2. The two additional ε cover the rounding of this function. The bound excludes
/// underflow, which costs less than 2⁻¹⁰⁷⁵ per product: [`f64::MIN_POSITIVE`] covers 2⁵² products.
pub(super) fn inflated(x: f64, operations: usize) -> f64 {
    if operations == 0 { x } else { x * (1.0 + (operations + 2) as f64 * f64::EPSILON) }
}

/// Returns a lower bound of the exact value of a sum of non-negative numbers, without products,
/// that was computed as x; see [`inflated`].
fn deflated(x: f64, operations: usize) -> f64 {
    if operations == 0 { x } else { x * (1.0 - (operations + 2) as f64 * f64::EPSILON) }
}

/// A bound of sums of magnitudes, and of products of them, below which none of them overflows.
pub(super) const OVERFLOW_GUARD: f64 = 1e300;

/// Number of partial sums computed side by side, for vector instructions.
pub(super) const PARTIAL_SUMS: usize = 8;

/// Returns Σ |c|, rounded up.
pub(super) fn sum_of_magnitudes(c: &[f64]) -> f64 {
    let (chunks, rest) = c.as_chunks::<PARTIAL_SUMS>();
    let mut sums = [0.0; PARTIAL_SUMS];
    for chunk in chunks {
        sums.iter_mut().zip(chunk).for_each(|(sum, c)| *sum += c.abs());
    }
    let sum = rest.iter().fold(sums.iter().sum::<f64>(), |sum, c| sum + c.abs());
    inflated(sum, chunks.len() + 2 * PARTIAL_SUMS)
}

/// Number of stored norms. The last one holds for all degrees from 31 on, so models of a higher
/// order have valid but wider remainders.
const DEGREES: usize = 32;

/// Upper bounds of Σ |c| over the terms of each degree. Each is a bound of the sum of these terms
/// over [-1, 1]^k.
pub(super) struct Norms {
    by_degree: [f64; DEGREES],
    /// Number of leading entries that can differ from zero.
    len: usize,
    /// Number of stored coefficients of the polynomial.
    pub terms: usize,
}

impl Norms {
    /// Computes the norms of a polynomial.
    pub(super) fn new(p: &TaylorPolynomial<f64>) -> Self {
        let mut norms = Self { by_degree: [0.0; DEGREES], len: 1, terms: 1 };
        match &p.form {
            Form::Constant(c) => norms.by_degree[0] = c.abs(),
            Form::Sparse(space, terms) => {
                for (m, c) in terms.iter() {
                    norms.add(space.packing.degree(*m), c.abs());
                }
                norms.terms = terms.len();
                let sums = norms.by_degree[..norms.len].iter_mut();
                sums.for_each(|n| *n = inflated(*n, terms.len().saturating_sub(1)));
            }
            Form::Dense(space, coefficients) => {
                for degree in space.stored_degrees(coefficients.len()) {
                    norms.add(degree, sum_of_magnitudes(&coefficients[space.block(degree)]));
                }
                norms.terms = coefficients.len();
                norms.by_degree[DEGREES - 1] = inflated(norms.by_degree[DEGREES - 1], 256);
            }
        }
        norms
    }

    fn add(&mut self, degree: u32, norm: f64) {
        let index = (degree as usize).min(DEGREES - 1);
        self.by_degree[index] += norm;
        self.len = self.len.max(index + 1);
    }

    /// Returns Σ |c| over all terms, rounded up.
    pub(super) fn total(&self) -> f64 {
        inflated(self.by_degree[..self.len].iter().sum(), self.len - 1)
    }

    /// Returns Σ |c| over the terms of one degree, rounded up; 0 for the degrees from 31 on.
    pub(super) fn of_degree(&self, degree: u32) -> f64 {
        self.by_degree[..DEGREES - 1].get(degree as usize).copied().unwrap_or(0.0)
    }

    /// Bounds the terms of the product whose degree is above `order`.
    ///
    /// It excludes products of two terms of degree `except` if [`of_degree`](Self::of_degree)
    /// returns their norm.
    pub(super) fn truncation(&self, other: &Self, order: u32, except: u32) -> f64 {
        let (order, last) = (order as usize, DEGREES - 1);
        let except = if except as usize == last { usize::MAX } else { except as usize };
        let (mut sum, mut is_any) = (0.0, false);
        for (i, a) in self.by_degree[..self.len].iter().enumerate() {
            // The last norm also covers higher degrees. It counts where one of them is truncated.
            let first = if i == last && order > last { 0 } else { (order + 1).saturating_sub(i) };
            for (j, b) in other.by_degree[..other.len].iter().enumerate() {
                let is_truncated = j >= first || j == last && order > last;
                if is_truncated && !(i == except && j == except) {
                    sum += a * b;
                    is_any |= *a > 0.0 && *b > 0.0;
                }
            }
        }
        if is_any { inflated(sum, DEGREES * DEGREES) + f64::MIN_POSITIVE } else { 0.0 }
    }
}

/// Sums of |c| over the non-constant terms of a polynomial.
#[derive(Default)]
struct MagnitudeSums {
    /// Over all terms.
    all: f64,
    /// Over the terms with even exponents and c < 0.
    even_negative: f64,
    /// Over the terms with even exponents and c > 0.
    even_positive: f64,
    /// Upper bound of the number of summands of each sum.
    count: usize,
}

impl MagnitudeSums {
    fn add_even(&mut self, c: f64) {
        if c < 0.0 {
            self.even_negative -= c;
        } else {
            self.even_positive += c;
        }
    }

    /// Encloses the sum of the terms. A term with even exponents has the sign of its coefficient.
    fn range(&self) -> Interval {
        let additions = self.count.saturating_sub(1);
        let all = Interval::point(inflated(self.all, additions));
        let above = all - deflated(self.even_negative, additions);
        let below = all - deflated(self.even_positive, additions);
        Interval::new(-below.hi(), above.hi()).unwrap_or(Interval::ENTIRE)
    }
}

/// Encloses the range of the polynomial over [-1, 1]^k.
pub(super) fn range(p: &TaylorPolynomial<f64>) -> Interval {
    let sums = match &p.form {
        Form::Constant(c) => return Interval::point(*c),
        Form::Sparse(space, terms) => sparse_sums(space, terms),
        Form::Dense(space, coefficients) => dense_sums(space, coefficients),
    };
    if sums.all < OVERFLOW_GUARD {
        Interval::point(p.constant_term()) + sums.range()
    } else {
        Interval::ENTIRE
    }
}

fn sparse_sums(space: &TaylorSpace, terms: &[(u128, f64)]) -> MagnitudeSums {
    let mut sums = MagnitudeSums::default();
    let odd = space.packing.odd_exponents;
    for (m, c) in terms.iter().filter(|(m, _)| *m != 0) {
        sums.all += c.abs();
        sums.count += 1;
        if m & odd == 0 {
            sums.add_even(*c);
        }
    }
    sums
}

fn dense_sums(space: &TaylorSpace, coefficients: &[f64]) -> MagnitudeSums {
    let mut sums = MagnitudeSums::default();
    for degree in space.stored_degrees(coefficients.len()).skip(1) {
        let block = &coefficients[space.block(degree)];
        sums.all += sum_of_magnitudes(block);
        sums.count += 1;
        if degree % 2 == 0 {
            // Monomials with even exponents are squares, the diagonal of the product table.
            let size = space.block(degree / 2).len();
            sums.count += size;
            let squares = space.product_table(degree / 2, degree / 2).iter().step_by(size + 1);
            squares.for_each(|at| sums.add_even(block[*at as usize]));
        }
    }
    sums
}
