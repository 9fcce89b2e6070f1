use std::path::Path;
use std::sync::Arc;

use reachtube_reach::TimeGrid;
use reachtube_recordings::{Defect, Run, Torque, check_limits};
use reachtube_robot::Robot;
use serde::{Deserialize, Serialize};

use crate::data::stored::{grid, values};

/// Accelerations are differences of velocities over at least this time to both sides, s.
pub(crate) const SPAN: f64 = 0.02;

/// The sample times of a run and the input u along it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RunInput {
    /// The sample times.
    #[serde(with = "grid")]
    pub grid: Arc<TimeGrid>,
    /// The input u, row-major, samples x n, N m.
    #[serde(with = "values")]
    pub inputs: Arc<[f64]>,
}

impl RunInput {
    /// Evaluates the input along a run, eq. (11) of the paper, and checks its units and times.
    ///
    /// # Errors
    ///
    /// Defects of units and times, under the name `path`.
    pub(crate) fn new(
        path: &Path,
        run: &Run,
        robot: &Robot,
        torque: Torque,
    ) -> Result<Self, Vec<Defect>> {
        let defects = check_limits(path, run, robot);
        if !defects.is_empty() {
            return Err(defects);
        }
        let grid = TimeGrid::from_times(&run.times).map_err(|error| {
            let remedy = "sort the samples, drop duplicates";
            vec![Defect::new(path, None, error.to_string(), remedy)]
        })?;
        let mut inputs = match torque {
            Torque::Compensated => run.torques.clone(),
            Torque::Motor | Torque::Link => {
                let input = |k| torque.input(robot, run.q(k), run.qd(k), run.torque(k));
                (0..run.len()).flat_map(input).collect()
            }
        };
        if torque == Torque::Link {
            add_motor_inertia(run, robot, &mut inputs);
        }
        Ok(Self { grid: Arc::new(grid), inputs: inputs.into() })
    }

    /// Returns an input in place of one that bytes do not have.
    pub(crate) fn none() -> Self {
        Self { grid: Arc::new(TimeGrid::uniform(1.0, 0)), inputs: Arc::default() }
    }

    /// Returns whether one of two inputs is the beginning of the other. The input of a run's last
    /// sample acts on nothing and is not compared.
    pub(crate) fn shares(&self, other: &Self, joints: usize) -> bool {
        let (short, long) =
            if self.grid.len() <= other.grid.len() { (self, other) } else { (other, self) };
        let acting = short.grid.len().saturating_sub(1) * joints;
        short.inputs[..acting] == long.inputs[..acting] && short.grid.is_prefix_of(&long.grid)
    }
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

/// The input that some runs share: the longest one, of which the others' are the beginning. Where
/// several are as long, it is the input of the run of the smallest number, because their last
/// samples may differ.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct SharedInput {
    /// The run whose input it is.
    pub run: u32,
    /// The input.
    pub input: RunInput,
}

impl SharedInput {
    /// Returns the input that both have in common; `None` if neither is the beginning of the
    /// other. The order of merging makes no difference.
    pub(crate) fn merge(self, other: Self, joints: usize) -> Option<Self> {
        let shares = self.input.shares(&other.input, joints);
        let key = |of: &Self| (std::cmp::Reverse(of.input.grid.len()), of.run);
        shares.then(|| if key(&self) <= key(&other) { self } else { other })
    }
}
