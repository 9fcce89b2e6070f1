//! Floating-point sums of many columns of intervals, with a bound of their rounding error.

use rayon::prelude::*;
use reachtube_scalar::Interval;

use crate::sets::interval_matrix::IntervalMatrix;
use crate::upward::{UNDERFLOW, relative_error};

/// Encloses the running sum Σ_{j<k} term(j) at each of `samples` samples k.
///
/// `term(j)` iterates over the lower and upper ends of a matrix of `rows` x `columns` entries,
/// column by column.
///
/// # Guarantee
///
/// Outer.
pub(crate) fn running_sum<I: Iterator<Item = (f64, f64)>>(
    (rows, columns): (usize, usize),
    samples: usize,
    term: impl Fn(usize) -> I + Sync,
) -> Vec<IntervalMatrix> {
    let length = samples.isqrt().max(1);
    let add = |mut sums: ColumnSums, k: usize| {
        sums.add(&[1.0], |_| term(k));
        sums
    };
    // Total of each block of about √samples terms, in parallel.
    let total = |block: usize| {
        (block * length..(block + 1) * length).fold(ColumnSums::new(rows * columns), add)
    };
    let whole = samples.saturating_sub(1) / length;
    let totals: Vec<ColumnSums> = (0..whole).into_par_iter().map(total).collect();
    // Sum of all blocks before each block.
    let mut before = vec![ColumnSums::new(rows * columns)];
    for (block, total) in totals.iter().enumerate() {
        before.push(before[block].plus(total));
    }
    // Running sum inside each block, in parallel.
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

/// Floating-point sums of interval columns times numbers, with a bound of their rounding error.
///
/// A sum all of whose terms are zero is 0. The error of n terms is at most n u / (1 - n u) times
/// the sum of their magnitudes (Higham, Accuracy and Stability of Numerical Algorithms, section
/// 3.1), plus the loss by underflow.
#[derive(Clone)]
pub(crate) struct ColumnSums {
    terms: usize,
    lo: Vec<f64>,
    hi: Vec<f64>,
    /// Sums of the absolute values of the terms.
    magnitude: Vec<f64>,
}

impl ColumnSums {
    pub(crate) fn new(rows: usize) -> Self {
        let zero = vec![0.0; rows];
        Self { terms: 0, lo: zero.clone(), hi: zero.clone(), magnitude: zero }
    }

    pub(crate) fn clear(&mut self) {
        self.terms = 0;
        for sums in [&mut self.lo, &mut self.hi, &mut self.magnitude] {
            sums.fill(0.0);
        }
    }

    /// Adds a matrix times `vector`; `ends(j)` iterates over the lower and upper ends of column j.
    pub(crate) fn add<I: Iterator<Item = (f64, f64)>>(
        &mut self,
        vector: &[f64],
        ends: impl Fn(usize) -> I,
    ) {
        for (j, &y) in vector.iter().enumerate().filter(|(_, y)| **y != 0.0) {
            self.terms += 1;
            let (first, second) =
                if y < 0.0 { (&mut self.hi, &mut self.lo) } else { (&mut self.lo, &mut self.hi) };
            for (((first, second), magnitude), (lo, hi)) in
                first.iter_mut().zip(second).zip(&mut self.magnitude).zip(ends(j))
            {
                let mag = larger(lo.abs(), hi.abs());
                *first += lo * y;
                *second += hi * y;
                *magnitude += mag * y.abs() + if mag > 0.0 { f64::MIN_POSITIVE } else { 0.0 };
            }
        }
    }

    /// Returns the sums of the terms of both.
    fn plus(&self, other: &Self) -> Self {
        let add = |own: &[f64], other: &[f64]| own.iter().zip(other).map(|(x, y)| x + y).collect();
        Self {
            terms: self.terms + other.terms,
            lo: add(&self.lo, &other.lo),
            hi: add(&self.hi, &other.hi),
            magnitude: add(&self.magnitude, &other.magnitude),
        }
    }

    /// Encloses the sums.
    ///
    /// # Guarantee
    ///
    /// Outer.
    pub(crate) fn enclosed(&self) -> impl Iterator<Item = Interval> {
        // One more unit covers the rounding of the two ends.
        let relative = relative_error(self.terms + 1);
        self.lo.iter().zip(&self.hi).zip(&self.magnitude).map(move |((&lo, &hi), &magnitude)| {
            let error = if magnitude == 0.0 { 0.0 } else { relative * magnitude + UNDERFLOW };
            Interval::new(lo - error, hi + error).unwrap_or(Interval::ENTIRE)
        })
    }
}

/// Iterates over the lower and upper end of each interval.
pub(crate) fn ends(intervals: &[Interval]) -> impl Iterator<Item = (f64, f64)> {
    intervals.iter().map(|x| (x.lo(), x.hi()))
}

/// Iterates over the lower and upper ends of column j.
pub(crate) fn column_ends(matrix: &IntervalMatrix, j: usize) -> impl Iterator<Item = (f64, f64)> {
    let rows = matrix.nrows();
    ends(&matrix.as_slice()[j * rows..(j + 1) * rows])
}

/// Returns the ends of the absolute values of the numbers from `lo` to `hi`.
pub(crate) fn absolute_ends((lo, hi): (f64, f64)) -> (f64, f64) {
    (larger(larger(lo, -hi), 0.0), larger(lo.abs(), hi.abs()))
}

/// Returns the larger number in one instruction; unlike `f64::max`, it ignores NaN semantics.
pub(crate) fn larger(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}
