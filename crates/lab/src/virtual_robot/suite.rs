//! Test suites of the virtual robot (Sec. V-B, Figs. 2 and 3).

use super::arm::{Arm, Logged};
use super::recording::Recording;
use super::truth::VirtualRobot;
use crate::error::{Error, Result};
use crate::motion::{Motion, Planned, SAMPLE_TIME};
use crate::random::{SplitMix64, uniform};

/// The inputs of a motion, recorded while the arm followed it closed loop.
pub(crate) struct PreRecorded {
    /// Inputs \[N m\], row-major K x n.
    pub inputs: Vec<f64>,
}

impl PreRecorded {
    /// Follows the whole motion with the joints at the nominal temperature; the last sample is at
    /// its end.
    pub(crate) fn new(robot: &VirtualRobot, motion: &Motion) -> Self {
        Self::until(robot, motion, motion.cycles() + 1)
    }

    /// Follows the first `cycles` of the motion with the joints at the nominal temperature.
    pub(crate) fn until(robot: &VirtualRobot, motion: &Motion, cycles: usize) -> Self {
        let temperatures = vec![robot.parameters().nominal_temperature; motion.start.len()];
        let mut arm = Arm::at_rest(robot, &motion.start, &temperatures);
        let plan = |k: usize| motion.at(k as f64 * SAMPLE_TIME);
        Self { inputs: arm.follow(cycles, Logged::Input, plan).torques }
    }
}

/// The deviation of a run's start from the plan.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Scatter {
    /// Deviation of the positions \[rad\], n.
    pub q: Vec<f64>,
    /// Deviation of the velocities \[rad/s\], n.
    pub qd: Vec<f64>,
}

impl Scatter {
    pub(crate) fn random(robot: &VirtualRobot, random: &mut SplitMix64) -> Self {
        let parameters = robot.parameters();
        let mut draw = |width: f64| {
            (0..robot.nominal().joint_count()).map(|_| uniform(random, -width, width)).collect()
        };
        Self { q: draw(parameters.position_scatter), qd: draw(parameters.velocity_scatter) }
    }

    /// Moves a plan at time `t` of the way to the start at `end`, both \[s\]: by a cubic that
    /// begins without deviation and ends with this one.
    fn displace(&self, plan: &mut Planned, t: f64, end: f64) {
        let x = t / end;
        for i in 0..self.q.len() {
            let (q, way) = (self.q[i], self.qd[i] * end);
            plan.q[i] += x * x * (q * (3.0 - 2.0 * x) + way * (x - 1.0));
            plan.qd[i] += x * (q * 6.0 * (1.0 - x) + way * (3.0 * x - 2.0)) / end;
            plan.qdd[i] += (q * (6.0 - 12.0 * x) + way * (6.0 * x - 2.0)) / (end * end);
        }
    }
}

/// The runs of a test suite before they are recorded.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct SuiteRuns {
    /// Name of the suite.
    pub name: String,
    /// Cycle of the motion at which the open loop begins, at least 1.
    pub first: usize,
    /// Number of samples of a run.
    pub samples: usize,
    /// The deviation of each run's start.
    pub scatter: Vec<Scatter>,
}

/// Records the runs of a suite one after another. The arm is cold before the first. Each run heats
/// the joints, moving back heats them as much again, and they cool in the pause.
///
/// # Errors
///
/// [`Error::Diverged`].
pub(crate) fn record_suite(
    robot: &VirtualRobot,
    motion: &Motion,
    recorded: &PreRecorded,
    suite: &SuiteRuns,
) -> Result<Vec<Recording>> {
    let n = motion.start.len();
    let parameters = robot.parameters();
    let inputs = &recorded.inputs[suite.first * n..(suite.first + suite.samples) * n];
    let begin = suite.first as f64 * SAMPLE_TIME;
    let kept = super::elementary::exp(-parameters.pause / parameters.cooling_time);
    let mut temperatures = vec![parameters.ambient_temperature; n];
    let mut runs = Vec::with_capacity(suite.scatter.len());
    for scatter in &suite.scatter {
        let mut arm = Arm::at_rest(robot, &motion.start, &temperatures);
        arm.follow(suite.first, Logged::Input, |k| {
            let t = k as f64 * SAMPLE_TIME;
            let mut plan = motion.at(t);
            scatter.displace(&mut plan, t, begin);
            plan
        });
        let planned = |k: usize| motion.at((suite.first + k) as f64 * SAMPLE_TIME).qd;
        let run = arm.open_loop(inputs, planned);
        if !run.is_finite() {
            let (recording, robot) = (suite.name.clone(), robot.nominal().name().into());
            return Err(Error::Diverged { recording, robot });
        }
        runs.push(run);
        for (temperature, after) in temperatures.iter_mut().zip(arm.temperatures()) {
            let back = after + (after - *temperature);
            let excess = back - parameters.ambient_temperature;
            *temperature = parameters.ambient_temperature + kept * excess;
        }
    }
    Ok(runs)
}
