//! Rank-revealing QR with the columns' own order for pivoting.

use nalgebra::{DMatrix, DVector};

/// Independent columns of a matrix, and all columns by these.
pub(super) struct Independent {
    pub indices: Vec<usize>,
    /// Row i holds the part that independent column i has in every column.
    pub combinations: DMatrix<f64>,
}

/// R of the QR decomposition of a matrix with columns of unit length, and their lengths before; R
/// has the same dependences and singular values.
///
/// Columns below `tolerance` of the longest are taken for 0: angles with 12 digits leave such where
/// right angles are meant, and scaled up they would look like parameters.
pub(super) fn triangle(stacked: &DMatrix<f64>, tolerance: f64) -> (DMatrix<f64>, Vec<f64>) {
    let norms: Vec<_> = stacked.column_iter().map(|c| c.norm()).collect();
    let mut scaled = stacked.clone();
    let least = tolerance * norms.iter().fold(0.0, |a: f64, b| a.max(*b));
    for (mut column, norm) in scaled.column_iter_mut().zip(&norms) {
        if *norm > least { column.unscale_mut(*norm) } else { column.fill(0.0) }
    }
    (scaled.qr().r(), norms)
}

impl Independent {
    pub fn of(r: &DMatrix<f64>, norms: &[f64], tolerance: f64) -> Self {
        let mut frame: Vec<DVector<f64>> = Vec::new();
        let mut indices = Vec::new();
        for (k, column) in r.column_iter().enumerate() {
            let mut rest = column.into_owned();
            // Twice is enough (Kahan, Parlett): the second pass takes off what rounding of the
            // first left.
            for _ in 0..2 {
                frame.iter().for_each(|e| rest.axpy(-e.dot(&rest), e, 1.0));
            }
            let length = rest.norm();
            if length > tolerance {
                frame.push(rest / length);
                indices.push(k);
            }
        }
        let combinations = express(r, norms, &indices, &frame);
        Self { indices, combinations }
    }
}

/// All columns by the independent ones: back substitution in the frame that these span, columns at
/// their own scale.
fn express(
    r: &DMatrix<f64>,
    norms: &[f64],
    indices: &[usize],
    frame: &[DVector<f64>],
) -> DMatrix<f64> {
    let inner = |columns: &[usize]| {
        DMatrix::from_fn(frame.len(), columns.len(), |i, j| frame[i].dot(&r.column(columns[j])))
    };
    let all: Vec<_> = (0..r.ncols()).collect();
    let triangle = inner(indices).upper_triangle();
    let mut parts =
        triangle.solve_upper_triangular(&inner(&all)).expect("its diagonal is above the tolerance");
    for (i, &k) in indices.iter().enumerate() {
        for j in 0..parts.ncols() {
            parts[(i, j)] *= norms[j] / norms[k];
        }
    }
    // Known exactly: the identity, and that a column is expressed by those before it.
    for (i, &k) in indices.iter().enumerate() {
        (0..k).for_each(|j| parts[(i, j)] = 0.0);
        indices.iter().for_each(|&j| parts[(i, j)] = f64::from(j == k));
    }
    parts
}
