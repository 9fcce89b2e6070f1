//! Small dense matrices of `f64`, row by row, and sums of products that are bounded from above.

/// A square matrix, row by row.
#[derive(Debug, Clone)]
pub(super) struct Square {
    pub n: usize,
    pub entries: Vec<f64>,
}

impl Square {
    pub fn zero(n: usize) -> Self {
        Self { n, entries: vec![0.0; n * n] }
    }

    pub fn row(&self, i: usize) -> &[f64] {
        &self.entries[i * self.n..(i + 1) * self.n]
    }

    /// `self = left right`, each entry a sum of n products in floating point.
    pub fn set_product(&mut self, left: &Self, right: &Self) {
        self.entries.fill(0.0);
        let n = self.n;
        for (i, sum) in self.entries.chunks_exact_mut(n.max(1)).enumerate() {
            for (k, &x) in left.row(i).iter().enumerate().filter(|(_, x)| **x != 0.0) {
                sum.iter_mut().zip(right.row(k)).for_each(|(sum, y)| *sum += x * y);
            }
        }
    }

    /// `out = self column`, in floating point.
    pub fn apply(&self, column: &[f64], out: &mut [f64]) {
        for (i, out) in out.iter_mut().enumerate() {
            *out = self.row(i).iter().zip(column).map(|(x, y)| x * y).sum();
        }
    }

    /// `out >= |self| column` for a column >= 0.
    pub fn apply_absolute(&self, column: &[f64], out: &mut [f64]) {
        for (i, out) in out.iter_mut().enumerate() {
            let sum = self.row(i).iter().zip(column).map(|(x, y)| x.abs() * y).sum();
            *out = raised(sum, self.n);
        }
    }
}

/// An upper bound of a sum of products >= 0, `terms` of them, whose value in floating point is
/// `sum`.
///
/// In any order the rounded sum is at least 1 - γ_N times the exact one (Higham, Accuracy and
/// Stability of Numerical Algorithms, section 3.1), and γ_N is at most N ε for N below 2⁵⁰; the
/// last term covers products that underflow. One more product with a factor >= 0 in each term, and
/// one in front of the sum, are covered as well.
pub(super) fn raised(sum: f64, terms: usize) -> f64 {
    sum * (1.0 + (terms + 4) as f64 * f64::EPSILON) + f64::MIN_POSITIVE
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn upper_bounds_are_above_and_close() {
        let matrix = Square { n: 2, entries: vec![0.1, -0.2, 1e-200, 0.0] };
        let mut out = [0.0; 2];
        matrix.apply_absolute(&[0.7, 0.3], &mut out);
        // 0.07 + 0.06 in exact decimals, to within the roundings of the four factors.
        assert!(out[0] > 0.13 && out[0] < 0.13 + 1e-15);
        matrix.apply_absolute(&[1e-200, 0.0], &mut out);
        assert!(out[1] > 0.0);
        let mut square = Square::zero(2);
        square.set_product(&matrix, &matrix);
        assert!(
            (square.entries[0] - 0.01).abs() < 1e-16 && (square.entries[1] + 0.02).abs() < 1e-16
        );
    }
}
