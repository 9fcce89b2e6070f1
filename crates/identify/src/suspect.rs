//! Mistakes of sign and gain, told from what a rigid body cannot do.

use super::fit::{Fit, JointFit};
use super::inertia::InertiaFit;
use super::prepare::Log;
use super::regression::Triangle;
use super::samples::{Known, Samples, Sampling};
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;
use reachtube_robot::{Column, ColumnKind, FrictionDescription, Robot};
use serde::Serialize;

/// Gains further from 1 than this, and than four standard errors, are said.
const GAIN_OFF: f64 = 0.1;

/// Standard errors of a gain below which it is not said.
const SURE: f64 = 4.0;

/// A joint whose torque is left unexplained by more than this part is looked at for a wrong sign.
pub const POOR: f64 = 0.3;

/// A turned sign must bring the sum of squares below this part.
const BETTER: f64 = 0.5;

/// A torque whose sign is turned must bring the contradiction of the torques below this part.
const TURNED: f64 = 0.9;

/// Samples that are enough to tell a sign.
const SIGN_SAMPLES: f64 = 800.0;

/// The gain of one joint's torque against those of the others, from the forces that the links hand
/// each other.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Gain {
    /// The joint's name.
    pub joint: String,
    /// What its torque must be multiplied with to agree with the others.
    pub gain: f64,
    /// Standard error; infinite where the joint has no part in the others' torque.
    pub standard_error: f64,
}

/// Rounds in which gains that contradict each other are applied and the errors of the joints found
/// again.
const GAIN_ROUNDS: usize = 4;

/// The gains of the joints' torques against each other, relative to the joint with the largest
/// torque.
///
/// What a joint's errors are is only known once its gain is right, so that gains that are off are
/// applied, and found again.
pub fn gains(robot: &Robot, samples: &Samples, first: &Consistency) -> Vec<Gain> {
    let mut found = first.gains(robot);
    let mut scaled = samples.clone();
    let mut latest = found.clone();
    for _ in 0..GAIN_ROUNDS {
        if latest.iter().all(|gain| (gain.gain - 1.0).abs() < GAIN_OFF) {
            break;
        }
        let n = samples.joints;
        scaled.torque.iter_mut().enumerate().for_each(|(r, tau)| *tau *= latest[r % n].gain);
        scaled.recorded.iter_mut().enumerate().for_each(|(r, tau)| *tau *= latest[r % n].gain);
        latest = Consistency::with_reference(
            &scaled,
            &Fit::of(&[&scaled], false).joints[0],
            first.reference,
        )
        .gains(robot);
        for (found, latest) in found.iter_mut().zip(&latest) {
            (found.gain, found.standard_error) =
                (found.gain * latest.gain, latest.standard_error * found.gain);
        }
    }
    found
}

/// How much the joints' torques contradict each other: a link's mass and inertia act on its own
/// joint and on all before it.
///
/// With the parameters eliminated the misfit of torques scaled by g is gᵀ S g.
pub struct Consistency {
    misfit: DMatrix<f64>,
    /// Independent samples of each joint.
    counts: Vec<f64>,
    /// The joint with the largest torque.
    reference: usize,
}

impl Consistency {
    /// Of samples that were fitted with such residuals.
    pub fn of(samples: &Samples, joints: &[JointFit]) -> Self {
        let size = |j: &usize| joints[*j].torque;
        let reference = (0..joints.len()).max_by(|a, b| size(a).total_cmp(&size(b))).unwrap_or(0);
        Self::with_reference(samples, joints, reference)
    }

    fn with_reference(samples: &Samples, joints: &[JointFit], reference: usize) -> Self {
        let (n, p) = (samples.joints, samples.columns.len());
        let used: Vec<usize> = (0..samples.len()).filter(|r| samples.used[*r]).collect();
        // With the root mean square, not the robust deviation: outliers must not pull a gain down.
        let weight = |j: usize| {
            let size = joints[j].residual.max(1e-6 * joints[j].torque).max(f64::MIN_POSITIVE);
            (joints[j].independent / joints[j].rows.max(1) as f64).sqrt() / size
        };
        let whole = Triangle::of_rows(&used, p + n, |r, out| {
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

    /// The most likely gains relative to the joint with the largest torque: a gain scales a joint's
    /// errors too, which its likelihood has as Σ N_j log g_j.
    fn gains(&self, robot: &Robot) -> Vec<Gain> {
        let Some((gains, errors)) = most_likely(&self.misfit, &self.counts, self.reference) else {
            return Vec::new();
        };
        let name = |j: usize| robot.joints()[j].name.clone();
        let gain = |j: usize| Gain {
            joint: name(j),
            gain: gains[j] / gains[self.reference],
            standard_error: errors[j],
        };
        (0..gains.len()).map(gain).collect()
    }

    /// The joint whose torque, with the other sign, contradicts the others least, and the part of
    /// the misfit that is then left.
    fn turned(&self) -> Option<(usize, f64)> {
        let n = self.counts.len();
        let squares = |turned: Option<usize>| {
            let g = DVector::from_fn(n, |j, _| if turned == Some(j) { -1.0 } else { 1.0 });
            g.dot(&(&self.misfit * &g))
        };
        let here = squares(None);
        let best =
            (0..n).map(|j| (j, squares(Some(j)) / here)).min_by(|a, b| a.1.total_cmp(&b.1))?;
        (best.1 < TURNED).then_some(best)
    }
}

/// S: what no parameters can fit of the last columns. The first p columns may be dependent.
fn eliminated(whole: &Triangle, p: usize) -> DMatrix<f64> {
    let n = whole.r.ncols() - p;
    let svd = whole.r.columns(0, p).into_owned().svd(true, false);
    let Some(u) = svd.u else { unreachable!("it was asked for") };
    let cut = 1e-9 * svd.singular_values.max();
    let mut torque = whole.r.columns(p, n).into_owned();
    for (k, sigma) in svd.singular_values.iter().enumerate().filter(|(_, sigma)| **sigma > cut) {
        let (direction, _) = (u.column(k), sigma);
        let part = direction.transpose() * &torque;
        torque -= direction * part;
    }
    torque.transpose() * torque
}

/// The minimum of ½ gᵀ S g - Σ N_j log g_j by Newton's method in log g, and the standard errors of
/// log g_j - log g_reference.
fn most_likely(
    misfit: &DMatrix<f64>,
    counts: &[f64],
    reference: usize,
) -> Option<(Vec<f64>, Vec<f64>)> {
    let n = counts.len();
    let mut log = DVector::zeros(n);
    let mut factor = None;
    for _ in 0..100 {
        let g = log.map(f64::exp);
        let pull = misfit * &g;
        let gradient = DVector::from_fn(n, |j, _| g[j] * pull[j] - counts[j]);
        let mut hessian = DMatrix::from_fn(n, n, |i, j| g[i] * misfit[(i, j)] * g[j]);
        // The part of the curvature that may be negative is left out: it vanishes at the minimum up
        // to N_j.
        (0..n).for_each(|j| hessian[(j, j)] += counts[j]);
        let decomposed = hessian.cholesky()?;
        let step: DVector<f64> = decomposed.solve(&gradient);
        log -= &step * (0.5 / step.amax().max(0.5));
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
        log.iter().map(|log| log.exp()).collect(),
        (0..n).map(|j| variance(j).max(0.0).sqrt()).collect(),
    ))
}

/// What looks wrong, in words: torques that contradict each other, friction that drives, and, where
/// the fit is poor, signs that are turned.
pub fn words(
    robot: &Robot,
    fit: &InertiaFit,
    known: &[FrictionDescription],
    (consistency, gains): (&Consistency, &[Gain]),
    logs: &[Log],
    samples: &Samples,
    sampling: &Sampling,
) -> Vec<String> {
    let joints = &fit.joints;
    let name = |j: usize| &robot.joints()[j].name;
    let mut words = Vec::new();
    let poor: Vec<usize> = (0..joints.len()).filter(|j| joints[*j].relative() > POOR).collect();
    let searched = || turned_sign(robot, logs, samples, sampling);
    let turned = consistency.turned().map(|(j, part)| (format!("tau of {}", name(j)), part));
    if let Some((what, part)) =
        turned.clone().or_else(|| (!poor.is_empty()).then(searched).flatten())
    {
        words.push(format!(
            "the sign of {what} looks turned: with the other sign the sum of squared residuals is {part:.3} of what it is; multiply the column by -1 (for a \
             torque: a negative gain)"
        ));
    }
    for (j, known) in known.iter().enumerate() {
        let (coulomb, viscous) = plain_friction(fit, known, j);
        if coulomb < 0.0 && viscous < 0.0 {
            words.push(format!(
                "least squares finds friction of {} that drives it (Coulomb {coulomb:.3} N m, viscous {viscous:.3} N m s/rad): the sign of its torque or of its velocity \
                 is probably turned",
                name(j)
            ));
        }
    }
    // A turned sign makes nonsense of the gains.
    for gain in gains.iter().filter(|_| turned.is_none()) {
        let off = (gain.gain - 1.0).abs();
        if off > GAIN_OFF && off > SURE * gain.standard_error {
            words.push(format!(
                "the torque of {} contradicts that of the other joints: times {:.3} ± {:.3} it would agree; check its gain",
                gain.joint, gain.gain, gain.standard_error
            ));
        }
    }
    for j in poor {
        words.push(format!(
            "{}: {:.0} % of the torque is not explained; friction that no law describes, a wrong robot, or columns in another order look like this",
            name(j),
            100.0 * joints[j].relative()
        ));
    }
    words
}

/// Coulomb and viscous friction of a joint by least squares, what is known of it included.
fn plain_friction(fit: &InertiaFit, known: &FrictionDescription, joint: usize) -> (f64, f64) {
    let [a1, _, a3, _, a5, _, a7, _] = known.coulomb;
    let fitted = |kind| {
        let column = fit.columns.iter().position(|c| c.joint == joint && c.kind == kind);
        column.map_or(0.0, |k| fit.fit.solution.x[k])
    };
    (
        0.25 * (a1 + a7 - a3 - a5) + fitted(ColumnKind::Coulomb),
        known.viscous[0] + fitted(ColumnKind::Viscous1),
    )
}

/// The turned sign of one joint's torque, of its position with its velocity, or of all three, that
/// explains the torque best; and what is then left of the sum of squares.
fn turned_sign(
    robot: &Robot,
    logs: &[Log],
    samples: &Samples,
    sampling: &Sampling,
) -> Option<(String, f64)> {
    let rate = sampling.rate
        * (SIGN_SAMPLES * samples.joints as f64 / samples.len().max(1) as f64).min(1.0);
    let sampling = Sampling { rate, ..sampling.clone() };
    let misfit = |logs: &[Log]| unexplained(robot, &samples.columns, logs, &sampling);
    let here = misfit(logs);
    let names = ["tau", "q, qd", "q, qd and tau"];
    let candidates: Vec<(usize, usize)> =
        (0..samples.joints).flat_map(|joint| (0..3).map(move |kind| (joint, kind))).collect();
    let turned = |&(joint, kind): &(usize, usize)| {
        let logs: Vec<Log> =
            logs.iter().map(|log| turn(log, joint, kind != 0, kind != 1)).collect();
        (joint, kind, misfit(&logs) / here)
    };
    let best = candidates.par_iter().map(turned).min_by(|a, b| a.2.total_cmp(&b.2))?;
    (best.2 < BETTER)
        .then(|| (format!("{} of {}", names[best.1], robot.joints()[best.0].name), best.2))
}

/// The sum over joints of the part of the squared torque that no parameters explain.
fn unexplained(robot: &Robot, columns: &[Column], logs: &[Log], sampling: &Sampling) -> f64 {
    let samples = Samples::of(robot, columns, logs, sampling, &Known::Nothing);
    Fit::of(&[&samples], true).joints[0].iter().map(|joint| joint.relative().powi(2)).sum()
}

fn turn(log: &Log, joint: usize, motion: bool, torque: bool) -> Log {
    let mut log = log.clone();
    let n = log.joints;
    let negate =
        |values: &mut Vec<f64>| values.iter_mut().skip(joint).step_by(n).for_each(|v| *v = -*v);
    if motion {
        [&mut log.q, &mut log.qd, &mut log.qdd].into_iter().for_each(negate);
    }
    if torque {
        negate(&mut log.tau);
    }
    log
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two joints whose torques are both x(t), a sine with an unknown amplitude, the second
    /// recorded at half scale.
    fn whole(sign: f64) -> Triangle {
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
        Triangle::of(&(0..400).flat_map(row).collect::<Vec<_>>(), 3)
    }

    #[test]
    fn the_most_likely_gain_restores_a_joint_that_was_scaled() {
        let (gains, errors) = most_likely(&eliminated(&whole(1.0), 1), &[400.0, 400.0], 0).unwrap();
        assert!((gains[1] / gains[0] - 2.0).abs() < 0.1 && errors[1] < 0.1, "{gains:?} {errors:?}");
    }

    #[test]
    fn a_turned_torque_contradicts_the_other() {
        let consistency = |sign| Consistency {
            misfit: eliminated(&whole(sign), 1),
            counts: vec![400.0; 2],
            reference: 0,
        };
        assert!(consistency(-1.0).turned().is_some() && consistency(1.0).turned().is_none());
    }
}
