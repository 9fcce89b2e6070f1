use super::Triangle;
use nalgebra::{DMatrix, DVector};

/// Singular values below this part of the largest are taken as zero: the rows do not show that
/// direction.
const RANK_TOLERANCE: f64 = 1e-7;

/// Part that a parameter must have in a direction that the rows do not show, to be named.
const NAMED: f64 = 0.05;

/// A least-squares solution: of smallest norm (columns scaled to unit length) where the rows leave
/// some of it open.
#[derive(Debug, Clone)]
pub struct Solution {
    /// The parameters x, p entries.
    pub x: DVector<f64>,
    /// Their covariance for rows with errors of variance 1, p x p; infinite for what the rows do
    /// not show.
    pub covariance: DMatrix<f64>,
    /// Largest over smallest singular value of the columns scaled to unit length; infinite where
    /// the rows leave a parameter open.
    pub condition: f64,
    /// Columns that have part in a direction that the rows do not show.
    pub open: Vec<usize>,
}

impl Triangle {
    /// Solves the least-squares problem by the singular values of R with its columns scaled to unit
    /// length; directions that only rounding shows are left open.
    pub fn solve(&self) -> Solution {
        self.solve_within(RANK_TOLERANCE)
    }

    /// The same, leaving directions open whose singular value is below so much of the largest.
    pub fn solve_within(&self, tolerance: f64) -> Solution {
        let p = self.r.ncols();
        let scale: Vec<f64> = self.r.column_iter().map(|column| column.norm()).collect();
        let largest_scale = scale.iter().copied().fold(0.0, f64::max);
        // A column of zeros stays one, and is open.
        let inverse = |s: &f64| if *s > 1e-12 * largest_scale { 1.0 / s } else { 0.0 };
        let unit = DVector::from_iterator(p, scale.iter().map(inverse));
        let svd = (&self.r * DMatrix::from_diagonal(&unit)).svd(true, true);
        let (Some(u), Some(v_t)) = (&svd.u, &svd.v_t) else { unreachable!("both were asked for") };
        let sigma = &svd.singular_values;
        let cut = tolerance * sigma.max();
        let mut scaled = DVector::zeros(p);
        let mut covariance = DMatrix::zeros(p, p);
        let mut open = vec![false; p];
        for k in 0..p {
            let direction = v_t.row(k).transpose();
            if sigma[k] > cut {
                scaled += &direction * (u.column(k).dot(&self.z) / sigma[k]);
                covariance += &direction * direction.transpose() / sigma[k].powi(2);
            } else {
                open.iter_mut()
                    .zip(&direction)
                    .for_each(|(open, part)| *open |= part.abs() > NAMED);
            }
        }
        let spread = DMatrix::from_diagonal(&unit);
        let mut covariance = &spread * covariance * &spread;
        let open: Vec<usize> = (0..p).filter(|k| open[*k] || unit[*k] == 0.0).collect();
        open.iter().for_each(|k| covariance[(*k, *k)] = f64::INFINITY);
        let condition = if open.is_empty() { sigma.max() / sigma.min() } else { f64::INFINITY };
        Solution { x: scaled.component_mul(&unit), covariance, condition, open }
    }
}

impl Solution {
    /// Standard error of each parameter, for rows with errors of variance 1.
    pub fn standard_errors(&self) -> Vec<f64> {
        self.covariance.diagonal().iter().map(|variance| variance.sqrt()).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rows(columns: usize, row: impl Fn(f64) -> Vec<f64>) -> Triangle {
        Triangle::of(&(0..50).flat_map(|k| row(0.1 * k as f64)).collect::<Vec<_>>(), columns)
    }

    #[test]
    fn what_the_rows_hold_is_found() {
        let solution = rows(3, |t| vec![1e-3, t, t.sin(), 2e-3 - 3.0 * t + 0.5 * t.sin()]).solve();
        for (found, true_value) in solution.x.iter().zip([2.0, -3.0, 0.5]) {
            assert!((found - true_value).abs() < 1e-9);
        }
        assert!(solution.condition < 10.0 && solution.open.is_empty());
    }

    #[test]
    fn the_covariance_is_that_of_the_normal_equations() {
        let triangle = rows(2, |t| vec![1.0, t, 0.0]);
        let normal = (triangle.r.transpose() * &triangle.r).try_inverse().unwrap();
        assert!((triangle.solve().covariance - normal).amax() < 1e-12);
    }

    #[test]
    fn parameters_that_are_not_shown_are_named() {
        let solution = rows(4, |t| vec![t, 1.0, 2.0 * t, 0.0, 3.0 * t]).solve();
        assert_eq!(solution.open, [0, 2, 3]);
        assert!(solution.condition.is_infinite() && solution.x[1].abs() < 1e-9);
        assert!(
            solution.standard_errors()[1].is_finite()
                && solution.standard_errors()[2].is_infinite()
        );
    }
}
