//! A singular value decomposition whose iteration always ends.

use nalgebra::{DMatrix, DVector, Dyn, SVD};

/// Thresholds of the iteration that are tried, in units of the machine epsilon.
const THRESHOLDS: [f64; 3] = [5.0, 50.0, 5e3];

/// The singular value decomposition A = U diag(σ) Vᵀ of a square or tall matrix A with k columns.
pub(crate) struct Singular {
    /// U, one column per singular value.
    pub u: DMatrix<f64>,
    /// σ, k entries in no order.
    pub values: DVector<f64>,
    /// V, k x k, one column per singular value.
    pub v: DMatrix<f64>,
}

impl Singular {
    /// Decomposes a matrix.
    ///
    /// nalgebra's iteration may not converge to its own threshold, and would then never end. Wider
    /// thresholds follow, and at last the eigenvectors of AᵀA, which have half the digits.
    pub(crate) fn of(matrix: &DMatrix<f64>) -> Self {
        let steps = 100 * (1 + matrix.ncols());
        let attempt = |threshold: f64| {
            SVD::try_new_unordered(matrix.clone(), true, true, threshold * f64::EPSILON, steps)
        };
        THRESHOLDS.into_iter().find_map(attempt).and_then(Self::from_svd).unwrap_or_else(|| {
            let eigen = (matrix.transpose() * matrix).symmetric_eigen();
            let values = eigen.eigenvalues.map(|value| value.max(0.0).sqrt());
            let inverse = values.map(|value| if value > 0.0 { value.recip() } else { 0.0 });
            let u = matrix * &eigen.eigenvectors * DMatrix::from_diagonal(&inverse);
            Self { u, values, v: eigen.eigenvectors }
        })
    }

    fn from_svd(svd: SVD<f64, Dyn, Dyn>) -> Option<Self> {
        Some(Self { u: svd.u?, values: svd.singular_values, v: svd.v_t?.transpose() })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_factors_multiply_to_the_matrix() {
        let matrix = DMatrix::from_fn(7, 4, |i, j| ((3 * i + 5 * j * j) % 7) as f64 - 3.0);
        let Singular { u, values, v } = Singular::of(&matrix);
        let product = u * DMatrix::from_diagonal(&values) * v.transpose();
        assert!((product - matrix).amax() < 1e-12);
    }
}
