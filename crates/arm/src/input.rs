use std::path::Path;
use std::sync::Arc;

use reachtube_conform::data::RunInput;
use reachtube_diagnose::axes;
use reachtube_reach::TimeGrid;
use reachtube_recordings::{Defect, Run, Torque, check_limits};
use reachtube_robot::Robot;

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
    let inputs = match torque {
        Torque::Compensated => run.torques.clone(),
        Torque::Motor | Torque::Link => {
            let input =
                |k| reachtube_diagnose::input(torque, robot, run.q(k), run.qd(k), run.torque(k));
            (0..run.len()).flat_map(input).collect()
        }
    };
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
