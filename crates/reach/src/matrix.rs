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

/// The points of `values`.
pub(crate) fn points(values: &[f64]) -> Vec<Interval> {
    values.iter().map(|&x| Interval::point(x)).collect()
}

/// Midpoints, entry by entry.
pub(crate) fn midpoint(matrix: &IntervalMatrix) -> DMatrix<f64> {
    matrix.map(|x| x.mid())
}

/// Radii about the midpoints, entry by entry.
pub(crate) fn radius(matrix: &IntervalMatrix) -> DMatrix<f64> {
    matrix.map(|x| x.rad())
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

/// `left` times `right`. Half of a robot's matrices is zero and stays zero, at no cost.
///
/// # Guarantee
///
/// Outer, directed rounding; an entry all of whose terms are zero is the point 0.
pub(crate) fn product(left: &IntervalMatrix, right: &IntervalMatrix) -> IntervalMatrix {
    let (rows, columns) = (left.nrows(), right.ncols());
    let mut product = IntervalMatrix::from_element(rows, columns, Interval::ZERO);
    for j in 0..columns {
        let sum = &mut product.as_mut_slice()[j * rows..(j + 1) * rows];
        add_product(sum, left, right.column(j).iter());
    }
    product
}

/// `sum += matrix vector`, outer as [`product`].
pub(crate) fn add_product<'a>(
    sum: &mut [Interval],
    matrix: &IntervalMatrix,
    vector: impl IntoIterator<Item = &'a Interval>,
) {
    let rows = matrix.nrows();
    for (j, &y) in vector.into_iter().enumerate().filter(|(_, y)| **y != Interval::ZERO) {
        let column = &matrix.as_slice()[j * rows..(j + 1) * rows];
        for (sum, &x) in sum.iter_mut().zip(column) {
            if x != Interval::ZERO {
                *sum += x * y;
            }
        }
    }
}

/// Σ x_i y_i, outer as [`product`].
pub(crate) fn dot<'a>(
    left: impl IntoIterator<Item = &'a Interval>,
    right: impl IntoIterator<Item = &'a Interval>,
) -> Interval {
    let terms = left.into_iter().zip(right).filter(|(x, y)| **x != Interval::ZERO && **y != Interval::ZERO);
    terms.fold(Interval::ZERO, |sum, (&x, &y)| sum + x * y)
}

/// An upper bound of the product of two matrices with entries >= 0, rounded upward.
pub(crate) fn mul_upward(left: &DMatrix<f64>, right: &DMatrix<f64>) -> DMatrix<f64> {
    let rows = left.nrows();
    let mut product = DMatrix::zeros(rows, right.ncols());
    for j in 0..right.ncols() {
        let sum = &mut product.as_mut_slice()[j * rows..(j + 1) * rows];
        for (k, &y) in right.column(j).iter().enumerate().filter(|(_, y)| **y != 0.0) {
            for (sum, &x) in sum.iter_mut().zip(&left.as_slice()[k * rows..(k + 1) * rows]) {
                *sum = add_up(*sum, mul_up(x, y));
            }
        }
    }
    product
}

/// `sum += term` for entries >= 0, rounded upward.
pub(crate) fn accumulate_upward(sum: &mut DMatrix<f64>, term: &DMatrix<f64>) {
    sum.zip_apply(term, |s, t| *s = add_up(*s, t));
}
