//! Independent columns of a matrix by a QR decomposition that keeps the order of the columns.

use nalgebra::{DMatrix, DVector};

/// The independent columns of a matrix, and all columns as combinations of them.
pub(super) struct IndependentColumns {
    /// Indices of the independent columns, ascending.
    pub indices: Vec<usize>,
    /// Row i has the coefficients of independent column i in every column.
    pub combinations: DMatrix<f64>,
}

/// Returns R of the QR decomposition of a matrix with its columns scaled to unit length, and the
/// lengths of its columns.
///
/// R has the same dependences and singular values as the scaled matrix. Columns shorter than
/// `tolerance` times the longest are set to 0. Right angles with 12 digits cause such columns, and
/// scaled to unit length they would look like parameters.
pub(super) fn scaled_triangle(stacked: &DMatrix<f64>, tolerance: f64) -> (DMatrix<f64>, Vec<f64>) {
    let norms: Vec<_> = stacked.column_iter().map(|c| c.norm()).collect();
    let mut scaled = stacked.clone();
    let least = tolerance * norms.iter().fold(0.0, |a: f64, b| a.max(*b));
    for (mut column, norm) in scaled.column_iter_mut().zip(&norms) {
        if *norm > least { column.unscale_mut(*norm) } else { column.fill(0.0) }
    }
    (scaled.qr().r(), norms)
}

impl IndependentColumns {
    /// Selects the columns of R that are independent of the earlier ones, and expresses all columns
    /// by them; `norms` are the lengths before scaling.
    pub(super) fn of(r: &DMatrix<f64>, norms: &[f64], tolerance: f64) -> Self {
        let mut basis: Vec<DVector<f64>> = Vec::new();
        let mut indices = Vec::new();
        for (k, column) in r.column_iter().enumerate() {
            let mut rest = column.into_owned();
            // Twice is enough (Kahan, Parlett): the second pass removes what the first one left by
            // rounding.
            for _ in 0..2 {
                basis.iter().for_each(|e| rest.axpy(-e.dot(&rest), e, 1.0));
            }
            let length = rest.norm();
            if length > tolerance {
                basis.push(rest / length);
                indices.push(k);
            }
        }
        let combinations = express(r, norms, &indices, &basis);
        Self { indices, combinations }
    }
}

/// Expresses all columns by the independent ones through back substitution in their orthonormal
/// basis, at the scale before the columns were normalised.
fn express(
    r: &DMatrix<f64>,
    norms: &[f64],
    indices: &[usize],
    basis: &[DVector<f64>],
) -> DMatrix<f64> {
    let inner = |columns: &[usize]| {
        DMatrix::from_fn(basis.len(), columns.len(), |i, j| basis[i].dot(&r.column(columns[j])))
    };
    let all: Vec<_> = (0..r.ncols()).collect();
    let triangle = inner(indices).upper_triangle();
    let mut coefficients =
        triangle.solve_upper_triangular(&inner(&all)).expect("its diagonal is above the tolerance");
    for (i, &k) in indices.iter().enumerate() {
        for j in 0..coefficients.ncols() {
            coefficients[(i, j)] *= norms[j] / norms[k];
        }
    }
    // Exact values: a column depends on earlier columns only, and an independent one on itself.
    for (i, &k) in indices.iter().enumerate() {
        (0..k).for_each(|j| coefficients[(i, j)] = 0.0);
        indices.iter().for_each(|&j| coefficients[(i, j)] = f64::from(j == k));
    }
    coefficients
}
