//! Triangular factors of tall matrices.

use nalgebra::DMatrix;
use reachtube_scalar::{Dispatch, Kernel, Lanes};

/// Number of rows that are taken at once.
const LANES: usize = 8;

/// Number of columns that are reflected at once, so that what is read of the reflection serves all.
const COLUMNS: usize = 4;

/// Returns the triangular factor R of a QR decomposition by Householder's reflections, with a
/// diagonal of at least 0: min(rows, columns) x columns.
pub(super) fn triangular(mut matrix: DMatrix<f64>) -> DMatrix<f64> {
    let (rows, columns) = matrix.shape();
    for k in 0..rows.min(columns) {
        let (left, right) = matrix.as_mut_slice().split_at_mut((k + 1) * rows);
        let v = &mut left[k * rows + k..];
        let squares: f64 = v.iter().map(|x| x * x).sum();
        if squares < f64::MIN_POSITIVE {
            continue;
        }
        let norm = squares.sqrt();
        // The reflection that turns v into -sign(v₀) |v| e₀, without cancellation.
        let first = v[0];
        v[0] += norm.copysign(first);
        let scale = 1.0 / (norm * v[0].abs());
        Lanes::<LANES>::dispatch(Reflection { v, scale, matrix: right, rows });
        v[0] = -norm.copysign(first);
    }
    DMatrix::from_fn(rows.min(columns), columns, |i, j| {
        if i <= j { matrix[(i, j)] * 1f64.copysign(matrix[(i, i)]) } else { 0.0 }
    })
}

/// Takes `scale` (vᵀ a) v from the last rows of each column a of a matrix.
struct Reflection<'a> {
    v: &'a [f64],
    scale: f64,
    matrix: &'a mut [f64],
    rows: usize,
}

impl Kernel for Reflection<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Self { v, scale, matrix, rows } = self;
        let from = rows - v.len();
        for columns in matrix.chunks_mut(COLUMNS * rows) {
            if columns.len() == COLUMNS * rows {
                let (a, rest) = columns.split_at_mut(rows);
                let (b, rest) = rest.split_at_mut(rows);
                let (c, d) = rest.split_at_mut(rows);
                reflect(v, scale, [a, b, c, d].map(|column| &mut column[from..]));
            } else {
                for column in columns.chunks_exact_mut(rows) {
                    reflect(v, scale, [&mut column[from..]]);
                }
            }
        }
    }
}

#[inline(always)]
fn reflect<const N: usize>(v: &[f64], scale: f64, columns: [&mut [f64]; N]) {
    let whole = v.len() - v.len() % LANES;
    let mut sums = [[0.0; LANES]; N];
    for at in (0..whole).step_by(LANES) {
        let v: [f64; LANES] = lanes(v, at);
        for (sum, column) in sums.iter_mut().zip(&columns) {
            let (mut new, a) = (*sum, lanes(column, at));
            for lane in 0..LANES {
                new[lane] += v[lane] * a[lane];
            }
            *sum = new;
        }
    }
    for (sum, column) in sums.iter().zip(columns) {
        let rest = v[whole..].iter().zip(&column[whole..]).map(|(v, a)| v * a);
        let factor = scale * (sum.iter().sum::<f64>() + rest.sum::<f64>());
        column.iter_mut().zip(v).for_each(|(a, v)| *a -= factor * v);
    }
}

#[inline(always)]
fn lanes(values: &[f64], at: usize) -> [f64; LANES] {
    let mut lanes = [0.0; LANES];
    lanes.copy_from_slice(&values[at..at + LANES]);
    lanes
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Checks that R is triangular, and RᵀR = AᵀA.
    fn is_factor(r: &DMatrix<f64>, matrix: &DMatrix<f64>) -> bool {
        let below = (0..r.nrows()).flat_map(|i| (0..i).map(move |j| (i, j)));
        r.shape() == (matrix.nrows().min(matrix.ncols()), matrix.ncols())
            && below.clone().all(|at| r[at] == 0.0)
            && (0..r.nrows()).all(|i| r[(i, i)] >= 0.0)
            && (r.tr_mul(r) - matrix.tr_mul(matrix)).amax() < 1e-11
    }

    proptest! {
        #[test]
        fn rows_and_columns_of_any_number_are_factored(
            (rows, columns) in (1..40_usize, 1..14_usize),
            values in prop::collection::vec(-3.0..3.0_f64, 40 * 14),
        ) {
            let matrix = DMatrix::from_fn(rows, columns, |i, j| values[14 * i + j]);
            prop_assert!(is_factor(&triangular(matrix.clone()), &matrix));
        }
    }

    #[test]
    fn a_column_of_zeros_and_one_that_depends_on_others_are_taken() {
        let mut matrix = DMatrix::from_fn(9, 4, |i, j| ((3 * i + 5 * j * j) % 7) as f64 - 2.0);
        matrix.column_mut(1).fill(0.0);
        let sum = matrix.column(0) + matrix.column(2);
        matrix.set_column(3, &sum);
        assert!(is_factor(&triangular(matrix.clone()), &matrix));
    }
}
