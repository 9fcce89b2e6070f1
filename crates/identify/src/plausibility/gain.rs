use crate::fit::{Fit, JointFit};
use crate::regression::singular::Singular;
use crate::regression::triangular_factor::TriangularFactor;
use crate::samples::Samples;
use nalgebra::{DMatrix, DVector};
use reachtube_robot::Robot;
use schemars::JsonSchema;
use serde::Serialize;

/// Deviation of a gain from 1 beyond which it is implausible.
pub(super) const IMPLAUSIBLE_GAIN: f64 = 0.1;

/// An inverted sign must reduce the misfit of the torques below this share.
const INVERTED_MISFIT: f64 = 0.9;

/// Rounds in which implausible gains are applied and the errors of the joints are estimated again.
const GAIN_ROUNDS: usize = 4;

/// Iterations of Newton's method for the gains.
const MAX_STEPS: usize = 100;

/// The gain of one joint's torque relative to the other joints.
///
/// It follows from the dynamics: a link's mass and inertia act on its own joint and on all joints
/// before it.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct Gain {
    /// Name of the joint.
    pub joint: String,
    /// Factor by which the recorded torque must be multiplied to agree with the other joints.
    pub gain: f64,
    /// Standard error of the gain; infinite if the joint has no effect on the others' torque.
    #[schemars(with = "Option<f64>")]
    pub standard_error: f64,
}

/// Returns the gains of the joints' torques relative to the joint with the largest torque.
///
/// A joint's noise is only known once its gain is right. Implausible gains are therefore applied,
/// and all gains are estimated again.
pub(crate) fn gains(robot: &Robot, samples: &Samples, first: &GainLikelihood) -> Vec<Gain> {
    let mut found = first.gains(robot);
    let mut scaled = samples.clone();
    let mut latest = found.clone();
    for _ in 0..GAIN_ROUNDS {
        if latest.iter().all(|gain| (gain.gain - 1.0).abs() < IMPLAUSIBLE_GAIN) {
            break;
        }
        let n = samples.joints;
        scaled.torque.iter_mut().enumerate().for_each(|(r, tau)| *tau *= latest[r % n].gain);
        scaled.recorded.iter_mut().enumerate().for_each(|(r, tau)| *tau *= latest[r % n].gain);
        let joints = &Fit::of_groups(&[&scaled], false).joints[0];
        latest = GainLikelihood::with_reference(&scaled, joints, first.reference).gains(robot);
        for (found, latest) in found.iter_mut().zip(&latest) {
            (found.gain, found.standard_error) =
                (found.gain * latest.gain, latest.standard_error * found.gain);
        }
    }
    found
}

/// The likelihood of gains g of n joints, with all parameters of the robot eliminated.
///
/// The misfit of torques scaled by g is gᵀ S g. It measures how much the torques contradict each
/// other.
pub(crate) struct GainLikelihood {
    /// S, n x n.
    misfit: DMatrix<f64>,
    /// Number of independent samples of each joint.
    counts: Vec<f64>,
    /// Index of the joint with the largest torque.
    reference: usize,
}

impl GainLikelihood {
    /// Computes the likelihood from samples and the quality of their fit, one entry per joint.
    pub(crate) fn new(samples: &Samples, joints: &[JointFit]) -> Self {
        let size = |j: &usize| joints[*j].torque;
        let reference = (0..joints.len()).max_by(|a, b| size(a).total_cmp(&size(b))).unwrap_or(0);
        Self::with_reference(samples, joints, reference)
    }

    fn with_reference(samples: &Samples, joints: &[JointFit], reference: usize) -> Self {
        let (n, p) = (samples.joints, samples.columns.len());
        let used = samples.used_by_joint();
        // Outliers must not lower a gain: the root mean square includes them, unlike the robust
        // deviation.
        let weight = |j: usize| {
            let size = joints[j].residual.max(1e-6 * joints[j].torque).max(f64::MIN_POSITIVE);
            (joints[j].independent / joints[j].rows.max(1) as f64).sqrt() / size
        };
        let whole = TriangularFactor::from_written_rows(&used, p + n, |r, out| {
            let (joint, w) = (r % n, weight(r % n));
            out[..p].iter_mut().zip(samples.row(r)).for_each(|(o, y)| *o = w * y);
            out[p + joint] = w * samples.torque[r];
        });
        Self {
            misfit: eliminated(&whole, p),
            counts: joints.iter().map(|joint| joint.independent).collect(),
            reference,
        }
    }

    /// Returns the most likely gains relative to the joint with the largest torque.
    ///
    /// A gain also scales the noise of its joint, which gives the term Σ N_j log g_j of the
    /// likelihood. The result is empty if the samples do not determine the gains.
    fn gains(&self, robot: &Robot) -> Vec<Gain> {
        let Some((gains, errors)) = most_likely(&self.misfit, &self.counts, self.reference) else {
            return Vec::new();
        };
        let gain = |j: usize| Gain {
            joint: robot.joints()[j].name.clone(),
            gain: gains[j] / gains[self.reference],
            standard_error: errors[j],
        };
        (0..gains.len()).map(gain).collect()
    }

    /// Returns the joint whose torque most likely has the wrong sign, if any.
    ///
    /// The second value is the share of the misfit that remains with the other sign.
    pub(super) fn inverted_torque(&self) -> Option<(usize, f64)> {
        let n = self.counts.len();
        let squares = |inverted: Option<usize>| {
            let g = DVector::from_fn(n, |j, _| if inverted == Some(j) { -1.0 } else { 1.0 });
            g.dot(&(&self.misfit * &g))
        };
        let here = squares(None);
        let best =
            (0..n).map(|j| (j, squares(Some(j)) / here)).min_by(|a, b| a.1.total_cmp(&b.1))?;
        (best.1 < INVERTED_MISFIT).then_some(best)
    }
}

/// Returns S, the misfit of the columns after the first p that no parameters can fit.
///
/// The first p columns may be linearly dependent.
fn eliminated(whole: &TriangularFactor, p: usize) -> DMatrix<f64> {
    let n = whole.r.ncols() - p;
    let Singular { u, values, .. } = Singular::of(&whole.r.columns(0, p).into_owned());
    let cut = 1e-9 * values.max();
    let mut torque = whole.r.columns(p, n).into_owned();
    for k in (0..p).filter(|k| values[*k] > cut) {
        let direction = u.column(k);
        let part = direction.transpose() * &torque;
        torque -= direction * part;
    }
    torque.transpose() * torque
}

/// Minimises ½ gᵀ S g - Σ N_j log g_j by Newton's method in log g.
///
/// Returns g and the standard errors of log g_j - log g_reference.
fn most_likely(
    misfit: &DMatrix<f64>,
    counts: &[f64],
    reference: usize,
) -> Option<(Vec<f64>, Vec<f64>)> {
    let n = counts.len();
    let mut log_gains = DVector::zeros(n);
    let mut factor = None;
    for _ in 0..MAX_STEPS {
        let g = log_gains.map(f64::exp);
        let pull = misfit * &g;
        let gradient = DVector::from_fn(n, |j, _| g[j] * pull[j] - counts[j]);
        let mut hessian = DMatrix::from_fn(n, n, |i, j| g[i] * misfit[(i, j)] * g[j]);
        // The diagonal curvature g_j (S g)_j may be negative on the way. N_j, its value at the
        // minimum, takes its place.
        (0..n).for_each(|j| hessian[(j, j)] += counts[j]);
        let decomposed = hessian.cholesky()?;
        let step: DVector<f64> = decomposed.solve(&gradient);
        log_gains -= &step * (0.5 / step.amax().max(0.5));
        factor = Some(decomposed);
        if step.amax() < 1e-9 {
            break;
        }
    }
    let covariance = factor?.inverse();
    let variance = |j: usize| {
        covariance[(j, j)] + covariance[(reference, reference)] - 2.0 * covariance[(j, reference)]
    };
    Some((
        log_gains.iter().map(|log_gain| log_gain.exp()).collect(),
        (0..n).map(|j| variance(j).max(0.0).sqrt()).collect(),
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The factor of two joints whose torques are both a sine of unknown amplitude. The second
    /// torque is recorded at half scale and with the given sign.
    fn two_joints(sign: f64) -> TriangularFactor {
        let noise = |k: usize| 0.01 * (((k * 7919) % 1009) as f64 / 1009.0 - 0.5) * 12f64.sqrt();
        let row = |k: usize| {
            let x = (0.1 * k as f64).sin();
            let second = sign * 0.5 * (2.0 * x + noise(3 * k + 500));
            [
                [x, 2.0 * x + noise(k), 0.0, 0.0].map(|v| v / 0.01),
                [x, 0.0, second, 0.0].map(|v| v / 0.01),
            ]
            .concat()
        };
        TriangularFactor::from_rows(&(0..400).flat_map(row).collect::<Vec<_>>(), 3)
    }

    #[test]
    fn the_most_likely_gain_restores_a_scaled_torque() {
        let (gains, errors) =
            most_likely(&eliminated(&two_joints(1.0), 1), &[400.0, 400.0], 0).unwrap();
        assert!((gains[1] / gains[0] - 2.0).abs() < 0.1 && errors[1] < 0.1, "{gains:?} {errors:?}");
    }

    #[test]
    fn an_inverted_torque_contradicts_the_other() {
        let likelihood = |sign| GainLikelihood {
            misfit: eliminated(&two_joints(sign), 1),
            counts: vec![400.0; 2],
            reference: 0,
        };
        assert!(likelihood(-1.0).inverted_torque().is_some());
        assert!(likelihood(1.0).inverted_torque().is_none());
    }
}
