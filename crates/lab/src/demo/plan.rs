//! The plan of a demo: all that is random is drawn from the seed before anything is simulated, so
//! the order of simulation does not matter.

use super::options::DemoOptions;
use crate::motion::Motion;
use crate::random::{SeedableRng, SplitMix64};
use crate::virtual_robot::{Scatter, SuiteRuns, VirtualRobot};

/// A test suite before it is recorded.
pub(super) struct SuitePlan {
    /// Name of the motion: M1, M2, ...
    pub motion_name: String,
    /// The motion.
    pub motion: Motion,
    /// Whether the suite calibrates the sets.
    pub calibrates: bool,
    /// Whether the suite is held out for the check.
    pub held_out: bool,
    /// The runs, in the order of recording.
    pub runs: SuiteRuns,
}

/// Returns all suites, motion by motion.
pub(super) fn suites(robot: &VirtualRobot, options: &DemoOptions) -> Vec<SuitePlan> {
    let mut random = SplitMix64::seed_from_u64(options.seed);
    let mut suites = Vec::new();
    for index in 0..options.motions {
        let motion = Motion::random(robot.nominal(), options.duration, &mut random);
        for start in 0..options.start_points {
            suites.push(suite(robot, options, (&motion, index), start, &mut random));
        }
    }
    suites
}

fn suite(
    robot: &VirtualRobot,
    options: &DemoOptions,
    (motion, index): (&Motion, usize),
    start: usize,
    random: &mut SplitMix64,
) -> SuitePlan {
    let first = motion.start_cycle(start, options.start_points);
    let motion_name = format!("M{}", index + 1);
    let first_held_out = options.motions - options.held_out_motions;
    SuitePlan {
        calibrates: (first_held_out - options.calibration_motions..first_held_out).contains(&index),
        held_out: index >= first_held_out,
        runs: SuiteRuns {
            name: format!("{motion_name}{}", char::from(b'a' + start as u8)),
            first,
            samples: motion.cycles() + 1 - first,
            scatter: (0..options.runs).map(|_| Scatter::random(robot, random)).collect(),
        },
        motion_name,
        motion: motion.clone(),
    }
}
