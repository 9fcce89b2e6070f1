//! Interval vectors and matrices: the types of nalgebra over [`Interval`].

use nalgebra::{DMatrix, DVector};
use reachtube_scalar::Interval;

/// A matrix of intervals; its products and sums are nalgebra's with outward rounding.
pub type IntervalMatrix = DMatrix<Interval>;

/// A vector of intervals.
pub type IntervalVector = DVector<Interval>;

/// Converts each entry to a point interval.
pub(crate) fn point(matrix: &DMatrix<f64>) -> IntervalMatrix {
    matrix.map(Interval::point)
}

/// Converts each value to a point interval.
pub(crate) fn points(values: &[f64]) -> Vec<Interval> {
    values.iter().map(|&x| Interval::point(x)).collect()
}

pub(crate) fn midpoint(matrix: &IntervalMatrix) -> DMatrix<f64> {
    matrix.map(|x| x.mid())
}

/// Returns the largest absolute value of each entry.
pub(crate) fn magnitude(matrix: &IntervalMatrix) -> DMatrix<f64> {
    matrix.map(|x| x.mag())
}

/// Returns the range of absolute values of each entry.
pub(crate) fn absolute(matrix: &IntervalMatrix) -> IntervalMatrix {
    matrix.map(|x| x.abs())
}

/// Returns the matrix of intervals `mid ± rad`.
///
/// # Guarantee
///
/// Outer: each entry contains both ends as real numbers.
pub(crate) fn ball(mid: &DMatrix<f64>, rad: &DMatrix<f64>) -> IntervalMatrix {
    mid.zip_map(rad, Interval::centred)
}

/// Multiplies `left` by `right` and skips zero entries, which are about half of a robot's matrices.
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

/// Adds `matrix` times `vector` to `sum`; outer as [`product`].
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

/// Computes Σ x_i y_i; outer as [`product`].
pub(crate) fn dot<'a>(
    left: impl IntoIterator<Item = &'a Interval>,
    right: impl IntoIterator<Item = &'a Interval>,
) -> Interval {
    let terms =
        left.into_iter().zip(right).filter(|(x, y)| **x != Interval::ZERO && **y != Interval::ZERO);
    terms.fold(Interval::ZERO, |sum, (&x, &y)| sum + x * y)
}

#[cfg(test)]
mod tests {
    use nalgebra::dmatrix;

    use super::*;

    fn sample() -> (IntervalMatrix, IntervalMatrix) {
        let left = dmatrix![0.1, 0.0, -3.0; 0.0, 7.0, 1e-200];
        let right = dmatrix![0.3, 0.0; -0.7, 0.0; 1e-200, 2.5];
        (point(&left), ball(&right, &right.map(|x: f64| x.abs() * 1e-3)))
    }

    #[test]
    fn products_are_those_of_nalgebra_and_keep_zeros() {
        let (left, right) = sample();
        let (ours, plain) = (product(&left, &right), &left * &right);
        assert!(
            ours.iter().zip(&plain).all(|(x, y)| x.hull(*y).width() <= x.width() * (1.0 + 1e-9))
        );
        assert_eq!(
            product(&point(&dmatrix![1.0, 0.0]), &point(&dmatrix![0.0; 5.0]))[(0, 0)],
            Interval::ZERO
        );
        let row = left.row(0);
        assert_eq!(dot(row.iter(), right.column(1).iter()), ours[(0, 1)]);
    }
}
