use crate::prepare::log::{PreparedLog, spread};
use crate::regression::residuals::root_mean_square;
use nalgebra::DVector;
use rayon::prelude::*;
use reachtube_ode::{Ensemble, InitialValueProblem};
use reachtube_robot::{DrivenBy, Robot, RobotField};
use reachtube_scalar::Lanes;
use schemars::JsonSchema;
use serde::Serialize;

/// Limit of the windows of one length in one log.
const MAX_WINDOWS: usize = 40;

/// Largest number of recordings that are simulated.
const MOST_LOGS: usize = 64;

/// Number of windows that are simulated side by side.
const TOGETHER: usize = 8;

/// Longest step of the simulation \[s\].
const SIMULATION_STEP: f64 = 2e-3;

/// Error of a state beyond which a simulation counts as diverged \[rad, rad/s\].
const DIVERGED: f64 = 1e3;

/// Errors of motion simulated over windows of one length.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
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
    let of_logs = windows.chunk_by(|a, b| std::ptr::eq(a.0, b.0));
    let together: Vec<_> = of_logs.flat_map(|windows| windows.chunks(TOGETHER)).collect();
    let ends = together.par_iter().flat_map_iter(|windows| window_errors(robot, windows));
    let ends: Vec<Option<DVector<f64>>> = ends.collect();
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

/// Returns the simulated minus the recorded state at the end of each of some windows of one length
/// in one log, 2n entries.
///
/// The result is `None` if the simulation diverged.
fn window_errors(
    robot: &Robot,
    windows: &[(&PreparedLog, usize, usize)],
) -> Vec<Option<DVector<f64>>> {
    let Some(&(log, _, length)) = windows.first() else { return Vec::new() };
    let substeps = (log.step / SIMULATION_STEP).ceil().max(1.0) as usize;
    let times: Vec<f64> = (0..=length).map(|k| k as f64 * log.step).collect();
    // The held torque is the mean over the step: the torque at its start would be half a step late.
    let mean = |k: usize| log.tau(k).iter().zip(log.tau(k + 1)).map(|(a, b)| 0.5 * (a + b));
    let held = |(_, start, _): &(_, usize, _)| (*start..start + length).flat_map(mean).collect();
    let held: Vec<Vec<f64>> = windows.iter().map(held).collect();
    let state = |k: usize| [log.q(k), log.qd(k)].concat();
    let starts: Vec<Vec<f64>> = windows.iter().map(|(_, start, _)| state(*start)).collect();
    let runs = starts.iter().zip(&held);
    let runs: Vec<_> = runs.map(|(start, inputs)| InitialValueProblem { start, inputs }).collect();
    let mut errors = vec![None; windows.len()];
    let mut field = RobotField::new(robot, DrivenBy::Motor);
    let mut ensemble = Ensemble::<Lanes<TOGETHER>>::new(2 * robot.joint_count());
    ensemble.integrate(&mut field, &times, substeps, &runs, |window, sample, x| {
        if sample == length {
            let end = state(windows[window].1 + length);
            errors[window] = Some(DVector::from_column_slice(x) - DVector::from_vec(end));
        }
    });
    let is_near = |error: &DVector<f64>| error.iter().all(|e| e.is_finite() && e.abs() < DIVERGED);
    errors.into_iter().map(|error| error.filter(is_near)).collect()
}
