//! Upper bounds of floating-point sums and products with terms >= 0.
//!
//! The bounds of rounding errors follow Higham, Accuracy and Stability of Numerical Algorithms,
//! section 3.1: the floating-point sum of n products differs from the exact sum by at most
//! γ_n = n u / (1 - n u) times the sum of the absolute products, with the unit roundoff u.

use nalgebra::DMatrix;
use reachtube_scalar::rounding::{add_up, mul_up};

/// Smallest sum of products for which underflow is negligible against the rounding of the sum.
const FAR_FROM_UNDERFLOW: f64 = 1e-280;

/// Absolute error added to a bound of non-zero terms; it exceeds the loss of all underflows.
pub(crate) const UNDERFLOW: f64 = 1e-300;

/// Bounds the relative error of the floating-point sum of n products, with respect to the sum of
/// their magnitudes.
///
/// The sum may be evaluated in any order and with fused operations. The bound exceeds γ_n and also
/// holds where the sum of magnitudes is a floating-point sum.
pub(crate) fn relative_error(n: usize) -> f64 {
    (n + 1) as f64 * f64::EPSILON / 2.0
}

/// Bounds a sum of `terms` products >= 0 from above, given its floating-point value `sum`.
///
/// The rounded sum is at least 1 - γ_N times the exact one in any order, and γ_N is at most N ε for
/// N below 2⁵⁰. The added constant covers products that underflow. The bound also covers one more
/// product with a factor >= 0 in each term and one in front of the sum.
pub(crate) fn round_up_sum(sum: f64, terms: usize) -> f64 {
    sum * (1.0 + (terms + 4) as f64 * f64::EPSILON) + f64::MIN_POSITIVE
}

/// Bounds the product of two matrices with entries >= 0 from above; an entry all of whose terms are
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

/// Bounds Σ x_i y_i with terms >= 0 from above.
pub(crate) fn dot_upward(left: impl Iterator<Item = f64> + Clone, right: &[f64]) -> f64 {
    let terms = left.zip(right);
    sum_upward(terms.clone().map(|(x, y)| x * y).sum(), right.len(), terms)
}

/// Bounds the sum of `count` products x y >= 0 from above, given its floating-point value
/// `nearest`.
///
/// `nearest` is at least 1 - γ_N times the exact sum, in any order. Where it is zero, infinite or
/// near underflow, the terms are summed again with upward rounding.
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

/// Adds `term` to `sum`, both with entries >= 0, rounded upward.
pub(crate) fn accumulate_upward(sum: &mut DMatrix<f64>, term: &DMatrix<f64>) {
    sum.zip_apply(term, |s, t| *s = add_up(*s, t));
}

/// Returns the largest row sum of a matrix with entries >= 0, rounded upward.
pub(crate) fn norm_upward(magnitudes: &DMatrix<f64>) -> f64 {
    let row_sum = |row: usize| magnitudes.row(row).iter().fold(0.0, |sum, &x| add_up(sum, x));
    (0..magnitudes.nrows()).map(row_sum).fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use nalgebra::dmatrix;

    use super::*;

    #[test]
    fn upward_products_are_above_the_exact_ones_also_where_they_underflow() {
        let left = dmatrix![0.1, 0.2; 1e-200, 0.0];
        let right = dmatrix![0.7, 0.0; 0.3, 1e-250];
        let bound = mul_upward(&left, &right);
        // The exact decimal product is 0.07 + 0.06; the `f64` factors differ from it by rounding.
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

    #[test]
    fn the_largest_row_sum_is_rounded_upward() {
        assert_eq!(norm_upward(&dmatrix![1.0, 2.0; 0.5, 0.25]), 3.0);
        assert!(norm_upward(&dmatrix![1.0, 1e-20]) > 1.0);
    }
}
