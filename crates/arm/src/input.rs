use std::path::Path;
use std::sync::Arc;

use reachtube_conform::data::RunInput;
use reachtube_diagnose::axes;
use reachtube_reach::TimeGrid;
use reachtube_recordings::{Defect, Run, Torque, check_limits};
use reachtube_robot::Robot;

/// Accelerations are differences of velocities over at least this time to both sides, s.
pub(super) const SPAN: f64 = 0.02;

/// Evaluates the input along a run, eq. (11) of the paper, and checks its units and times.
///
/// # Errors
///
/// Defects of units and times, under the name `path`.
pub(super) fn input(
    path: &Path,
    run: &Run,
    robot: &Robot,
    torque: Torque,
) -> Result<RunInput, Vec<Defect>> {
    let grid = grid(path, run, robot)?;
    let mut inputs = match torque {
        Torque::Compensated => run.torques.clone(),
        Torque::Motor | Torque::Link => {
            let input =
                |k| reachtube_diagnose::input(torque, robot, run.q(k), run.qd(k), run.torque(k));
            (0..run.len()).flat_map(input).collect()
        }
    };
    if torque == Torque::Link {
        add_motor_inertia(run, robot, &mut inputs);
    }
    Ok(RunInput { grid: Arc::new(grid), inputs: inputs.into() })
}

/// Returns the times of a run whose units and times were checked.
pub(super) fn grid(path: &Path, run: &Run, robot: &Robot) -> Result<TimeGrid, Vec<Defect>> {
    let defects = check_limits(path, run, &axes(robot));
    if !defects.is_empty() {
        return Err(defects);
    }
    TimeGrid::from_times(&run.times).map_err(|error| {
        let remedy = "sort the samples, drop duplicates";
        vec![Defect::new(path, None, error.to_string(), remedy)]
    })
}

/// Adds to inputs from torques behind the gear what the motors' inertia takes, J q̈, which their
/// sensors do not measure. The model has this inertia. The acceleration is the difference of the
/// velocities over at least [`SPAN`] to both sides.
fn add_motor_inertia(run: &Run, robot: &Robot, inputs: &mut [f64]) {
    let inertia: Vec<f64> = robot.joints().iter().map(|joint| joint.armature).collect();
    let (times, last) = (&run.times, run.len().saturating_sub(1));
    if last == 0 || inertia.iter().all(|inertia| *inertia == 0.0) {
        return;
    }
    for (k, inputs) in inputs.chunks_exact_mut(run.joints).enumerate() {
        let before = times.partition_point(|time| *time < times[k] - SPAN).min(k.max(1) - 1);
        let after = times.partition_point(|time| *time < times[k] + SPAN).min(last);
        let duration = times[after] - times[before];
        for (joint, u) in inputs.iter_mut().enumerate() {
            let change = run.qd(after)[joint] - run.qd(before)[joint];
            *u += inertia[joint] * change / duration;
        }
    }
}
