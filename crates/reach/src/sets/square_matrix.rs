//! Small dense square matrices of `f64`, stored row by row.

use crate::upward::round_up_sum;

/// A square matrix, n x n, stored row by row.
#[derive(Debug, Clone)]
pub(crate) struct SquareMatrix {
    pub n: usize,
    pub entries: Vec<f64>,
}

impl SquareMatrix {
    pub(crate) fn zero(n: usize) -> Self {
        Self { n, entries: vec![0.0; n * n] }
    }

    pub(crate) fn row(&self, i: usize) -> &[f64] {
        &self.entries[i * self.n..(i + 1) * self.n]
    }

    /// Sets `self` to `left` times `right`; each entry is a floating-point sum of n products.
    pub(crate) fn set_product(&mut self, left: &Self, right: &Self) {
        self.entries.fill(0.0);
        let n = self.n;
        for (i, sum) in self.entries.chunks_exact_mut(n.max(1)).enumerate() {
            for (k, &x) in left.row(i).iter().enumerate().filter(|(_, x)| **x != 0.0) {
                sum.iter_mut().zip(right.row(k)).for_each(|(sum, y)| *sum += x * y);
            }
        }
    }

    /// Sets `out` to `self` times `column`, in floating point.
    pub(crate) fn apply(&self, column: &[f64], out: &mut [f64]) {
        for (i, out) in out.iter_mut().enumerate() {
            *out = self.row(i).iter().zip(column).map(|(x, y)| x * y).sum();
        }
    }

    /// Sets `out` to an upper bound of |self| times `column`, for a column >= 0.
    pub(crate) fn apply_absolute(&self, column: &[f64], out: &mut [f64]) {
        for (i, out) in out.iter_mut().enumerate() {
            let sum = self.row(i).iter().zip(column).map(|(x, y)| x.abs() * y).sum();
            *out = round_up_sum(sum, self.n);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn upper_bounds_are_above_and_close() {
        let matrix = SquareMatrix { n: 2, entries: vec![0.1, -0.2, 1e-200, 0.0] };
        let mut out = [0.0; 2];
        matrix.apply_absolute(&[0.7, 0.3], &mut out);
        // The exact decimal sum is 0.07 + 0.06; the four factors differ from it by rounding.
        assert!(out[0] > 0.13 && out[0] < 0.13 + 1e-15);
        matrix.apply_absolute(&[1e-200, 0.0], &mut out);
        assert!(out[1] > 0.0);
        let mut square = SquareMatrix::zero(2);
        square.set_product(&matrix, &matrix);
        assert!(
            (square.entries[0] - 0.01).abs() < 1e-16 && (square.entries[1] + 0.02).abs() < 1e-16
        );
    }
}
