//! Products of one exponential with the exponentials of the first samples.

use nalgebra::{DMatrix, DMatrixViewMut};
use reachtube_scalar::rounding::{add_up, mul_up};

use crate::linear::column_sums::larger;
use crate::linear::sparsity::always_zero;
use crate::linear::system::LinearSystem;
use crate::upward::{UNDERFLOW, relative_error};

/// Error bounds below this value prove that the corresponding products did not overflow.
const FAR_FROM_OVERFLOW: f64 = 1e280;

/// Number of consecutive samples that share one error bound.
pub(crate) const SHARED: usize = 6;

/// The pairs [e^{A t_j}, e^{A t_j} Γ(h)] of the first samples, prepared for products with later
/// exponentials.
pub(crate) struct ExponentialBlock {
    /// Midpoints of all pairs, side by side.
    mid: DMatrix<f64>,
    /// Largest error bound of each entry over [`SHARED`] pairs, rad + (N + 2) u |mid|, above the
    /// largest magnitude |mid| + rad.
    spread: DMatrix<f64>,
    /// Entries of a pair that are zero at every time, N x (N + m).
    zero: DMatrix<bool>,
}

impl ExponentialBlock {
    /// Prepares `pairs` pairs of midpoints `mid` and radii `rad`, column by column.
    pub(crate) fn new(system: &LinearSystem, pairs: usize, mid: &[f64], rad: &[f64]) -> Self {
        let zero = always_zero(system);
        let (n, width) = zero.shape();
        let all = DMatrix::from_column_slice(n, width * pairs, mid);
        // One more unit covers the rounding of the two ends.
        let relative = relative_error(n + 1);
        let mut spread = DMatrix::zeros(2 * n, width * pairs / SHARED);
        let columns = mid.chunks_exact(n.max(1)).zip(rad.chunks_exact(n.max(1)));
        for (column, (mid, rad)) in columns.enumerate() {
            let group = (column / (width * SHARED) * width + column % width) * 2 * n;
            let (errors, magnitudes) = spread.as_mut_slice()[group..group + 2 * n].split_at_mut(n);
            let bounds = errors.iter_mut().zip(magnitudes);
            for ((mid, rad), (error, magnitude)) in mid.iter().zip(rad).zip(bounds) {
                *error = larger(*error, add_up(*rad, mul_up(relative, mid.abs())));
                *magnitude = larger(*magnitude, add_up(*rad, mid.abs()));
            }
        }
        Self { mid: all, spread, zero }
    }

    /// Returns the number of entries of one pair, N (N + m).
    pub(crate) fn pair_size(&self) -> usize {
        self.zero.len()
    }

    /// Multiplies E, which is within `error` of `left`, by each pair P; writes midpoints and radii.
    ///
    /// With the floating-point product Ẽ P̃ of the midpoints,
    /// |E P - Ẽ P̃| <= |Ẽ| (rad P + (N + 1) u |P̃|) + rad E (|P̃| + rad P).
    /// One more term u |Ẽ| |P̃| covers the rounding of the ends of Ẽ P̃ ± radius.
    pub(crate) fn multiply(
        &self,
        left: &DMatrix<f64>,
        error: &DMatrix<f64>,
        mid: &mut [f64],
        rad: &mut [f64],
    ) {
        let n = left.nrows();
        let mut sizes = DMatrix::zeros(n, 2 * n);
        sizes.columns_mut(0, n).copy_from(&left.abs());
        sizes.columns_mut(n, n).copy_from(error);
        DMatrixViewMut::from_slice(mid, n, self.mid.ncols()).gemm(1.0, left, &self.mid, 0.0);
        DMatrixViewMut::from_slice(rad, n, self.spread.ncols()).gemm(
            1.0,
            &sizes,
            &self.spread,
            0.0,
        );
        self.round_up(rad);
    }

    /// Turns floating-point sums of magnitudes into upper bounds: ∞ if a product may have
    /// overflowed, 0 if the entry is always zero.
    fn round_up(&self, errors: &mut [f64]) {
        let upward = 1.0 + 2.0 * relative_error(2 * self.mid.nrows());
        for pair in errors.chunks_exact_mut(self.zero.len()) {
            for (error, &zero) in pair.iter_mut().zip(self.zero.as_slice()) {
                let bound = *error * upward + UNDERFLOW;
                let is_known = bound < FAR_FROM_OVERFLOW;
                *error = if zero {
                    0.0
                } else if is_known {
                    bound
                } else {
                    f64::INFINITY
                };
            }
        }
    }
}
