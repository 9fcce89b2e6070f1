//! Bounds of polynomials over [-1, 1]^k, where a monomial is at most 1 in magnitude and one with
//! even exponents lies in [0, 1].

use crate::taylor::Form;
use crate::{Interval, TaylorPolynomial, TaylorSpace};

/// A bound of the exact value of a sum of non-negative numbers and products of two that was
/// computed as x, in which no number went through more than `operations` roundings.
///
/// Each rounding takes a factor 1/(1 - u) at most, u = ε/2; k of them less than 1 + 2ku for ku <
/// 1/2. The two more of ε each cover this product's own rounding. Underflow costs less than 2⁻¹⁰⁷⁵
/// a product, of which [`f64::MIN_POSITIVE`] covers 2⁵².
pub(super) fn inflated(x: f64, operations: usize) -> f64 {
    if operations == 0 { x } else { x * (1.0 + (operations + 2) as f64 * f64::EPSILON) }
}

/// A lower bound likewise, of a sum without products.
fn deflated(x: f64, operations: usize) -> f64 {
    if operations == 0 { x } else { x * (1.0 - (operations + 2) as f64 * f64::EPSILON) }
}

/// No sum of magnitudes, nor of products of which it is a bound, overflows below it.
pub(super) const LARGEST: f64 = 1e300;

/// So many sums are formed side by side.
pub(super) const LANES: usize = 8;

/// Σ |c|, rounded up.
pub(super) fn magnitude(c: &[f64]) -> f64 {
    let (chunks, rest) = c.as_chunks::<LANES>();
    let mut sums = [0.0; LANES];
    for chunk in chunks {
        sums.iter_mut().zip(chunk).for_each(|(sum, c)| *sum += c.abs());
    }
    let sum = rest.iter().fold(sums.iter().sum::<f64>(), |sum, c| sum + c.abs());
    inflated(sum, chunks.len() + 2 * LANES)
}

/// Norms of the degrees from 31 on are kept together: models of a higher order have wider
/// remainders than they need.
const DEGREES: usize = 32;

/// Upper bounds of Σ |c| over the terms of each degree, which bounds the sum of these terms over
/// [-1, 1]^k.
pub(super) struct Norms {
    of_degree: [f64; DEGREES],
    /// So many are not zero by storage.
    len: usize,
    /// Number of stored coefficients.
    pub terms: usize,
}

impl Norms {
    pub fn new(p: &TaylorPolynomial<f64>) -> Self {
        let mut norms = Self { of_degree: [0.0; DEGREES], len: 1, terms: 1 };
        match &p.form {
            Form::Constant(c) => norms.of_degree[0] = c.abs(),
            Form::Sparse(space, terms) => {
                for (m, c) in terms.iter() {
                    norms.add(space.packing.degree(*m), c.abs());
                }
                norms.terms = terms.len();
                let sums = norms.of_degree[..norms.len].iter_mut();
                sums.for_each(|n| *n = inflated(*n, terms.len().saturating_sub(1)));
            }
            Form::Dense(space, coefficients) => {
                for degree in space.stored_degrees(coefficients.len()) {
                    norms.add(degree, magnitude(&coefficients[space.block(degree)]));
                }
                norms.terms = coefficients.len();
                norms.of_degree[DEGREES - 1] = inflated(norms.of_degree[DEGREES - 1], 256);
            }
        }
        norms
    }

    fn add(&mut self, degree: u32, norm: f64) {
        let place = (degree as usize).min(DEGREES - 1);
        self.of_degree[place] += norm;
        self.len = self.len.max(place + 1);
    }

    /// Σ |c|, rounded up.
    pub fn total(&self) -> f64 {
        inflated(self.of_degree[..self.len].iter().sum(), self.len - 1)
    }

    /// Σ |c| over the terms of one degree, rounded up; 0 for degrees that are kept together.
    pub fn of(&self, degree: u32) -> f64 {
        self.of_degree[..DEGREES - 1].get(degree as usize).copied().unwrap_or(0.0)
    }

    /// Bounds the terms of the product of degree above `order`, but for products of two terms of
    /// degree `except` whose norm [`of`](Self::of) tells.
    pub fn cut_off(&self, other: &Self, order: u32, except: u32) -> f64 {
        let (order, last) = (order as usize, DEGREES - 1);
        let except = if except as usize == last { usize::MAX } else { except as usize };
        let (mut sum, mut is_any) = (0.0, false);
        for (i, a) in self.of_degree[..self.len].iter().enumerate() {
            // The last norm is that of all higher degrees: cut off where one of them may be.
            let first = if i == last && order > last { 0 } else { (order + 1).saturating_sub(i) };
            for (j, b) in other.of_degree[..other.len].iter().enumerate() {
                let is_cut = j >= first || j == last && order > last;
                if is_cut && !(i == except && j == except) {
                    sum += a * b;
                    is_any |= *a > 0.0 && *b > 0.0;
                }
            }
        }
        if is_any { inflated(sum, DEGREES * DEGREES) + f64::MIN_POSITIVE } else { 0.0 }
    }
}

/// Sums over the terms of a polynomial but the constant: |c|, and |c| < 0 and c > 0 where all
/// exponents are even.
#[derive(Default)]
struct Parts {
    all: f64,
    even_negative: f64,
    even_positive: f64,
    /// Numbers summed.
    count: usize,
}

impl Parts {
    fn add_even(&mut self, c: f64) {
        if c < 0.0 {
            self.even_negative -= c;
        } else {
            self.even_positive += c;
        }
    }

    /// Terms with even exponents go one way only.
    fn range(&self) -> Interval {
        let additions = self.count.saturating_sub(1);
        let all = Interval::point(inflated(self.all, additions));
        let above = all - deflated(self.even_negative, additions);
        let below = all - deflated(self.even_positive, additions);
        Interval::new(-below.hi(), above.hi()).unwrap_or(Interval::ENTIRE)
    }
}

/// An outer bound of the polynomial over [-1, 1]^k.
pub(super) fn range(p: &TaylorPolynomial<f64>) -> Interval {
    let parts = match &p.form {
        Form::Constant(c) => return Interval::point(*c),
        Form::Sparse(space, terms) => sparse_parts(space, terms),
        Form::Dense(space, coefficients) => dense_parts(space, coefficients),
    };
    if parts.all < LARGEST {
        Interval::point(p.constant_term()) + parts.range()
    } else {
        Interval::ENTIRE
    }
}

fn sparse_parts(space: &TaylorSpace, terms: &[(u128, f64)]) -> Parts {
    let mut parts = Parts::default();
    let odd = space.packing.odd_exponents;
    for (m, c) in terms.iter().filter(|(m, _)| *m != 0) {
        parts.all += c.abs();
        parts.count += 1;
        if m & odd == 0 {
            parts.add_even(*c);
        }
    }
    parts
}

fn dense_parts(space: &TaylorSpace, coefficients: &[f64]) -> Parts {
    let mut parts = Parts::default();
    for degree in space.stored_degrees(coefficients.len()).skip(1) {
        let block = &coefficients[space.block(degree)];
        parts.all += magnitude(block);
        parts.count += 1;
        if degree % 2 == 0 {
            // Monomials with even exponents are squares: the diagonal of the table of products.
            let size = space.block(degree / 2).len();
            parts.count += size;
            let squares = space.table(degree / 2, degree / 2).iter().step_by(size + 1);
            squares.for_each(|at| parts.add_even(block[*at as usize]));
        }
    }
    parts
}
