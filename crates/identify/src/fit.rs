use super::regression::{
    Solution, Triangle, huber_weight, robust_deviation, root_mean_square,
    samples_per_independent_one,
};
use super::samples::Samples;
use serde::Serialize;

/// Rounds of reweighting; the weights move by less than a percent after three.
const ROUNDS: usize = 4;

/// A joint's torque is never taken as known better than this part of its size.
const LEAST_DEVIATION: f64 = 1e-6;

/// A robust regression over groups of samples that differ in how exact they are.
#[derive(Debug, Clone)]
pub struct Fit {
    /// The factor of all rows, in units of their standard deviation, as many as are independent.
    pub whitened: Triangle,
    /// The solution: smallest where the rows leave some of it open.
    pub solution: Solution,
    /// For each group, joint by joint.
    pub joints: Vec<Vec<JointFit>>,
}

/// How well one joint's torque was fitted in a group of samples.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct JointFit {
    /// Rows that counted.
    pub rows: usize,
    /// How many of them are independent, by the autocorrelation of the residuals.
    pub independent: f64,
    /// Root mean square of the residuals \[N m\].
    pub residual: f64,
    /// Root mean square of the recorded torque \[N m\].
    pub torque: f64,
    /// Robust standard deviation of the residuals \[N m\].
    pub deviation: f64,
    /// Part of the rows beyond three deviations.
    pub outliers: f64,
}

impl JointFit {
    /// Residual over torque, root mean squares.
    pub fn relative(&self) -> f64 {
        if self.torque > 0.0 { self.residual / self.torque } else { 0.0 }
    }
}

impl Fit {
    /// Fits θ to groups with the same columns: least squares with weights per group and joint,
    /// iterated with Huber's weights (unless `plain`); the final rows are weighted by how many are
    /// independent.
    pub fn of(groups: &[&Samples], plain: bool) -> Self {
        let first = |samples: &&Samples| {
            let size = |joint: usize| {
                root_mean_square(flat(samples, &samples.torque, joint).into_iter())
                    .max(f64::MIN_POSITIVE)
            };
            let sizes: Vec<f64> = (0..samples.joints).map(size).collect();
            (0..samples.len()).map(|r| sizes[r % samples.joints].recip()).collect()
        };
        let mut weights: Vec<Vec<f64>> = groups.iter().map(first).collect();
        for _ in 0..ROUNDS {
            let theta = joined(groups, &weights).solve().x;
            for (samples, weights) in groups.iter().zip(&mut weights) {
                *weights = reweighted(
                    samples,
                    &samples.residuals(&theta),
                    plain,
                    &vec![1.0; samples.joints],
                );
            }
        }
        let theta = joined(groups, &weights).solve().x;
        let mut joints = Vec::new();
        for (samples, weights) in groups.iter().zip(&mut weights) {
            let residuals = samples.residuals(&theta);
            let fits: Vec<JointFit> =
                (0..samples.joints).map(|joint| joint_fit(samples, &residuals, joint)).collect();
            let inflation: Vec<f64> =
                fits.iter().map(|fit| fit.rows.max(1) as f64 / fit.independent.max(1.0)).collect();
            *weights = reweighted(samples, &residuals, plain, &inflation);
            joints.push(fits);
        }
        let whitened = joined(groups, &weights);
        Self { solution: whitened.solve(), whitened, joints }
    }
}

fn joined(groups: &[&Samples], weights: &[Vec<f64>]) -> Triangle {
    let parts: Vec<Triangle> =
        groups.iter().zip(weights).map(|(samples, weights)| samples.triangle(weights)).collect();
    Triangle::of_all(&parts)
}

fn flat(samples: &Samples, values: &[f64], joint: usize) -> Vec<f64> {
    samples.of_joint(values, joint).concat()
}

/// One over the standard deviation of each row, less for outliers; `inflation` rows count as one.
fn reweighted(samples: &Samples, residuals: &[f64], plain: bool, inflation: &[f64]) -> Vec<f64> {
    let deviation = |joint: usize| {
        deviation(&flat(samples, residuals, joint), &flat(samples, &samples.torque, joint), plain)
    };
    let deviations: Vec<f64> = (0..samples.joints).map(deviation).collect();
    let weight = |(r, residual): (usize, &f64)| {
        let joint = r % samples.joints;
        let huber = if plain { 1.0 } else { huber_weight(*residual, deviations[joint]) };
        huber / (deviations[joint] * inflation[joint].sqrt())
    };
    residuals.iter().enumerate().map(weight).collect()
}

/// The standard deviation of a joint's residuals: robust, but never below what exact data would
/// give.
fn deviation(residuals: &[f64], torque: &[f64], plain: bool) -> f64 {
    let size = root_mean_square(torque.iter().copied()).max(f64::MIN_POSITIVE);
    let spread = if plain {
        root_mean_square(residuals.iter().copied())
    } else {
        robust_deviation(residuals)
    };
    spread.max(LEAST_DEVIATION * size)
}

fn joint_fit(samples: &Samples, residuals: &[f64], joint: usize) -> JointFit {
    let (own, torque) =
        (samples.of_joint(residuals, joint), flat(samples, &samples.recorded, joint));
    let all = own.concat();
    let series: Vec<&[f64]> = own.iter().map(Vec::as_slice).collect();
    let deviation = deviation(&all, &torque, false);
    JointFit {
        rows: all.len(),
        independent: all.len() as f64 / samples_per_independent_one(&series),
        residual: root_mean_square(all.iter().copied()),
        torque: root_mean_square(torque.into_iter()),
        deviation,
        outliers: all.iter().filter(|r| r.abs() > 3.0 * deviation).count() as f64
            / all.len().max(1) as f64,
    }
}
