//! Singular values by an iteration that always ends.

use nalgebra::{DMatrix, SVD};

/// Returns the singular values of a matrix in descending order.
///
/// nalgebra's iteration may not converge to its own threshold. If it exceeds its number of steps,
/// it runs again with a wider threshold.
pub(crate) fn singular_values(matrix: &DMatrix<f64>) -> Vec<f64> {
    let steps = 100 * (1 + matrix.nrows().min(matrix.ncols()));
    let attempt =
        |threshold| SVD::try_new_unordered(matrix.clone(), false, false, threshold, steps);
    let found = [5.0, 50.0, 5e3].into_iter().find_map(|k| attempt(k * f64::EPSILON));
    let mut values = found.map_or_else(
        || by_eigenvalues(matrix),
        |svd| svd.singular_values.iter().copied().collect(),
    );
    values.sort_by(|a, b| b.total_cmp(a));
    values
}

/// Returns the roots of the eigenvalues of Aᵀ A, which have half the digits of a singular value
/// decomposition.
fn by_eigenvalues(matrix: &DMatrix<f64>) -> Vec<f64> {
    matrix.tr_mul(matrix).symmetric_eigenvalues().iter().map(|x| x.max(0.0).sqrt()).collect()
}
