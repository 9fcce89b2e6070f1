//! The model on recordings that it was not fitted to: torque predicted from motion, and motion
//! simulated from torque.

use super::inertia::InertiaFit;
use super::prepare::Log;
use super::regression::root_mean_square;
use super::samples::{Known, Samples, Sampling};
use nalgebra::DVector;
use rayon::prelude::*;
use reachtube_robot::Robot;
use serde::Serialize;

/// Simulated windows of one length, at most, in one log.
const MOST_WINDOWS: usize = 40;

/// Longest step of the simulation \[s\].
const SIMULATION_STEP: f64 = 2e-3;

/// Torque of one joint in one log: measured against predicted.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct JointError {
    /// Root mean square of the recorded torque \[N m\], where the joint moves.
    pub torque: f64,
    /// Root mean square of recorded less predicted torque \[N m\], where the joint moves.
    pub residual: f64,
    /// Their ratio.
    pub relative: f64,
    /// The ratio with the parameters of least squares, before links were made physical.
    pub relative_plain: f64,
    /// The ratio over all samples, standstill included.
    pub relative_all: f64,
    /// Part of the recorded torque's variance that is predicted, where the joint moves.
    pub r2: f64,
    /// Samples in which the joint moves.
    pub samples: usize,
}

/// Torque of one log that was kept back.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct LogValidation {
    /// The log's name; "all" for all of them together.
    pub log: String,
    /// Joint by joint.
    pub joints: Vec<JointError>,
}

/// Motion simulated over windows of one length.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct WindowErrors {
    /// Length of the windows \[s\].
    pub duration: f64,
    /// Number of windows.
    pub windows: usize,
    /// Windows in which the simulation left every bound.
    pub diverged: usize,
    /// Root mean square over the windows of the position error at the end, joint by joint \[rad\].
    pub q: Vec<f64>,
    /// The same of the velocity \[rad/s\].
    pub qd: Vec<f64>,
    /// Root mean square of how far the joint moved from start to end \[rad\].
    pub motion: Vec<f64>,
}

/// A log's torque for figures.
#[derive(Debug, Clone)]
pub struct TorqueTrace {
    /// The log's name.
    pub log: String,
    /// Times \[s\].
    pub times: Vec<f64>,
    /// Recorded torque, a row a joint \[N m\].
    pub recorded: Vec<Vec<f64>>,
    /// Predicted torque, likewise.
    pub predicted: Vec<Vec<f64>>,
    /// Whether the joint moves, likewise.
    pub moves: Vec<Vec<bool>>,
}

/// Predicts the torque of logs by the robot that was found; plain least squares, beside it, by
/// `fit` and the friction of `known`. Log by log, then over all.
pub fn predict(
    found: &Robot,
    known: &Robot,
    logs: &[Log],
    sampling: &Sampling,
    fit: &InertiaFit,
) -> (Vec<LogValidation>, Vec<TorqueTrace>) {
    let samples = Samples::of(known, &fit.columns, logs, sampling, &Known::Friction(known));
    let residuals = Samples::of(found, &[], logs, sampling, &Known::All(found)).torque;
    let plain = samples.residuals(&fit.fit.solution.x);
    let of = |log: &str, rows: std::ops::Range<usize>| LogValidation {
        log: log.into(),
        joints: (0..samples.joints)
            .map(|joint| joint_error(&samples, &residuals, &plain, rows.clone(), joint))
            .collect(),
    };
    let mut found: Vec<LogValidation> =
        logs.iter().zip(&samples.logs).map(|(log, rows)| of(&log.name, rows.clone())).collect();
    if logs.len() > 1 {
        found.push(of("all", 0..samples.len()));
    }
    let traces = logs
        .iter()
        .zip(&samples.logs)
        .map(|(log, rows)| trace(&samples, &residuals, log, rows.clone()));
    (found, traces.collect())
}

fn joint_error(
    samples: &Samples,
    residuals: &[f64],
    plain: &[f64],
    rows: std::ops::Range<usize>,
    joint: usize,
) -> JointError {
    let all: Vec<usize> = rows.skip(joint).step_by(samples.joints).collect();
    let moving: Vec<usize> = all.iter().copied().filter(|r| samples.used[*r]).collect();
    let size = |rows: &[usize], values: &[f64]| root_mean_square(rows.iter().map(|r| values[*r]));
    let ratio = |rows: &[usize], values: &[f64]| {
        let torque = size(rows, &samples.recorded);
        if torque > 0.0 { size(rows, values) / torque } else { 0.0 }
    };
    let mean =
        moving.iter().map(|r| samples.recorded[*r]).sum::<f64>() / moving.len().max(1) as f64;
    let spread = root_mean_square(moving.iter().map(|r| samples.recorded[*r] - mean));
    let residual = size(&moving, residuals);
    JointError {
        torque: size(&moving, &samples.recorded),
        residual,
        relative: ratio(&moving, residuals),
        relative_plain: ratio(&moving, plain),
        relative_all: ratio(&all, residuals),
        r2: if spread > 0.0 { 1.0 - (residual / spread).powi(2) } else { 0.0 },
        samples: moving.len(),
    }
}

fn trace(
    samples: &Samples,
    residuals: &[f64],
    log: &Log,
    rows: std::ops::Range<usize>,
) -> TorqueTrace {
    let n = samples.joints;
    let count = rows.len() / n;
    let span = log.time(log.len().saturating_sub(1)) - log.start;
    let step = if count > 1 { span / (count - 1) as f64 } else { 0.0 };
    let column = |joint: usize, value: &dyn Fn(usize) -> f64| {
        rows.clone().skip(joint).step_by(n).map(value).collect()
    };
    TorqueTrace {
        log: log.name.clone(),
        times: (0..count).map(|k| log.start + step * k as f64).collect(),
        moves: (0..n)
            .map(|joint| rows.clone().skip(joint).step_by(n).map(|r| samples.used[r]).collect())
            .collect(),
        recorded: (0..n).map(|joint| column(joint, &|r| samples.recorded[r])).collect(),
        predicted: (0..n)
            .map(|joint| column(joint, &|r| samples.recorded[r] - residuals[r]))
            .collect(),
    }
}

/// The joints of which more than 30 % of the torque on recordings kept back is not predicted, in
/// words.
pub fn poor(robot: &Robot, validation: &[LogValidation]) -> Vec<String> {
    let joints = validation.last().map_or(&[][..], |all| &all.joints);
    let words = |(joint, error): (&reachtube_robot::Joint, &JointError)| {
        (error.relative > super::suspect::POOR).then(|| {
            format!(
                "{}: {:.0} % of the torque on recordings kept back is not explained; friction that no law describes looks like this, or a motion far from those fitted",
                joint.name,
                100.0 * error.relative
            )
        })
    };
    robot.joints().iter().zip(joints).filter_map(words).collect()
}

/// Simulates the robot under the recorded torque over windows of each length and compares the
/// states at their ends.
pub fn simulate(robot: &Robot, logs: &[Log], durations: &[f64]) -> Vec<WindowErrors> {
    durations.iter().map(|duration| simulate_windows(robot, logs, *duration)).collect()
}

fn simulate_windows(robot: &Robot, logs: &[Log], duration: f64) -> WindowErrors {
    let n = robot.joint_count();
    let windows: Vec<(&Log, usize, usize)> = logs
        .iter()
        .flat_map(|log| {
            let length = (duration / log.step).round().max(1.0) as usize;
            let count = (log.len().saturating_sub(1) / length).min(MOST_WINDOWS);
            let apart = (log.len() - 1 - length.min(log.len() - 1))
                .checked_div(count.saturating_sub(1))
                .unwrap_or(0);
            (0..count).map(move |k| (log, k * apart, length))
        })
        .collect();
    let ends: Vec<Option<DVector<f64>>> = windows
        .par_iter()
        .map(|(log, start, length)| window_error(robot, log, *start, *length))
        .collect();
    let moved = |joint: usize| {
        windows
            .iter()
            .map(move |(log, start, length)| log.q(start + length)[joint] - log.q(*start)[joint])
    };
    let error = |i: usize| ends.iter().flatten().map(move |error| error[i]).collect::<Vec<f64>>();
    WindowErrors {
        duration,
        windows: windows.len(),
        diverged: ends.iter().filter(|end| end.is_none()).count(),
        q: (0..n).map(|joint| root_mean_square(error(joint).into_iter())).collect(),
        qd: (0..n).map(|joint| root_mean_square(error(n + joint).into_iter())).collect(),
        motion: (0..n)
            .map(|joint| root_mean_square(moved(joint).collect::<Vec<_>>().into_iter()))
            .collect(),
    }
}

/// Simulated less recorded state at the end of a window, 2n entries; none where it is not finite.
fn window_error(robot: &Robot, log: &Log, start: usize, length: usize) -> Option<DVector<f64>> {
    let substeps = (log.step / SIMULATION_STEP).ceil().max(1.0) as usize;
    // The mean over the step: a torque held from its start would be half a step late.
    let mean =
        |k: usize| log.tau(k).iter().zip(log.tau(k + 1)).map(|(a, b)| 0.5 * (a + b)).collect();
    let torques: Vec<Vec<f64>> = (start..start + length).map(mean).collect();
    let motion = robot.simulate(log.q(start), log.qd(start), &torques, log.step, substeps);
    let (q, qd) = (&motion.q[length], &motion.qd[length]);
    let end = start + length;
    let errors = q.iter().zip(log.q(end)).chain(qd.iter().zip(log.qd(end))).map(|(a, b)| a - b);
    let errors = DVector::from_vec(errors.collect::<Vec<f64>>());
    errors.iter().all(|error| error.is_finite() && error.abs() < 1e3).then_some(errors)
}
