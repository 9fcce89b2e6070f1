//! Interval vectors and matrices: nalgebra's, over [`Interval`].

use nalgebra::{DMatrix, DVector};
use reachtube_scalar::Interval;
use reachtube_scalar::rounding::{add_up, mul_up};

/// A matrix of intervals; products and sums are those of nalgebra, evaluated with outward rounding.
pub type IntervalMatrix = DMatrix<Interval>;

/// A vector of intervals.
pub type IntervalVector = DVector<Interval>;

/// The matrix whose entries are the points of `matrix`.
pub(crate) fn point(matrix: &DMatrix<f64>) -> IntervalMatrix {
    matrix.map(Interval::point)
}

/// Midpoints, entry by entry.
pub(crate) fn midpoint(matrix: &IntervalMatrix) -> DMatrix<f64> {
    matrix.map(|x| x.mid())
}

/// Largest absolute values, entry by entry.
pub(crate) fn magnitude(matrix: &IntervalMatrix) -> DMatrix<f64> {
    matrix.map(|x| x.mag())
}

/// Absolute values, entry by entry.
pub(crate) fn absolute(matrix: &IntervalMatrix) -> IntervalMatrix {
    matrix.map(|x| x.abs())
}

/// The matrix of intervals `mid ± rad`.
///
/// # Guarantee
///
/// Outer: each entry contains both ends as real numbers.
pub(crate) fn ball(mid: &DMatrix<f64>, rad: &DMatrix<f64>) -> IntervalMatrix {
    mid.zip_map(rad, Interval::centered)
}

/// An upper bound of the product of two matrices with entries >= 0, rounded upward.
pub(crate) fn mul_upward(left: &DMatrix<f64>, right: &DMatrix<f64>) -> DMatrix<f64> {
    DMatrix::from_fn(left.nrows(), right.ncols(), |i, j| {
        (0..left.ncols()).fold(0.0, |sum, k| {
            let (x, y) = (left[(i, k)], right[(k, j)]);
            if x == 0.0 || y == 0.0 { sum } else { add_up(sum, mul_up(x, y)) }
        })
    })
}

/// `sum += term` for entries >= 0, rounded upward.
pub(crate) fn accumulate_upward(sum: &mut DMatrix<f64>, term: &DMatrix<f64>) {
    sum.zip_apply(term, |s, t| {
        if t != 0.0 {
            *s = add_up(*s, t);
        }
    });
}
