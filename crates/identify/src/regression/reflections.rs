//! The triangular factor of a QR decomposition by Householder's reflections, in vector registers.

use nalgebra::DMatrix;
use reachtube_scalar::{Dispatch, Kernel, Lanes};

/// Sums that are added up side by side, in vector registers.
const SUMS: usize = 16;

/// Returns the triangular factor R of the QR decomposition of m x n numbers, min(m, n) x n, with
/// entries of 0 or more on its diagonal (Golub and Van Loan, Matrix Computations, algorithm 5.2.1).
pub(super) fn factor(mut rows: DMatrix<f64>) -> DMatrix<f64> {
    let (m, n) = rows.shape();
    let triangle = m.min(n);
    Lanes::<8>::dispatch(Reflections { columns: rows.as_mut_slice(), m, triangle });
    let mut r = rows.rows_range(..triangle).upper_triangle();
    for (i, mut row) in r.row_iter_mut().enumerate() {
        if row[i] < 0.0 {
            row.neg_mut();
        }
    }
    r
}

/// Reflects columns of m numbers so that only the triangle stays; what is below it is not cleared.
struct Reflections<'a> {
    columns: &'a mut [f64],
    m: usize,
    triangle: usize,
}

impl Kernel for Reflections<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Self { columns, m, triangle } = self;
        // A column of zeros stays one.
        let is_zero = |column: &[f64]| column.iter().all(|x| *x == 0.0);
        let is_zero: Vec<bool> = columns.chunks_exact(m.max(1)).map(is_zero).collect();
        for j in 0..triangle {
            if is_zero[j] {
                continue;
            }
            let (known, others) = columns.split_at_mut((j + 1) * m);
            let axis = &mut known[j * m + j..];
            let norm = dot(axis, axis).sqrt();
            if norm == 0.0 {
                continue;
            }
            // The axis is the column less its reflection, which has the opposite sign of its first
            // entry, so that nothing cancels.
            let reflected = -norm.copysign(axis[0]);
            let half_square = norm * (norm + axis[0].abs());
            axis[0] -= reflected;
            let others = others.chunks_exact_mut(m).zip(&is_zero[j + 1..]);
            for (column, _) in others.filter(|(_, is_zero)| !**is_zero) {
                let column = &mut column[j..];
                let part = dot(axis, column) / half_square;
                for (entry, axis) in column.iter_mut().zip(&*axis) {
                    *entry -= part * axis;
                }
            }
            axis[0] = reflected;
        }
    }
}

#[inline(always)]
fn dot(x: &[f64], y: &[f64]) -> f64 {
    let (mut sums, mut rest) = ([0.0; SUMS], 0.0);
    let (x, x_rest) = x.as_chunks::<SUMS>();
    let (y, y_rest) = y.as_chunks::<SUMS>();
    for (x, y) in x.iter().zip(y) {
        for ((sum, x), y) in sums.iter_mut().zip(x).zip(y) {
            *sum += x * y;
        }
    }
    for (x, y) in x_rest.iter().zip(y_rest) {
        rest += x * y;
    }
    sums.iter().sum::<f64>() + rest
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn matrix() -> impl Strategy<Value = DMatrix<f64>> {
        (1..70_usize, 1..9_usize).prop_flat_map(|(m, n)| {
            prop::collection::vec(-3.0..3.0_f64, m * n)
                .prop_map(move |values| DMatrix::from_vec(m, n, values))
        })
    }

    proptest! {
        /// Another implementation finds the same factor, which is unique if the columns are
        /// independent and its diagonal is positive.
        #[test]
        fn the_factor_is_that_of_nalgebra(rows in matrix()) {
            let (own, other) = (factor(rows.clone()), rows.clone().qr().unpack_r());
            prop_assert_eq!(own.shape(), other.shape());
            prop_assert!((&own.transpose() * &own - rows.transpose() * &rows).amax() < 1e-11);
            prop_assume!((0..other.nrows()).all(|i| other[(i, i)] > 1e-2));
            prop_assert!((own - other).amax() < 1e-9);
        }

        /// A column that depends on others has a zero on the diagonal, but for rounding.
        #[test]
        fn dependent_columns_leave_a_zero(column in prop::collection::vec(-3.0..3.0_f64, 5..40)) {
            let doubled = column.iter().map(|x| 2.0 * x);
            let values = column.iter().copied().chain(doubled).collect();
            let r = factor(DMatrix::from_vec(column.len(), 2, values));
            prop_assert!(r[(1, 1)].abs() < 1e-12 && r[(1, 0)] == 0.0);
        }
    }

    #[test]
    fn columns_of_zeros_stay() {
        assert_eq!(factor(DMatrix::zeros(3, 2)), DMatrix::zeros(2, 2));
    }
}
