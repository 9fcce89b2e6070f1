//! Dense series: all coefficients in blocks of one degree each, and the product kernel.

use core::array::from_fn;

use super::addition::{Addition, negated_if};
use super::space::TaylorSpace;
use super::sparse::Term;
use crate::dispatch::Kernel;
use crate::scalar::Scalar;

/// The coefficients of a dense series and a record of its zero blocks.
pub(super) struct DenseSeries<'a, C> {
    space: &'a TaylorSpace,
    coefficients: &'a [C],
    /// Bit d is set where the block of degree d is known to be zero.
    zero_blocks: [u64; 4],
}

impl<'a, C: Scalar> DenseSeries<'a, C> {
    /// Wraps the coefficients and finds the zero blocks.
    pub(super) fn new(space: &'a TaylorSpace, coefficients: &'a [C]) -> Self {
        let mut series = Self::full(space, coefficients);
        for degree in 0..=degree(space, coefficients.len()) {
            if coefficients[space.block(degree)].iter().all(C::is_zero) {
                series.zero_blocks[degree as usize / 64] |= 1 << (degree % 64);
            }
        }
        series
    }

    /// Wraps the coefficients without a search for zero blocks.
    pub(super) fn full(space: &'a TaylorSpace, coefficients: &'a [C]) -> Self {
        Self { space, coefficients, zero_blocks: [0; 4] }
    }

    /// Returns the block of one degree. It is empty if the block is known to be zero or lies above
    /// the last stored degree.
    #[inline(always)]
    pub(super) fn block(&self, degree: u32) -> &'a [C] {
        let known_zero = self.zero_blocks[degree as usize / 64] >> (degree % 64) & 1 == 1;
        let block = self.space.block(degree);
        if known_zero || block.end > self.coefficients.len() {
            &[]
        } else {
            &self.coefficients[block]
        }
    }

    fn degree(&self) -> u32 {
        degree(self.space, self.coefficients.len())
    }
}

pub(super) fn degree(space: &TaylorSpace, len: usize) -> u32 {
    (0..=space.order()).find(|d| space.block(*d).end == len).expect("whole blocks are stored")
}

/// Returns x y, truncated at the order of the space.
pub(super) fn product<C: Scalar>(space: &TaylorSpace, x: &[C], y: &[C]) -> Vec<C> {
    let (x, y) = (DenseSeries::new(space, x), DenseSeries::new(space, y));
    let high = (x.degree() + y.degree()).min(space.order());
    let mut out = vec![C::zero(); space.dense_len(high)];
    C::dispatch(Product { space, x: &x, y: &y, out: &mut out });
    out
}

/// A product of two dense series, to be added to `out`.
struct Product<'a, C> {
    space: &'a TaylorSpace,
    x: &'a DenseSeries<'a, C>,
    y: &'a DenseSeries<'a, C>,
    out: &'a mut [C],
}

impl<C: Scalar> Kernel for Product<'_, C> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Self { space, x, y, out } = self;
        let high = degree(space, out.len());
        for degree in 0..=high {
            let block = &mut out[space.block(degree)];
            if let [x0] = x.block(0) {
                add_scaled(block, x0, y.block(degree));
            }
            if let ([y0], 1..) = (y.block(0), degree) {
                add_scaled(block, y0, x.block(degree));
            }
            inner_products(space, degree, x, y, block);
        }
    }
}

/// Adds Σ x_i y_{d-i} over 0 < i < d to `out`, the block of degree d; x_i is the part of x of
/// degree i.
pub(super) fn add_inner_products<C: Scalar>(
    space: &TaylorSpace,
    d: u32,
    x: &DenseSeries<C>,
    y: &DenseSeries<C>,
    out: &mut [C],
) {
    C::dispatch(InnerProducts { space, d, x, y, out });
}

/// The arguments of [`add_inner_products`].
struct InnerProducts<'a, C> {
    space: &'a TaylorSpace,
    d: u32,
    x: &'a DenseSeries<'a, C>,
    y: &'a DenseSeries<'a, C>,
    out: &'a mut [C],
}

impl<C: Scalar> Kernel for InnerProducts<'_, C> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        inner_products(self.space, self.d, self.x, self.y, self.out);
    }
}

/// Adds the products as [`add_inner_products`] does, within a kernel.
#[inline(always)]
fn inner_products<C: Scalar>(
    space: &TaylorSpace,
    d: u32,
    x: &DenseSeries<C>,
    y: &DenseSeries<C>,
    out: &mut [C],
) {
    for i in 1..=d / 2 {
        let j = d - i;
        if i == j {
            add_equal_degrees(space.product_table(i, i), x.block(i), y.block(i), out);
        } else {
            add_mixed_degrees(
                space.product_table(i, j),
                [x.block(i), x.block(j)],
                [y.block(i), y.block(j)],
                out,
            );
        }
    }
}

/// Adds x_i y_j + y_i x_j to `out`; one entry of the product table serves both products.
#[inline(always)]
fn add_mixed_degrees<C: Scalar>(
    table: &[u32],
    [xi, xj]: [&[C]; 2],
    [yi, yj]: [&[C]; 2],
    out: &mut [C],
) {
    match (xi.is_empty() || yj.is_empty(), yi.is_empty() || xj.is_empty()) {
        (true, true) => {}
        (false, true) => {
            nonzero_rows(table, yj.len(), xi).for_each(|(row, p)| add_row(row, p, yj, out));
        }
        (true, false) => {
            nonzero_rows(table, xj.len(), yi).for_each(|(row, q)| add_row(row, q, xj, out));
        }
        (false, false) => {
            for ((row, p), q) in table.chunks_exact(xj.len()).zip(xi).zip(yi) {
                match (p.is_zero(), q.is_zero()) {
                    (true, true) => {}
                    (false, true) => add_row(row, p, yj, out),
                    (true, false) => add_row(row, q, xj, out),
                    (false, false) => add_two_rows(row, [p, q], [yj, xj], out),
                }
            }
        }
    }
}

/// Iterates over the rows of a product table with their non-zero factors.
#[inline(always)]
fn nonzero_rows<'a, C: Scalar>(
    table: &'a [u32],
    width: usize,
    factors: &'a [C],
) -> impl Iterator<Item = (&'a [u32], &'a C)> {
    table.chunks_exact(width).zip(factors).filter(|(_, factor)| !factor.is_zero())
}

/// Adds x_i y_i to `out` for two blocks of one degree i.
#[inline(always)]
fn add_equal_degrees<C: Scalar>(table: &[u32], x: &[C], y: &[C], out: &mut [C]) {
    if x.is_empty() || y.is_empty() {
        return;
    }
    for (a, row) in table.chunks_exact(x.len()).enumerate() {
        let (p, q) = (&x[a], &y[a]);
        out[row[a] as usize] += p.clone() * q.clone();
        let (row, x, y) = (&row[a + 1..], &x[a + 1..], &y[a + 1..]);
        match (p.is_zero(), q.is_zero()) {
            (true, true) => {}
            (false, true) => add_row(row, p, y, out),
            (true, false) => add_row(row, q, x, out),
            (false, false) => add_two_rows(row, [p, q], [y, x], out),
        }
    }
}

/// Adds p y to `out` at the indices in `row`.
#[inline(always)]
fn add_row<C: Scalar>(row: &[u32], p: &C, y: &[C], out: &mut [C]) {
    for (at, y) in row.iter().zip(y) {
        out[*at as usize] += p.clone() * y.clone();
    }
}

/// Number of products computed side by side, for vector instructions.
const UNROLLED: usize = 4;

/// Adds p y + q x to `out` at the indices in `row`.
#[inline(always)]
fn add_two_rows<C: Scalar>(row: &[u32], [p, q]: [&C; 2], [y, x]: [&[C]; 2], out: &mut [C]) {
    // Coefficients of several numbers, such as intervals, fill vector instructions one by one.
    if size_of::<C>() >= 2 * size_of::<f64>() {
        for ((at, y), x) in row.iter().zip(y).zip(x) {
            out[*at as usize] += p.clone() * y.clone() + q.clone() * x.clone();
        }
    } else {
        add_two_rows_unrolled(row, [p, q], [y, x], out);
    }
}

/// Adds p y + q x to `out` like [`add_two_rows`], several products side by side.
fn add_two_rows_unrolled<C: Scalar>(
    row: &[u32],
    [p, q]: [&C; 2],
    [y, x]: [&[C]; 2],
    out: &mut [C],
) {
    let ((rows, row), (ys, y), (xs, x)) =
        (row.as_chunks::<UNROLLED>(), y.as_chunks::<UNROLLED>(), x.as_chunks::<UNROLLED>());
    for ((row, y), x) in rows.iter().zip(ys).zip(xs) {
        let sums: [C; UNROLLED] = from_fn(|i| p.clone() * y[i].clone() + q.clone() * x[i].clone());
        for (at, sum) in row.iter().zip(sums) {
            out[*at as usize] += sum;
        }
    }
    for ((at, y), x) in row.iter().zip(y).zip(x) {
        out[*at as usize] += p.clone() * y.clone() + q.clone() * x.clone();
    }
}

#[inline(always)]
pub(super) fn add_scaled<C: Scalar>(out: &mut [C], k: &C, x: &[C]) {
    out.iter_mut().zip(x).for_each(|(out, x)| *out += k.clone() * x.clone());
}

/// Returns the product of a dense series and a list of terms, truncated at the order of the space.
pub(super) fn product_with_terms<C: Scalar>(
    space: &TaylorSpace,
    terms: &[Term<C>],
    y: &[C],
) -> Vec<C> {
    let y = DenseSeries::new(space, y);
    let packing = space.packing;
    let high = terms.last().map_or(0, |(m, _)| packing.degree(*m) + y.degree()).min(space.order());
    let mut out = vec![C::zero(); space.dense_len(high)];
    let mut factors = Vec::new();
    for (monomial, c) in terms {
        let i = packing.degree(*monomial);
        packing.factors(*monomial, &mut factors);
        let a = space.index_of(&factors);
        for j in 0..=y.degree().min(high.saturating_sub(i)) {
            let (source, target) = (y.block(j), &mut out[space.block(i + j)]);
            match (source.len(), i, j) {
                (0, ..) => {}
                (_, 0, _) => add_scaled(target, c, source),
                (_, _, 0) => target[a] += c.clone() * source[0].clone(),
                (width, ..) if i <= j => {
                    add_row(&space.product_table(i, j)[a * width..][..width], c, source, target)
                }
                _ => {
                    // The table lists degree j by degree i here: its column a holds the indices.
                    let table = space.product_table(j, i);
                    let column = table[a..].iter().step_by(space.block(i).len());
                    column
                        .zip(source)
                        .for_each(|(at, y)| target[*at as usize] += c.clone() * y.clone());
                }
            }
        }
    }
    out
}

/// Lengthens a series with zeros to `len` coefficients where it is shorter.
pub(super) fn pad_with_zeros<C: Scalar>(coefficients: &mut Vec<C>, len: usize) {
    if coefficients.len() < len {
        coefficients.resize(len, C::zero());
    }
}

/// Adds terms to a dense series that is long enough for them, or subtracts them where `minus`.
pub(super) fn add_terms<C: Scalar>(
    space: &TaylorSpace,
    out: &mut [C],
    terms: &[Term<C>],
    minus: bool,
    addition: &mut impl Addition<C>,
) {
    let mut factors = Vec::new();
    for (monomial, c) in terms {
        space.packing.factors(*monomial, &mut factors);
        let at = space.block(factors.len() as u32).start + space.index_of(&factors);
        out[at] = addition.sum(&out[at], negated_if(minus, c));
    }
}

/// Iterates over the terms with non-zero coefficients, in the order of their monomials.
pub(super) fn terms<'a, C: Scalar>(
    space: &'a TaylorSpace,
    coefficients: &'a [C],
) -> impl Iterator<Item = (u128, &'a C)> {
    let of_degree = move |degree: u32| {
        let block = &coefficients[space.block(degree)];
        let monomial = move |at: usize| {
            let factors = &space.factors(degree)[at * degree as usize..][..degree as usize];
            space.packing.pack_factors(factors)
        };
        block.iter().enumerate().filter(|(_, c)| !c.is_zero()).map(move |(at, c)| (monomial(at), c))
    };
    (0..=degree(space, coefficients.len())).flat_map(of_degree)
}

/// Returns the partial derivative in variable i.
pub(super) fn derivative<C: Scalar>(space: &TaylorSpace, coefficients: &[C], i: usize) -> Vec<C> {
    let high = degree(space, coefficients.len());
    if high == 0 {
        return vec![C::zero()];
    }
    let mut out = vec![C::zero(); space.dense_len(high - 1)];
    out[0] = coefficients[space.block(1)][i].clone();
    for d in 1..high {
        let above = &coefficients[space.block(d + 1)];
        let size = space.block(d).len();
        let row = &space.product_table(1, d)[i * size..][..size];
        let factors = space.factors(d).chunks_exact(d as usize);
        for ((out, at), factors) in out[space.block(d)].iter_mut().zip(row).zip(factors) {
            let exponent = 1 + factors.iter().filter(|v| usize::from(**v) == i).count();
            *out = above[*at as usize].clone() * C::from(exponent as f64);
        }
    }
    out
}
