use crate::bodies::RisingFriction;
use crate::friction::falling::{FallingFriction, JointColumns, ViscousColumns, nearest};
use crate::friction::form::CoulombForm;
use crate::friction::sample::{FrictionSample, quadrant_counts};
use crate::regression::residuals::{
    HUBER_DEVIATIONS, autocorrelation_time, huber_row_factor, robust_standard_deviation,
    root_mean_square,
};
use crate::regression::solution::Solution;
use crate::regression::triangular_factor::TriangularFactor;
use nalgebra::DVector;
use reachtube_robot::{FrictionDescription, Robot};
use schemars::JsonSchema;
use serde::Serialize;
use std::convert::Infallible;

/// Rounds of reweighting.
const ROUNDS: usize = 4;

/// Samples of a joint below which its friction is not fitted.
const MIN_SAMPLES: usize = 50;

/// The fitted friction of one joint.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct JointFriction {
    /// Name of the joint.
    pub joint: String,
    /// Coefficients a1 to a8 and v1 to v3.
    pub coefficients: FrictionDescription,
    /// Standard errors of the coefficients, 0 for coefficients that are fixed by the form.
    pub standard_errors: FrictionDescription,
    /// Dependence of Coulomb friction on the load.
    pub form: CoulombForm,
    /// Number of samples in each quadrant, in the order of a1 to a8.
    pub quadrants: [usize; 4],
    /// Share of the torque's variance that gravity, friction and the joint's inertia explain.
    pub r2: f64,
    /// Share of the variance of torque minus gravity that friction and the joint's inertia explain.
    pub r2_without_gravity: f64,
    /// Root mean square of the residuals \[N m\].
    pub residual: f64,
    /// Condition number of the regression, columns scaled to unit length.
    #[schemars(with = "Option<f64>")]
    pub condition: f64,
    /// Inertia about the joint, which is fitted together with friction \[kg m²\].
    pub inertia: f64,
    /// Number of samples, and the number of independent ones among them.
    pub samples: (usize, f64),
    /// Viscous friction of least squares, if it falls with speed and was not used.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub falling: Option<FallingFriction>,
}

/// A joint's friction fit with its samples and residuals.
#[derive(Debug, Clone)]
pub struct FrictionFit {
    /// The fitted friction.
    pub joint: JointFriction,
    /// The samples.
    pub samples: Vec<FrictionSample>,
    /// Residual torque of each sample \[N m\].
    pub residuals: Vec<f64>,
}

impl FrictionFit {
    /// Adds the relative standard errors of the loads, one per joint of the robot, to the errors of
    /// the slopes in the load: a load that is off by a part changes torque minus load by that part
    /// of the load.
    pub(crate) fn add_load_error(&mut self, robot: &Robot, load_errors: &[f64]) {
        let joints = robot.joints().iter().zip(load_errors);
        let own = joints.into_iter().find(|(joint, _)| joint.name == self.joint.joint);
        let Some((_, load_error)) = own else { return };
        let slopes = self.joint.coefficients.coulomb.iter().skip(1).step_by(2);
        let errors = self.joint.standard_errors.coulomb.iter_mut().skip(1).step_by(2);
        for (error, slope) in errors.zip(slopes).filter(|(error, _)| **error > 0.0) {
            *error = error.hypot(load_error * (1.0 + slope));
        }
    }
}

/// Fits (5) to (9) to the samples of one joint: Coulomb friction, a cubic in q̇, and the joint's
/// inertia.
///
/// Coulomb friction has the richest [`CoulombForm`] that the samples determine, and viscous
/// friction rises up to the speed `limit` \[rad/s\]. The result is `None` for fewer than 50
/// samples.
#[must_use]
pub(crate) fn fit(name: &str, samples: &[FrictionSample], limit: f64) -> Option<FrictionFit> {
    if samples.len() < MIN_SAMPLES {
        return None;
    }
    Some(fit_form(name, samples, CoulombForm::determined_by(samples), limit))
}

fn fit_form(name: &str, samples: &[FrictionSample], form: CoulombForm, limit: f64) -> FrictionFit {
    let (mut solution, weights) = robust_solution(form, samples);
    let falling = rise(name, (form, samples, &weights), limit, &mut solution.x);
    let residuals = residuals(form, samples, &solution.x);
    // Standard errors that count independent samples only.
    let time = autocorrelation_time(&[&residuals]);
    let scale = robust_standard_deviation(&residuals)
        .max(root_mean_square(residuals.iter().zip(&weights).map(|(r, w)| r * w)))
        * time.sqrt();
    let errors: Vec<f64> = solution.standard_errors().iter().map(|e| e * scale).collect();
    // Explained variance.
    let unexplained = variation(residuals.clone());
    let joint = JointFriction {
        joint: name.into(),
        coefficients: form.description(solution.x.as_slice()),
        standard_errors: form.errors(&errors),
        form,
        quadrants: quadrant_counts(samples),
        r2: 1.0 - unexplained / variation(samples.iter().map(|s| s.torque + s.load).collect()),
        r2_without_gravity: 1.0
            - unexplained / variation(samples.iter().map(|s| s.torque).collect()),
        residual: root_mean_square(residuals.iter().copied()),
        condition: solution.condition,
        inertia: solution.x[form.inertia()],
        samples: (samples.len(), samples.len() as f64 / time),
        falling,
    };
    FrictionFit { joint, samples: samples.to_vec(), residuals }
}

/// Replaces a solution whose viscous friction falls with speed before `limit` \[rad/s\] by the
/// nearest whose friction rises. Returns the friction that was replaced.
fn rise(
    name: &str,
    (form, samples, weights): (CoulombForm, &[FrictionSample], &[f64]),
    limit: f64,
    x: &mut DVector<f64>,
) -> Option<FallingFriction> {
    let sizes = |x: &DVector<f64>| vec![root_mean_square(residuals(form, samples, x).into_iter())];
    let deviation = sizes(x)[0].max(f64::MIN_POSITIVE);
    let factor = weighted_factor(form, samples, weights);
    let joint = (0, name.into());
    let own = JointColumns { joint, columns: form.viscous().map(Some), known: [0.0; 3], limit };
    let columns = ViscousColumns { joints: vec![own], data: &factor };
    let solve = |conditions: &[RisingFriction]| {
        Ok::<_, Infallible>(nearest(&factor, deviation, conditions))
    };
    let Ok(mut replaced) = columns.rise(x, solve, sizes);
    replaced.pop()
}

/// Returns the solution by iteratively reweighted least squares, and the factors of the rows.
fn robust_solution(form: CoulombForm, samples: &[FrictionSample]) -> (Solution, Vec<f64>) {
    let mut weights = vec![1.0; samples.len()];
    for _ in 0..ROUNDS {
        let left = residuals(form, samples, &weighted_factor(form, samples, &weights).solve().x);
        let limit = HUBER_DEVIATIONS * robust_standard_deviation(&left);
        weights = left.iter().map(|r| huber_row_factor(*r, limit)).collect();
    }
    (weighted_factor(form, samples, &weights).solve(), weights)
}

fn weighted_factor(
    form: CoulombForm,
    samples: &[FrictionSample],
    weights: &[f64],
) -> TriangularFactor {
    let columns = form.columns();
    let all: Vec<usize> = (0..samples.len()).collect();
    TriangularFactor::from_written_rows(&all, columns, |k, out| {
        let (row, w) = (form.row(&samples[k]), weights[k]);
        out[..columns].iter_mut().zip(&row).for_each(|(o, v)| *o = w * v);
        out[columns] = w * samples[k].torque;
    })
}

fn residuals(form: CoulombForm, samples: &[FrictionSample], x: &DVector<f64>) -> Vec<f64> {
    let residual = |s: &FrictionSample| {
        s.torque - form.row(s).iter().zip(x.iter()).map(|(a, x)| a * x).sum::<f64>()
    };
    samples.iter().map(residual).collect()
}

/// Returns the sum of squared deviations from the mean.
fn variation(values: Vec<f64>) -> f64 {
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    values.iter().map(|v| (v - mean).powi(2)).sum::<f64>()
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::RngExt;
    use rand_xoshiro::SplitMix64;
    use rand_xoshiro::rand_core::SeedableRng;
    use reachtube_robot::friction::{Coulomb, Viscous};

    const A: [f64; 8] = [4.46, 0.38, -5.46, 0.32, -4.64, 0.041, 4.08, -0.0019];

    /// Samples of a joint that swings through loads of up to `load`, with torque noise of standard
    /// deviation `noise` \[N m\].
    fn swings(a: [f64; 8], load: f64, noise: f64) -> Vec<FrictionSample> {
        let (coulomb, viscous) =
            (Coulomb::from_coefficients(a), Viscous { v1: 10.08, v2: 0.1, v3: -1.02 });
        let mut generator = SplitMix64::seed_from_u64(7);
        let mut random = || generator.random::<f64>() - 0.5;
        let sample = |k: usize| {
            let t = 0.01 * k as f64;
            let (qd, qdd, load) = ((0.7 * t).sin(), 0.7 * (0.7 * t).cos(), load * (0.11 * t).cos());
            let torque = coulomb.torque(load, qd)
                + viscous.torque(&qd)
                + 1.7 * qdd
                + noise * random() * 12f64.sqrt();
            FrictionSample { qd, qdd, load, torque }
        };
        (1..12_000).map(sample).filter(|s| s.qd.abs() > 0.02).collect()
    }

    #[test]
    fn the_quadrants_of_joint_2_of_the_paper_are_found() {
        let found = fit("joint2", &swings(A, 30.0, 0.3), 1.0).unwrap().joint;
        assert_eq!(found.form, CoulombForm::Quadrants);
        let (mut within, mut count) = (0, 0);
        let true_values = A.iter().chain(&[10.08, 0.1, -1.02]);
        let found_values = found.coefficients.coulomb.iter().chain(&found.coefficients.viscous);
        let errors = found.standard_errors.coulomb.iter().chain(&found.standard_errors.viscous);
        for ((value, found), error) in true_values.zip(found_values).zip(errors) {
            assert!(
                (value - found).abs() < 4.0 * error && *error < 0.3,
                "{value}: {found} ± {error}"
            );
            within += usize::from((value - found).abs() < 2.0 * error);
            count += 1;
        }
        assert!(within >= count - 2, "{within} of {count} within two standard errors");
        assert!((found.inertia - 1.7).abs() < 0.05 && found.r2 > 0.99);
    }

    #[test]
    fn a_joint_without_load_has_one_value_per_direction() {
        let found = fit("joint1", &swings(A, 0.0, 0.1), 1.0).unwrap().joint;
        assert_eq!(found.form, CoulombForm::Constant);
        let [_, _, a3, _, a5, _, a7, _] = found.coefficients.coulomb;
        assert!(
            (a3 + 4.64).abs() < 0.05 && a3 == a5 && (a7 - 4.08).abs() < 0.05,
            "{:?}",
            found.coefficients
        );
    }

    #[test]
    fn outliers_hardly_change_the_fit() {
        let mut samples = swings(A, 30.0, 0.1);
        let clean = fit("j", &samples, 1.0).unwrap().joint.coefficients;
        samples.iter_mut().step_by(25).for_each(|s| s.torque += 80.0);
        let disturbed = fit("j", &samples, 1.0).unwrap().joint.coefficients;
        let off = clean
            .coulomb
            .iter()
            .zip(&disturbed.coulomb)
            .map(|(a, b)| (a - b).abs())
            .max_by(f64::total_cmp)
            .unwrap();
        assert!(off < 0.1, "{off}");
        assert!(fit("j", &samples[..40], 1.0).is_none());
    }
}
