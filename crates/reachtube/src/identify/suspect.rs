//! Mistakes of sign and gain, told from what a rigid body cannot do.

use super::fit::{Fit, JointFit};
use super::prepare::Log;
use super::regression::Triangle;
use super::samples::{Known, Samples, Sampling};
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;
use reachtube_robot::{Column, Robot, RobotDescription};
use serde::Serialize;

/// Gains further from 1 than this, and than four standard errors, are said.
const GAIN_OFF: f64 = 0.1;

/// Standard errors of a gain below which it is not said.
const SURE: f64 = 4.0;

/// A joint whose torque is left unexplained by more than this part is looked at for a wrong sign.
const POOR: f64 = 0.3;

/// A turned sign must bring the sum of squares below this part.
const BETTER: f64 = 0.5;

/// Samples that are enough to tell a sign.
const SIGN_SAMPLES: f64 = 800.0;

/// The gain of one joint's torque against those of the others, from the forces that the links hand each other.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Gain {
    /// The joint's name.
    pub joint: String,
    /// What its torque must be multiplied with to agree with the others.
    pub gain: f64,
    /// Standard error; infinite where the joint has no part in the others' torque.
    pub standard_error: f64,
}

/// The most likely gains, relative to the joint with the largest torque: a link's mass and inertia act on its own joint and on all before it, so that
/// torques of different scale contradict each other.
///
/// With the parameters eliminated the misfit is gᵀ S g; its likelihood has the term Σ N_j log g_j of what a gain does to a joint's errors.
pub fn gains(robot: &Robot, samples: &Samples, joints: &[JointFit]) -> Vec<Gain> {
    let (n, p) = (samples.joints, samples.columns.len());
    let used: Vec<usize> = (0..samples.len()).filter(|r| samples.used[*r]).collect();
    let weight = |joint: usize| {
        (joints[joint].independent / joints[joint].rows.max(1) as f64).sqrt() / joints[joint].deviation
    };
    let whole = Triangle::of_rows(&used, p + n, |r, out| {
        let (joint, w) = (r % n, weight(r % n));
        out[..p].iter_mut().zip(samples.row(r)).for_each(|(o, y)| *o = w * y);
        out[p + joint] = w * samples.torque[r];
    });
    let misfit = eliminated(&whole, p);
    let counts: Vec<f64> = joints.iter().map(|joint| joint.independent).collect();
    let size = |j: &usize| joints[*j].torque;
    let reference = (0..n).max_by(|a, b| size(a).total_cmp(&size(b))).unwrap_or(0);
    let Some((gains, errors)) = most_likely(&misfit, &counts, reference) else { return Vec::new() };
    let gain = |j: usize| Gain {
        joint: robot.joints()[j].name.clone(),
        gain: gains[j] / gains[reference],
        standard_error: errors[j],
    };
    (0..n).map(gain).collect()
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

/// The minimum of ½ gᵀ S g - Σ N_j log g_j by Newton's method in log g, and the standard errors of log g_j - log g_reference.
fn most_likely(misfit: &DMatrix<f64>, counts: &[f64], reference: usize) -> Option<(Vec<f64>, Vec<f64>)> {
    let n = counts.len();
    let mut log = DVector::zeros(n);
    let mut factor = None;
    for _ in 0..100 {
        let g = log.map(f64::exp);
        let pull = misfit * &g;
        let gradient = DVector::from_fn(n, |j, _| g[j] * pull[j] - counts[j]);
        let mut hessian = DMatrix::from_fn(n, n, |i, j| g[i] * misfit[(i, j)] * g[j]);
        // The part of the curvature that may be negative is left out: it vanishes at the minimum up to N_j.
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
    let variance =
        |j: usize| covariance[(j, j)] + covariance[(reference, reference)] - 2.0 * covariance[(j, reference)];
    Some((log.iter().map(|log| log.exp()).collect(), (0..n).map(|j| variance(j).max(0.0).sqrt()).collect()))
}

/// What looks wrong, in words: gains that contradict each other, friction that drives, and, where the fit is poor, signs that are turned.
pub fn words(
    robot: &Robot,
    found: &RobotDescription,
    gains: &[Gain],
    joints: &[JointFit],
    logs: &[Log],
    samples: &Samples,
    sampling: &Sampling,
) -> Vec<String> {
    let mut words = Vec::new();
    let poor: Vec<usize> = (0..joints.len()).filter(|j| joints[*j].relative() > POOR).collect();
    if let Some((what, part)) =
        (!poor.is_empty()).then(|| turned_sign(robot, logs, samples, sampling)).flatten()
    {
        words.push(format!(
            "the sign of {what} looks turned: with the other sign the sum of squared residuals is {part:.3} of what it is; multiply the column by -1 (for a \
             torque: a negative gain)"
        ));
    }
    for joint in &found.joints {
        let [a1, _, a3, _, a5, _, a7, _] = joint.friction.coulomb;
        let (forward, backward) = (0.5 * (a1 + a7), 0.5 * (a3 + a5));
        if forward - backward < 0.0 && joint.friction.viscous[0] < 0.0 {
            words.push(format!(
                "friction of {} drives the joint (Coulomb {forward:.3} N m forward, {backward:.3} backward, viscous {:.3} N m s/rad): the sign of its torque or of its \
                 velocity is probably turned",
                joint.name, joint.friction.viscous[0]
            ));
        }
    }
    for gain in gains {
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
            robot.joints()[j].name,
            100.0 * joints[j].relative()
        ));
    }
    words
}

/// The turned sign of one joint's torque, of its position with its velocity, or of all three, that explains the torque best; and what is then left of the sum of squares.
fn turned_sign(robot: &Robot, logs: &[Log], samples: &Samples, sampling: &Sampling) -> Option<(String, f64)> {
    let rate = sampling.rate * (SIGN_SAMPLES * samples.joints as f64 / samples.len().max(1) as f64).min(1.0);
    let sampling = Sampling { rate, ..sampling.clone() };
    let misfit = |logs: &[Log]| unexplained(robot, &samples.columns, logs, &sampling);
    let here = misfit(logs);
    let names = ["tau", "q, qd", "q, qd and tau"];
    let candidates: Vec<(usize, usize)> =
        (0..samples.joints).flat_map(|joint| (0..3).map(move |kind| (joint, kind))).collect();
    let turned = |&(joint, kind): &(usize, usize)| {
        let logs: Vec<Log> = logs.iter().map(|log| turn(log, joint, kind != 0, kind != 1)).collect();
        (joint, kind, misfit(&logs) / here)
    };
    let best = candidates.par_iter().map(turned).min_by(|a, b| a.2.total_cmp(&b.2))?;
    (best.2 < BETTER).then(|| (format!("{} of {}", names[best.1], robot.joints()[best.0].name), best.2))
}

/// The sum over joints of the part of the squared torque that no parameters explain.
fn unexplained(robot: &Robot, columns: &[Column], logs: &[Log], sampling: &Sampling) -> f64 {
    let samples = Samples::of(robot, columns, logs, sampling, &Known::Nothing);
    Fit::of(&[&samples], true).joints[0].iter().map(|joint| joint.relative().powi(2)).sum()
}

fn turn(log: &Log, joint: usize, motion: bool, torque: bool) -> Log {
    let mut log = log.clone();
    let n = log.joints;
    let negate = |values: &mut Vec<f64>| values.iter_mut().skip(joint).step_by(n).for_each(|v| *v = -*v);
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

    #[test]
    fn the_most_likely_gain_restores_a_joint_that_was_scaled() {
        // Two rows that should say the same x, one recorded at half scale: t1 = x + e, t2 = 0.5 x + 0.5 e.
        let count = 200;
        let noise = |k: usize| 0.01 * (((k * 7919) % 1009) as f64 / 1009.0 - 0.5);
        let rows: Vec<f64> = (0..count)
            .flat_map(|k| {
                let x = 1.0 + (0.1 * k as f64).sin();
                [1.0, x + noise(k), 0.0, 0.0, 1.0, 0.0, 0.5 * (x + noise(k + 500)), 0.0].map(|v| v / 0.003)
            })
            .collect();
        // One parameter a sample cannot be shared, so a constant one stands for it: x = 1 on average.
        let whole = Triangle::of(&rows, 3);
        let misfit = eliminated(&whole, 1);
        let (gains, _) = most_likely(&misfit, &[count as f64, count as f64], 0).unwrap();
        assert!(gains[1] / gains[0] > 1.2, "{gains:?}");
    }
}
