//! The plan of a demo: all that is random is drawn from the seed before anything is simulated, so
//! the order of simulation does not matter.

use reachtube_robot::Robot;

use super::options::DemoOptions;
use super::rounding::rounded;
use super::unmodelled::{POSITION_SCATTER, VELOCITY_SCATTER, temperatures};
use crate::motion::{Motion, SAMPLE_TIME};
use crate::random::{SeedableRng, SplitMix64, uniform};

/// Parts of a motion at which the first suite starts and before which the last one starts \[-\].
const STARTS: [f64; 2] = [0.1, 0.9];

/// A test suite before it is recorded.
pub(super) struct SuitePlan {
    /// Name: M1a, M1b, M2a, ...
    pub name: String,
    /// Name of the motion: M1, M2, ...
    pub motion: String,
    /// Whether the suite calibrates the sets.
    pub calibrates: bool,
    /// Whether the suite is held out for the check.
    pub held_out: bool,
    /// The input of all runs \[N m\], row-major K x n.
    pub inputs: Vec<f64>,
    /// The runs, in the order of recording.
    pub runs: Vec<RunPlan>,
}

/// A run before it is recorded.
pub(super) struct RunPlan {
    /// Positions at the start \[rad\], n.
    pub q: Vec<f64>,
    /// Velocities at the start \[rad/s\], n.
    pub qd: Vec<f64>,
    /// Temperatures of the joints \[°C\], n.
    pub temperatures: Vec<f64>,
}

/// Returns all suites, motion by motion.
pub(super) fn suites(robot: &Robot, options: &DemoOptions) -> Vec<SuitePlan> {
    let mut random = SplitMix64::seed_from_u64(options.seed);
    let mut suites = Vec::new();
    for index in 0..options.motions {
        let motion = Motion::random(robot, options.duration, &mut random);
        for start in 0..options.start_points {
            suites.push(suite(robot, options, (&motion, index), start, &mut random));
        }
    }
    suites
}

fn suite(
    robot: &Robot,
    options: &DemoOptions,
    (motion, index): (&Motion, usize),
    start: usize,
    random: &mut SplitMix64,
) -> SuitePlan {
    let samples = (options.duration / SAMPLE_TIME).round();
    let part = STARTS[0] + (STARTS[1] - STARTS[0]) * start as f64 / options.start_points as f64;
    let first = (part * samples).round() as usize;
    let name = format!("M{}", index + 1);
    let first_held_out = options.motions - options.held_out_motions;
    SuitePlan {
        name: format!("{name}{}", char::from(b'a' + start as u8)),
        motion: name,
        calibrates: (first_held_out - options.calibration_motions..first_held_out).contains(&index),
        held_out: index >= first_held_out,
        inputs: (first..=samples as usize)
            .flat_map(|k| motion.held_input(robot, k))
            .map(rounded)
            .collect(),
        runs: (0..options.runs).map(|run| run_plan(motion, first, run, random)).collect(),
    }
}

fn run_plan(motion: &Motion, first: usize, run: usize, random: &mut SplitMix64) -> RunPlan {
    let start = motion.at(first as f64 * SAMPLE_TIME);
    let there_and_back: Vec<f64> = motion.travel.iter().map(|travel| 2.0 * travel).collect();
    let mut scattered =
        |x: Vec<f64>, width: f64| x.iter().map(|x| x + uniform(random, -width, width)).collect();
    RunPlan {
        q: scattered(start.q, POSITION_SCATTER),
        qd: scattered(start.qd, VELOCITY_SCATTER),
        temperatures: temperatures(&there_and_back, run),
    }
}
