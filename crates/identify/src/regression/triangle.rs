use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

/// Rows that are factored in one go.
const CHUNK: usize = 1024;

/// What least squares keeps of any number of rows [a, y]: the triangular factor R of [A, y].
///
/// ‖A x - y‖² = ‖R x - z‖² + rest² for all x. Factors of parts are joined by factoring them again,
/// so rows can be added in any number.
#[derive(Debug, Clone)]
pub struct Triangle {
    /// p x p, upper triangular.
    pub r: DMatrix<f64>,
    /// p entries.
    pub z: DVector<f64>,
    /// What no x can fit.
    pub rest: f64,
}

impl Triangle {
    /// Of rows [a, y], each of p + 1 entries, row-major.
    pub fn of(rows: &[f64], columns: usize) -> Self {
        let width = columns + 1;
        let all: Vec<usize> = (0..rows.len() / width).collect();
        Self::of_rows(&all, columns, |index, row| {
            row.copy_from_slice(&rows[index * width..][..width])
        })
    }

    /// Of the rows [a, y] that `write` writes for each index.
    pub fn of_rows(
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
        Self::joined(parts, width)
    }

    /// Of the rows of several.
    pub fn of_all<'a>(triangles: impl IntoIterator<Item = &'a Self>) -> Self {
        let parts: Vec<_> = triangles.into_iter().map(Self::augmented).collect();
        let width = parts.first().map_or(1, DMatrix::ncols);
        Self::joined(parts, width)
    }

    fn joined(parts: Vec<DMatrix<f64>>, width: usize) -> Self {
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
            rest: whole[(p, p)].abs(),
        }
    }

    fn augmented(&self) -> DMatrix<f64> {
        let p = self.r.ncols();
        let mut whole = DMatrix::zeros(p + 1, p + 1);
        whole.view_mut((0, 0), (p, p)).copy_from(&self.r);
        whole.view_mut((0, p), (p, 1)).column_mut(0).copy_from(&self.z);
        whole[(p, p)] = self.rest;
        whole
    }

    /// Of the same rows with other columns: A · `map` in place of A (p x k).
    pub fn mapped(&self, map: &DMatrix<f64>) -> Self {
        let (p, k) = map.shape();
        let mut rows = DMatrix::zeros(p + 1, k + 1);
        rows.view_mut((0, 0), (p, k)).copy_from(&(&self.r * map));
        rows.view_mut((0, k), (p, 1)).column_mut(0).copy_from(&self.z);
        rows[(p, k)] = self.rest;
        Self::joined(vec![factor(rows)], k + 1)
    }

    /// The sum of squares ‖A x - y‖².
    pub fn squares(&self, x: &DVector<f64>) -> f64 {
        (&self.r * x - &self.z).norm_squared() + self.rest * self.rest
    }
}

/// The triangular factor of rows.
fn factor(rows: DMatrix<f64>) -> DMatrix<f64> {
    rows.qr().unpack_r()
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

    fn triangle(rows: &DMatrix<f64>) -> Triangle {
        Triangle::of(rows.transpose().as_slice(), rows.ncols() - 1)
    }

    proptest! {
        #[test]
        fn sums_of_squares_are_those_of_the_rows(rows in (1..40_usize).prop_flat_map(matrix), x in [-2.0..2.0, -2.0..2.0, -2.0..2.0_f64]) {
            let x = DVector::from_row_slice(&x);
            let squares = (rows.columns(0, 3) * &x - rows.column(3)).norm_squared();
            prop_assert!((triangle(&rows).squares(&x) - squares).abs() < 1e-9 * (1.0 + squares));
        }

        #[test]
        fn parts_make_the_whole(above in matrix(7), below in matrix(9), x in [-2.0..2.0, -2.0..2.0, -2.0..2.0_f64]) {
            let x = DVector::from_row_slice(&x);
            let parts = [triangle(&above), triangle(&below)];
            let squares = parts[0].squares(&x) + parts[1].squares(&x);
            prop_assert!((Triangle::of_all(&parts).squares(&x) - squares).abs() < 1e-9 * (1.0 + squares));
        }

        #[test]
        fn columns_are_combined(rows in matrix(12), x in [-2.0..2.0, -2.0..2.0_f64]) {
            let map = DMatrix::from_row_slice(3, 2, &[1.0, 0.0, 0.5, 2.0, 0.0, -1.0]);
            let x = DVector::from_row_slice(&x);
            let whole = triangle(&rows);
            prop_assert!((whole.mapped(&map).squares(&x) - whole.squares(&(&map * &x))).abs() < 1e-9 * (1.0 + whole.squares(&(&map * &x))));
        }
    }

    #[test]
    fn many_rows_are_factored_in_chunks() {
        let rows: Vec<f64> = (0..3 * 5000).map(|k| ((k * 7919) % 1009) as f64 / 1009.0).collect();
        let whole = DMatrix::from_row_slice(5000, 3, &rows);
        let x = DVector::from_row_slice(&[0.3, -0.2]);
        let squares = (whole.columns(0, 2) * &x - whole.column(2)).norm_squared();
        assert!((Triangle::of(&rows, 2).squares(&x) - squares).abs() < 1e-9 * squares);
    }
}
