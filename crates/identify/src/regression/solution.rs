use crate::regression::singular::{Singular, UnitSingular};
use crate::regression::triangular_factor::TriangularFactor;
use nalgebra::{DMatrix, DVector};

/// A parameter is undetermined if its entry in an undetermined unit direction exceeds this value.
const MIN_ENTRY: f64 = 0.05;

/// A least-squares solution for p parameters.
///
/// Where the rows do not determine a direction, the solution has the smallest norm in columns
/// scaled to unit length.
#[derive(Debug, Clone)]
pub struct Solution {
    /// Parameters x, p entries.
    pub x: DVector<f64>,
    /// Covariance of x for rows with errors of variance 1, p x p.
    ///
    /// The variance of an undetermined parameter is infinite.
    pub covariance: DMatrix<f64>,
    /// Condition number: largest over smallest singular value of the columns scaled to unit length.
    ///
    /// It is infinite if a parameter is undetermined.
    pub condition: f64,
    /// Indices of the parameters that the rows do not determine.
    pub undetermined: Vec<usize>,
}

impl TriangularFactor {
    /// Solves the least-squares problem by the singular values of R, its columns scaled to unit
    /// length.
    ///
    /// Directions that only rounding determines count as undetermined.
    #[must_use]
    pub(crate) fn solve(&self) -> Solution {
        let p = self.r.ncols();
        let UnitSingular { unit, singular, cut } = UnitSingular::of(&self.r);
        let Singular { u, values: sigma, v } = singular;
        // Solution and covariance from the determined directions.
        let mut scaled = DVector::zeros(p);
        let mut covariance = DMatrix::zeros(p, p);
        let mut undetermined = vec![false; p];
        for k in 0..p {
            let direction = v.column(k);
            if sigma[k] > cut {
                scaled += direction * (u.column(k).dot(&self.z) / sigma[k]);
                covariance += direction * direction.transpose() / sigma[k].powi(2);
            } else {
                undetermined
                    .iter_mut()
                    .zip(direction.iter())
                    .for_each(|(flag, entry)| *flag |= entry.abs() > MIN_ENTRY);
            }
        }
        // Back to the units of the parameters.
        let spread = DMatrix::from_diagonal(&unit);
        let mut covariance = &spread * covariance * &spread;
        let undetermined: Vec<usize> =
            (0..p).filter(|k| undetermined[*k] || unit[*k] == 0.0).collect();
        undetermined.iter().for_each(|k| covariance[(*k, *k)] = f64::INFINITY);
        let condition =
            if undetermined.is_empty() { sigma.max() / sigma.min() } else { f64::INFINITY };
        Solution { x: scaled.component_mul(&unit), covariance, condition, undetermined }
    }
}

impl Solution {
    /// Returns the standard error of each parameter, for rows with errors of variance 1.
    #[must_use]
    pub(crate) fn standard_errors(&self) -> Vec<f64> {
        self.covariance.diagonal().iter().map(|variance| variance.sqrt()).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rows(columns: usize, row: impl Fn(f64) -> Vec<f64>) -> TriangularFactor {
        let rows: Vec<f64> = (0..50).flat_map(|k| row(0.1 * k as f64)).collect();
        TriangularFactor::from_rows(&rows, columns)
    }

    #[test]
    fn exact_rows_give_their_parameters() {
        let solution = rows(3, |t| vec![1e-3, t, t.sin(), 2e-3 - 3.0 * t + 0.5 * t.sin()]).solve();
        for (found, true_value) in solution.x.iter().zip([2.0, -3.0, 0.5]) {
            assert!((found - true_value).abs() < 1e-9);
        }
        assert!(solution.condition < 10.0 && solution.undetermined.is_empty());
    }

    #[test]
    fn the_covariance_is_the_inverse_normal_matrix() {
        let factor = rows(2, |t| vec![1.0, t, 0.0]);
        let normal = (factor.r.transpose() * &factor.r).try_inverse().unwrap();
        assert!((factor.solve().covariance - normal).amax() < 1e-12);
    }

    #[test]
    fn undetermined_parameters_are_named() {
        let solution = rows(4, |t| vec![t, 1.0, 2.0 * t, 0.0, 3.0 * t]).solve();
        assert_eq!(solution.undetermined, [0, 2, 3]);
        assert!(solution.condition.is_infinite() && solution.x[1].abs() < 1e-9);
        assert!(
            solution.standard_errors()[1].is_finite()
                && solution.standard_errors()[2].is_infinite()
        );
    }
}
