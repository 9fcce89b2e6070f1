use crate::regression::residuals::{
    autocorrelation_time, huber_row_factor, robust_standard_deviation, root_mean_square,
};
use crate::regression::solution::Solution;
use crate::regression::triangular_factor::TriangularFactor;
use crate::samples::Samples;
use schemars::JsonSchema;
use serde::Serialize;

/// Condition beyond which a combination of parameters counts as undetermined: a rigid robot's
/// torque is not known to one part in ten thousand of a column.
pub(crate) const CONDITION_LIMIT: f64 = 1e4;

/// Rounds of reweighting; the weights change by less than 1 % after three.
const ROUNDS: usize = 4;

/// Robust standard deviations beyond which a residual counts as an outlier.
///
/// Errors of the model are larger than noise for whole stretches of a motion. A lower limit would
/// take weight from such stretches, and predict other motions worse than plain least squares does.
const OUTLIER_DEVIATIONS: f64 = 4.0;

/// Lower bound of a joint's standard deviation, relative to the root mean square of its torque.
const MIN_RELATIVE_DEVIATION: f64 = 1e-6;

/// A robust regression over groups of samples that differ in their noise.
#[derive(Debug, Clone)]
pub struct Fit {
    /// Triangular factor of all rows in units of their standard deviation, weighted so that only
    /// independent samples count.
    pub whitened: TriangularFactor,
    /// The solution of the whitened rows.
    pub solution: Solution,
    /// Quality of the fit, one entry per group and joint.
    pub joints: Vec<Vec<JointFit>>,
}

/// Quality of the fit of one joint's torque in a group of samples.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, JsonSchema)]
pub struct JointFit {
    /// Number of rows that were used.
    pub rows: usize,
    /// Number of independent rows by the autocorrelation of the residuals.
    pub independent: f64,
    /// Root mean square of the residuals \[N m\].
    pub residual: f64,
    /// Root mean square of the recorded torque \[N m\].
    pub torque: f64,
    /// Robust standard deviation of the residuals \[N m\].
    pub deviation: f64,
    /// Share of the rows whose residual exceeds three standard deviations.
    pub outliers: f64,
}

impl JointFit {
    /// Returns the ratio of the residual to the torque, both as root mean squares.
    #[must_use]
    pub fn relative(&self) -> f64 {
        if self.torque > 0.0 { self.residual / self.torque } else { 0.0 }
    }
}

impl Fit {
    /// Fits θ to groups with the same columns by iteratively reweighted least squares.
    ///
    /// Each group and joint has its own standard deviation. Outliers lose weight by Huber's
    /// function unless `plain` is set. The final weights count independent samples only.
    pub(crate) fn of_groups(groups: &[&Samples], plain: bool) -> Self {
        // First weights: the reciprocal size of each joint's torque.
        let first = |samples: &&Samples| {
            let size = |joint: usize| {
                root_mean_square(flat(samples, &samples.torque, joint).into_iter())
                    .max(f64::MIN_POSITIVE)
            };
            let sizes: Vec<f64> = (0..samples.joints).map(size).collect();
            (0..samples.len()).map(|r| sizes[r % samples.joints].recip()).collect()
        };
        let mut weights: Vec<Vec<f64>> = groups.iter().map(first).collect();
        // Reweighting.
        for _ in 0..ROUNDS {
            let theta = joined(groups, &weights).solve().x;
            for (samples, weights) in groups.iter().zip(&mut weights) {
                *weights = reweighted(samples, &samples.residuals(&theta), plain, 1.0);
            }
        }
        // Quality of the fit, and weights that count independent samples only.
        let theta = joined(groups, &weights).solve().x;
        let mut joints = Vec::new();
        for (samples, weights) in groups.iter().zip(&mut weights) {
            let residuals = samples.residuals(&theta);
            let fits: Vec<JointFit> =
                (0..samples.joints).map(|joint| joint_fit(samples, &residuals, joint)).collect();
            let rows: usize = fits.iter().map(|fit| fit.rows).sum();
            let independent: f64 = fits.iter().map(|fit| fit.independent).sum();
            let inflation = rows.max(1) as f64 / independent.max(1.0);
            *weights = reweighted(samples, &residuals, plain, inflation);
            joints.push(fits);
        }
        let whitened = joined(groups, &weights);
        Self { solution: whitened.solve(), whitened, joints }
    }
}

fn joined(groups: &[&Samples], weights: &[Vec<f64>]) -> TriangularFactor {
    let parts: Vec<TriangularFactor> = groups
        .iter()
        .zip(weights)
        .map(|(samples, weights)| samples.weighted_factor(weights))
        .collect();
    TriangularFactor::joined(&parts)
}

fn flat(samples: &Samples, values: &[f64], joint: usize) -> Vec<f64> {
    samples.joint_values(values, joint).concat()
}

/// Returns the factor of each row: the reciprocal of its standard deviation, less for outliers.
///
/// `inflation` is the number of rows that count as one independent row. All joints share it:
/// residuals that last are errors of the model, and a joint with such errors is not less important.
fn reweighted(samples: &Samples, residuals: &[f64], plain: bool, inflation: f64) -> Vec<f64> {
    let noise: Vec<TorqueNoise> = (0..samples.joints)
        .map(|joint| TorqueNoise::of_joint(samples, residuals, joint, plain))
        .collect();
    let weight = |(r, residual): (usize, &f64)| {
        let noise = &noise[r % samples.joints];
        huber_row_factor(*residual, noise.outlier) / (noise.deviation * inflation.sqrt())
    };
    residuals.iter().enumerate().map(weight).collect()
}

/// The noise of one joint's torque.
struct TorqueNoise {
    /// Size beyond which a residual is an outlier \[N m\]; infinite for a plain fit.
    outlier: f64,
    /// Root mean square of the residuals, outliers with less weight \[N m\].
    deviation: f64,
}

impl TorqueNoise {
    fn of_joint(samples: &Samples, residuals: &[f64], joint: usize, plain: bool) -> Self {
        let torque = flat(samples, &samples.torque, joint);
        let residuals = flat(samples, residuals, joint);
        let robust = robust_deviation(&residuals, &torque);
        let outlier = if plain { f64::INFINITY } else { OUTLIER_DEVIATIONS * robust };
        let weighted = residuals.iter().map(|r| r * huber_row_factor(*r, outlier));
        Self { outlier, deviation: root_mean_square(weighted).max(least_deviation(&torque)) }
    }
}

fn robust_deviation(residuals: &[f64], torque: &[f64]) -> f64 {
    robust_standard_deviation(residuals).max(least_deviation(torque))
}

/// Returns a lower bound that keeps the weights finite for exact data \[N m\].
fn least_deviation(torque: &[f64]) -> f64 {
    let size = root_mean_square(torque.iter().copied()).max(f64::MIN_POSITIVE);
    MIN_RELATIVE_DEVIATION * size
}

fn joint_fit(samples: &Samples, residuals: &[f64], joint: usize) -> JointFit {
    let by_log = samples.joint_values(residuals, joint);
    let torque = flat(samples, &samples.recorded, joint);
    let all = by_log.concat();
    let series: Vec<&[f64]> = by_log.iter().map(Vec::as_slice).collect();
    let deviation = robust_deviation(&all, &torque);
    JointFit {
        rows: all.len(),
        independent: all.len() as f64 / autocorrelation_time(&series),
        residual: root_mean_square(all.iter().copied()),
        torque: root_mean_square(torque.into_iter()),
        deviation,
        outliers: all.iter().filter(|r| r.abs() > 3.0 * deviation).count() as f64
            / all.len().max(1) as f64,
    }
}
