use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

use crate::regression::reflections::factor;

/// Number of rows that are factored at once. Columns of a power of two of numbers would share a few
/// places of a cache.
const CHUNK: usize = 1000;

/// The triangular factor of any number of rows [a, y], which is all that least squares needs.
///
/// With p columns in A, ‖A x - y‖² = ‖R x - z‖² + residual² for all x. Factors of parts are joined
/// by factoring them again, so that rows can be added in any number.
#[derive(Debug, Clone)]
pub struct TriangularFactor {
    /// R, p x p, upper triangular.
    pub r: DMatrix<f64>,
    /// z, p entries.
    pub z: DVector<f64>,
    /// Norm of the residual of the best x.
    pub residual: f64,
}

impl TriangularFactor {
    /// Factors rows [a, y] of p + 1 entries each, given row-major.
    #[must_use]
    pub fn from_rows(rows: &[f64], columns: usize) -> Self {
        let width = columns + 1;
        let all: Vec<usize> = (0..rows.len() / width).collect();
        Self::from_written_rows(&all, columns, |index, row| {
            row.copy_from_slice(&rows[index * width..][..width])
        })
    }

    /// Factors the rows [a, y] that `write` fills in, one for each index.
    pub(crate) fn from_written_rows(
        indices: &[usize],
        columns: usize,
        write: impl Fn(usize, &mut [f64]) + Sync,
    ) -> Self {
        let width = columns + 1;
        let part = |part: &[usize]| {
            let mut rows = vec![0.0; part.len() * width];
            part.iter()
                .zip(rows.chunks_exact_mut(width))
                .for_each(|(index, row)| write(*index, row));
            factor(DMatrix::from_row_slice(part.len(), width, &rows))
        };
        let parts: Vec<_> = indices.par_chunks(CHUNK).map(part).collect();
        Self::from_parts(parts, width)
    }

    pub(crate) fn joined<'a>(factors: impl IntoIterator<Item = &'a Self>) -> Self {
        let parts: Vec<_> = factors.into_iter().map(Self::augmented).collect();
        let width = parts.first().map_or(1, DMatrix::ncols);
        Self::from_parts(parts, width)
    }

    fn from_parts(parts: Vec<DMatrix<f64>>, width: usize) -> Self {
        let stack = parts.into_iter().reduce(|above, below| factor(stacked(&above, &below)));
        let mut whole = DMatrix::zeros(width, width);
        if let Some(stack) = stack {
            whole.rows_mut(0, stack.nrows()).copy_from(&stack);
        }
        Self::from_augmented(&whole)
    }

    fn from_augmented(whole: &DMatrix<f64>) -> Self {
        let p = whole.ncols() - 1;
        Self {
            r: whole.view((0, 0), (p, p)).into_owned(),
            z: whole.view((0, p), (p, 1)).column(0).into_owned(),
            residual: whole[(p, p)].abs(),
        }
    }

    fn augmented(&self) -> DMatrix<f64> {
        let p = self.r.ncols();
        let mut whole = DMatrix::zeros(p + 1, p + 1);
        whole.view_mut((0, 0), (p, p)).copy_from(&self.r);
        whole.view_mut((0, p), (p, 1)).column_mut(0).copy_from(&self.z);
        whole[(p, p)] = self.residual;
        whole
    }

    /// Returns the factor of the rows [A · `map`, y], where `map` is p x k.
    #[must_use]
    pub(crate) fn with_mapped_columns(&self, map: &DMatrix<f64>) -> Self {
        let (p, k) = map.shape();
        let mut rows = DMatrix::zeros(p + 1, k + 1);
        rows.view_mut((0, 0), (p, k)).copy_from(&(&self.r * map));
        rows.view_mut((0, k), (p, 1)).column_mut(0).copy_from(&self.z);
        rows[(p, k)] = self.residual;
        Self::from_parts(vec![factor(rows)], k + 1)
    }

    /// Returns the sum of squares ‖A x - y‖².
    #[must_use]
    pub(crate) fn sum_of_squares(&self, x: &DVector<f64>) -> f64 {
        (&self.r * x - &self.z).norm_squared() + self.residual * self.residual
    }
}

fn stacked(above: &DMatrix<f64>, below: &DMatrix<f64>) -> DMatrix<f64> {
    let mut stack = DMatrix::zeros(above.nrows() + below.nrows(), above.ncols());
    stack.rows_mut(0, above.nrows()).copy_from(above);
    stack.rows_mut(above.nrows(), below.nrows()).copy_from(below);
    stack
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn matrix(rows: usize) -> impl Strategy<Value = DMatrix<f64>> {
        prop::collection::vec(-3.0..3.0_f64, rows * 4)
            .prop_map(move |v| DMatrix::from_row_slice(rows, 4, &v))
    }

    fn factor_of(rows: &DMatrix<f64>) -> TriangularFactor {
        TriangularFactor::from_rows(rows.transpose().as_slice(), rows.ncols() - 1)
    }

    proptest! {
        #[test]
        fn sums_of_squares_equal_those_of_the_rows(
            rows in (1..40_usize).prop_flat_map(matrix),
            x in [-2.0..2.0, -2.0..2.0, -2.0..2.0_f64],
        ) {
            let x = DVector::from_row_slice(&x);
            let squares = (rows.columns(0, 3) * &x - rows.column(3)).norm_squared();
            let error = (factor_of(&rows).sum_of_squares(&x) - squares).abs();
            prop_assert!(error < 1e-9 * (1.0 + squares));
        }

        #[test]
        fn parts_add_up_to_the_whole(
            above in matrix(7),
            below in matrix(9),
            x in [-2.0..2.0, -2.0..2.0, -2.0..2.0_f64],
        ) {
            let x = DVector::from_row_slice(&x);
            let parts = [factor_of(&above), factor_of(&below)];
            let squares = parts[0].sum_of_squares(&x) + parts[1].sum_of_squares(&x);
            let joined = TriangularFactor::joined(&parts).sum_of_squares(&x);
            prop_assert!((joined - squares).abs() < 1e-9 * (1.0 + squares));
        }

        #[test]
        fn mapped_columns_equal_mapped_parameters(
            rows in matrix(12),
            x in [-2.0..2.0, -2.0..2.0_f64],
        ) {
            let map = DMatrix::from_row_slice(3, 2, &[1.0, 0.0, 0.5, 2.0, 0.0, -1.0]);
            let x = DVector::from_row_slice(&x);
            let whole = factor_of(&rows);
            let squares = whole.sum_of_squares(&(&map * &x));
            let mapped = whole.with_mapped_columns(&map).sum_of_squares(&x);
            prop_assert!((mapped - squares).abs() < 1e-9 * (1.0 + squares));
        }
    }

    #[test]
    fn many_rows_are_factored_in_chunks() {
        let rows: Vec<f64> = (0..3 * 5000).map(|k| ((k * 7919) % 1009) as f64 / 1009.0).collect();
        let whole = DMatrix::from_row_slice(5000, 3, &rows);
        let x = DVector::from_row_slice(&[0.3, -0.2]);
        let squares = (whole.columns(0, 2) * &x - whole.column(2)).norm_squared();
        let factor = TriangularFactor::from_rows(&rows, 2);
        assert!((factor.sum_of_squares(&x) - squares).abs() < 1e-9 * squares);
    }
}
