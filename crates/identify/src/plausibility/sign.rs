use crate::fit::Fit;
use crate::prepare::log::Log;
use crate::samples::{KnownTorque, Samples, Sampling};
use rayon::prelude::*;
use reachtube_robot::{Parameter, Robot};

/// An inverted sign must reduce the sum of squares below this share.
const INVERTED_SHARE: f64 = 0.5;

/// Number of samples that suffice to determine a sign.
const SIGN_SAMPLES: f64 = 800.0;

/// Searches for the one wrong sign that explains the torque best: of a joint's torque, of its
/// position and velocity, or of all three.
///
/// Returns the inverted columns in words, and the share of the sum of squares that remains with the
/// other sign. The result is `None` if no sign reduces the sum of squares by half.
pub(super) fn inverted_columns(
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
    let share = |&(joint, kind): &(usize, usize)| {
        let logs: Vec<Log> =
            logs.iter().map(|log| inverted(log, joint, kind != 0, kind != 1)).collect();
        (joint, kind, misfit(&logs) / here)
    };
    let best = candidates.par_iter().map(share).min_by(|a, b| a.2.total_cmp(&b.2))?;
    (best.2 < INVERTED_SHARE)
        .then(|| (format!("{} of {}", names[best.1], robot.joints()[best.0].name), best.2))
}

/// Returns the share of the squared torque that no parameters explain, summed over the joints.
fn unexplained(robot: &Robot, columns: &[Parameter], logs: &[Log], sampling: &Sampling) -> f64 {
    let samples = Samples::in_motion(robot, columns, logs, sampling, &KnownTorque::None);
    let fit = Fit::of_groups(&[&samples], true);
    fit.joints[0].iter().map(|joint| joint.relative().powi(2)).sum()
}

/// Returns a log with inverted signs of one joint's motion, torque or both.
fn inverted(log: &Log, joint: usize, motion: bool, torque: bool) -> Log {
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
