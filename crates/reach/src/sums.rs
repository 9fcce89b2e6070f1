//! Sums of many terms in floating point, with a bound of their error.

use rayon::prelude::*;
use reachtube_scalar::Interval;

use crate::LinearSystem;
use crate::matrix::{IntervalMatrix, UNDERFLOW, relative_error};

/// At so many samples, the sum of the terms before each, one a step and of the shape of B, of which
/// `term(k)` are the lower and upper ends, column by column.
///
/// # Guarantee
///
/// Outer.
pub(crate) fn running_sum<I: Iterator<Item = (f64, f64)>>(
    system: &LinearSystem,
    samples: usize,
    term: impl Fn(usize) -> I + Sync,
) -> Vec<IntervalMatrix> {
    let (rows, columns) = (system.states(), system.inputs());
    let length = samples.isqrt().max(1);
    let add = |mut sums: ColumnSums, k: usize| {
        sums.add(&[1.0], |_| term(k));
        sums
    };
    let total = |block: usize| {
        (block * length..(block + 1) * length).fold(ColumnSums::new(rows * columns), add)
    };
    let whole = samples.saturating_sub(1) / length;
    let totals: Vec<ColumnSums> = (0..whole).into_par_iter().map(total).collect();
    let mut before = vec![ColumnSums::new(rows * columns)];
    for (block, total) in totals.iter().enumerate() {
        before.push(before[block].plus(total));
    }
    let block = |(block, mut sums): (usize, ColumnSums)| {
        let (start, term) = (block * length, &term);
        (start..samples.min(start + length)).map(move |k| {
            if k > start {
                sums.add(&[1.0], |_| term(k - 1));
            }
            IntervalMatrix::from_iterator(rows, columns, sums.enclosed())
        })
    };
    before.into_par_iter().enumerate().flat_map_iter(block).collect()
}

/// Sums of columns of intervals times numbers, in floating point, with a bound of their error. A
/// sum all of whose terms are zero is 0.
///
/// The error of n terms is at most n u / (1 - n u) times the sum of their sizes (Higham, Accuracy
/// and Stability of Numerical Algorithms, section 3.1), and what underflows.
#[derive(Clone)]
pub(crate) struct ColumnSums {
    terms: usize,
    lo: Vec<f64>,
    hi: Vec<f64>,
    /// Of the absolute values of the terms.
    size: Vec<f64>,
}

impl ColumnSums {
    pub(crate) fn new(rows: usize) -> Self {
        let zero = vec![0.0; rows];
        Self { terms: 0, lo: zero.clone(), hi: zero.clone(), size: zero }
    }

    pub(crate) fn clear(&mut self) {
        self.terms = 0;
        for sums in [&mut self.lo, &mut self.hi, &mut self.size] {
            sums.fill(0.0);
        }
    }

    /// Adds the `vector` times a matrix, of which `ends(j)` are the lower and upper ends of column
    /// j.
    pub(crate) fn add<I: Iterator<Item = (f64, f64)>>(
        &mut self,
        vector: &[f64],
        ends: impl Fn(usize) -> I,
    ) {
        for (j, &y) in vector.iter().enumerate().filter(|(_, y)| **y != 0.0) {
            self.terms += 1;
            let (first, second) =
                if y < 0.0 { (&mut self.hi, &mut self.lo) } else { (&mut self.lo, &mut self.hi) };
            for (((first, second), size), (lo, hi)) in
                first.iter_mut().zip(second).zip(&mut self.size).zip(ends(j))
            {
                let mag = larger(lo.abs(), hi.abs());
                *first += lo * y;
                *second += hi * y;
                *size += mag * y.abs() + if mag > 0.0 { f64::MIN_POSITIVE } else { 0.0 };
            }
        }
    }

    /// These terms and those of `other`.
    fn plus(&self, other: &Self) -> Self {
        let add = |own: &[f64], other: &[f64]| own.iter().zip(other).map(|(x, y)| x + y).collect();
        Self {
            terms: self.terms + other.terms,
            lo: add(&self.lo, &other.lo),
            hi: add(&self.hi, &other.hi),
            size: add(&self.size, &other.size),
        }
    }

    /// The sums.
    ///
    /// # Guarantee
    ///
    /// Outer.
    pub(crate) fn enclosed(&self) -> impl Iterator<Item = Interval> {
        // One unit more for the rounding of the two ends.
        let relative = relative_error(self.terms + 1);
        self.lo.iter().zip(&self.hi).zip(&self.size).map(move |((&lo, &hi), &size)| {
            let error = if size == 0.0 { 0.0 } else { relative * size + UNDERFLOW };
            Interval::new(lo - error, hi + error).unwrap_or(Interval::ENTIRE)
        })
    }
}

/// The lower and upper end of each.
pub(crate) fn ends(intervals: &[Interval]) -> impl Iterator<Item = (f64, f64)> {
    intervals.iter().map(|x| (x.lo(), x.hi()))
}

/// The lower and upper ends of column j.
pub(crate) fn column_ends(matrix: &IntervalMatrix, j: usize) -> impl Iterator<Item = (f64, f64)> {
    let rows = matrix.nrows();
    ends(&matrix.as_slice()[j * rows..(j + 1) * rows])
}

/// The ends of the absolute values of the numbers from `lo` to `hi`.
pub(crate) fn absolute_ends((lo, hi): (f64, f64)) -> (f64, f64) {
    (larger(larger(lo, -hi), 0.0), larger(lo.abs(), hi.abs()))
}

/// `f64::max` without its care for NaN: one instruction.
pub(crate) fn larger(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}
