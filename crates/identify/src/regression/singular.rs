//! A singular value decomposition whose iteration always ends.

use nalgebra::{DMatrix, DVector, Dyn, SVD};

/// Thresholds of the iteration that are tried, in units of the machine epsilon.
const THRESHOLDS: [f64; 3] = [5.0, 50.0, 5e3];

/// Singular values below this part of the largest count as zero: the rows do not determine their
/// directions.
const RANK_TOLERANCE: f64 = 1e-7;

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

/// The decomposition of a matrix whose columns are scaled to unit length.
pub(crate) struct UnitSingular {
    /// Factor of each column; 0 for a column of zeros.
    pub unit: DVector<f64>,
    pub singular: Singular,
    /// Singular values up to this one count as zero.
    pub cut: f64,
}

impl UnitSingular {
    pub(crate) fn of(matrix: &DMatrix<f64>) -> Self {
        let norms: Vec<f64> = matrix.column_iter().map(|column| column.norm()).collect();
        let largest = norms.iter().copied().fold(0.0, f64::max);
        let inverse = |norm: &f64| if *norm > 1e-12 * largest { 1.0 / norm } else { 0.0 };
        let unit = DVector::from_iterator(norms.len(), norms.iter().map(inverse));
        let singular = Singular::of(&(matrix * DMatrix::from_diagonal(&unit)));
        let cut = RANK_TOLERANCE * singular.values.max();
        Self { unit, singular, cut }
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
