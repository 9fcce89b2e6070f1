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
    let terms =
        left.into_iter().zip(right).filter(|(x, y)| **x != Interval::ZERO && **y != Interval::ZERO);
    terms.fold(Interval::ZERO, |sum, (&x, &y)| sum + x * y)
}

/// An upper bound of the product of two matrices with entries >= 0; an entry all of whose terms are
/// zero is 0.
pub(crate) fn mul_upward(left: &DMatrix<f64>, right: &DMatrix<f64>) -> DMatrix<f64> {
    let mut product = left * right;
    for j in 0..product.ncols() {
        for i in 0..product.nrows() {
            let (row, column) = (left.row(i), right.column(j));
            let terms = row.iter().copied().zip(column.as_slice());
            product[(i, j)] = sum_upward(product[(i, j)], left.ncols(), terms);
        }
    }
    product
}

/// An upper bound of Σ x_i y_i with terms >= 0.
pub(crate) fn dot_upward(left: impl Iterator<Item = f64> + Clone, right: &[f64]) -> f64 {
    let terms = left.zip(right);
    sum_upward(terms.clone().map(|(x, y)| x * y).sum(), right.len(), terms)
}

/// Above it, underflow in a sum of products does not count against the rounding of the sum.
const FAR_FROM_UNDERFLOW: f64 = 1e-280;

/// An upper bound of the sum of so many products x y >= 0, which is `nearest` in floating point.
///
/// In any order, `nearest` is at least 1 - N u / (1 - N u) times the exact sum, with the unit
/// roundoff u (Higham, Accuracy and Stability of Numerical Algorithms, section 3.1). What is zero,
/// infinite or near underflow is summed again, rounded upward.
fn sum_upward<'a>(nearest: f64, count: usize, terms: impl Iterator<Item = (f64, &'a f64)>) -> f64 {
    match nearest {
        FAR_FROM_UNDERFLOW..f64::INFINITY => {
            mul_up(nearest, 1.0 + (count + 1) as f64 * f64::EPSILON)
        }
        _ => terms
            .filter(|(x, y)| *x != 0.0 && **y != 0.0)
            .fold(0.0, |sum, (x, &y)| add_up(sum, mul_up(x, y))),
    }
}

/// `sum += term` for entries >= 0, rounded upward.
pub(crate) fn accumulate_upward(sum: &mut DMatrix<f64>, term: &DMatrix<f64>) {
    sum.zip_apply(term, |s, t| *s = add_up(*s, t));
}

/// Added to a bound of non-zero terms: far above the sum of all that underflow can take from it.
pub(crate) const UNDERFLOW: f64 = 1e-300;

/// The error of the sum of n products in floating point, in any order and with or without fused
/// operations, over the sum of their sizes: n u / (1 - n u) with the unit roundoff u at most
/// (Higham, Accuracy and Stability of Numerical Algorithms, section 3.1), and less than n + 1 units
/// even where the sizes are summed in floating point.
pub(crate) fn relative_error(n: usize) -> f64 {
    (n + 1) as f64 * f64::EPSILON / 2.0
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

    #[test]
    fn upward_products_are_above_the_exact_ones_also_where_they_underflow() {
        let left = dmatrix![0.1, 0.2; 1e-200, 0.0];
        let right = dmatrix![0.7, 0.0; 0.3, 1e-250];
        let bound = mul_upward(&left, &right);
        // 0.07 + 0.06 in exact decimals; the `f64` factors are a little above or below.
        assert!(bound[(0, 0)] > 0.13 && bound[(0, 0)] < 0.13 + 1e-15);
        assert!(bound[(0, 1)] > 0.2 * 1e-250 && bound[(1, 0)] > 0.7 * 1e-200);
        assert_eq!(bound[(1, 1)], 0.0);
        assert!(mul_upward(&dmatrix![1e-200], &dmatrix![1e-200])[(0, 0)] > 0.0);
        assert_eq!(
            mul_upward(&dmatrix![0.0, 1.0], &dmatrix![f64::INFINITY; 2.0])[(0, 0)],
            2f64.next_up()
        );
        assert_eq!(mul_upward(&dmatrix![1.0], &dmatrix![f64::INFINITY])[(0, 0)], f64::INFINITY);
    }
}
