use crate::prepare::log::{PreparedLog, spread};
use crate::regression::residuals::root_mean_square;
use nalgebra::DVector;
use rayon::prelude::*;
use reachtube_robot::Robot;
use serde::Serialize;
use std::borrow::Cow;

/// Limit of the windows of one length in one log.
const MAX_WINDOWS: usize = 40;

/// Largest number of recordings that are simulated.
const MOST_LOGS: usize = 64;

/// Longest step of the simulation \[s\].
const SIMULATION_STEP: f64 = 2e-3;

/// Error of a state beyond which a simulation counts as diverged \[rad, rad/s\].
const DIVERGED: f64 = 1e3;

/// Errors of motion simulated over windows of one length.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct WindowErrors {
    /// Duration of a window \[s\].
    pub duration: f64,
    /// Number of windows.
    pub windows: usize,
    /// Number of windows in which the simulation diverged.
    pub diverged: usize,
    /// Root mean square of the position error at the end of a window \[rad\], one entry per joint.
    pub q: Vec<f64>,
    /// Root mean square of the velocity error at the end of a window \[rad/s\], one entry per
    /// joint.
    pub qd: Vec<f64>,
    /// Root mean square of the recorded motion from start to end \[rad\], one entry per joint.
    pub motion: Vec<f64>,
}

/// Simulates the robot under the recorded torque over windows of each duration \[s\], and compares
/// the final states with the recorded ones.
///
/// At most 64 recordings are simulated.
pub(crate) fn simulate(
    robot: &Robot,
    logs: &[PreparedLog],
    durations: &[f64],
) -> Vec<WindowErrors> {
    let logs = &spread(logs, MOST_LOGS);
    durations.iter().map(|duration| simulate_windows(robot, logs, *duration)).collect()
}

fn simulate_windows(robot: &Robot, logs: &[&PreparedLog], duration: f64) -> WindowErrors {
    let n = robot.joint_count();
    // Windows spread evenly over each log, as (log, start, length).
    let windows: Vec<(&PreparedLog, usize, usize)> = logs
        .iter()
        .flat_map(|&log| {
            let length = (duration / log.step).round().max(1.0) as usize;
            let count = (log.len().saturating_sub(1) / length).min(MAX_WINDOWS);
            let apart = (log.len() - 1 - length.min(log.len() - 1))
                .checked_div(count.saturating_sub(1))
                .unwrap_or(0);
            (0..count).map(move |k| (log, k * apart, length))
        })
        .collect();
    let ends: Vec<Option<DVector<f64>>> = windows
        .par_iter()
        .map(|(log, start, length)| window_error(&warmed(robot, log), log, *start, *length))
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

/// Returns the robot as warm as in a recording, as far as the recording knows it.
fn warmed<'a>(robot: &'a Robot, log: &PreparedLog) -> Cow<'a, Robot> {
    if robot.warms_by().is_empty() {
        return Cow::Borrowed(robot);
    }
    let mut warm = robot.clone();
    if let Some(run) = log.order {
        warm = warm.at_run(run as f64);
    }
    if !log.temperatures.is_empty() {
        let mean = |joint: usize| {
            let values = log.temperatures.iter().skip(joint).step_by(log.joints);
            values.sum::<f64>() / log.len() as f64
        };
        warm = warm.at_temperature(&(0..log.joints).map(mean).collect::<Vec<_>>());
    }
    Cow::Owned(warm)
}

/// Returns the simulated minus the recorded state at the end of a window, 2n entries.
///
/// The result is `None` if the simulation diverged.
fn window_error(
    robot: &Robot,
    log: &PreparedLog,
    start: usize,
    length: usize,
) -> Option<DVector<f64>> {
    let substeps = (log.step / SIMULATION_STEP).ceil().max(1.0) as usize;
    // The held torque is the mean over the step: the torque at its start would be half a step late.
    let mean =
        |k: usize| log.tau(k).iter().zip(log.tau(k + 1)).map(|(a, b)| 0.5 * (a + b)).collect();
    let torques: Vec<Vec<f64>> = (start..start + length).map(mean).collect();
    let motion = robot.simulate(log.q(start), log.qd(start), &torques, log.step, substeps);
    let (q, qd) = (&motion.q[length], &motion.qd[length]);
    let end = start + length;
    let errors = q.iter().zip(log.q(end)).chain(qd.iter().zip(log.qd(end))).map(|(a, b)| a - b);
    let errors = DVector::from_vec(errors.collect::<Vec<f64>>());
    errors.iter().all(|error| error.is_finite() && error.abs() < DIVERGED).then_some(errors)
}
