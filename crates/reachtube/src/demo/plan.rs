//! What is to be recorded: drawn from the seed before anything is simulated, so that the order of
//! simulation does not matter.

use reachtube_robot::Robot;

use super::hidden::{self, SCATTER_Q, SCATTER_QD};
use super::number::rounded;
use super::{DemoOptions, SAMPLE_TIME};
use crate::motion::Motion;
use crate::random::{SeedableRng, SplitMix64, uniform};

/// Parts of a motion at which the first suite starts, and after which none does.
const STARTS: [f64; 2] = [0.1, 0.9];

/// A test suite before it is recorded.
pub(super) struct SuitePlan {
    /// M1a, M1b, M2a, ...
    pub name: String,
    /// M1, M2, ...
    pub motion: String,
    /// Whether it is kept for the check.
    pub held_out: bool,
    /// The pre-recorded input, N m, row-major K x n.
    pub inputs: Vec<f64>,
    /// The runs, in the order of recording.
    pub runs: Vec<RunPlan>,
}

/// A run before it is recorded.
pub(super) struct RunPlan {
    /// Where the robot starts, rad.
    pub q: Vec<f64>,
    /// How fast it is there, rad/s.
    pub qd: Vec<f64>,
    /// Temperature of each joint, °C.
    pub temperatures: Vec<f64>,
}

/// All suites, motion by motion.
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
    // The plan in the middle of a sample is what holding an input over the sample does best.
    let input = |k: usize| motion.input(robot, (k as f64 + 0.5) * SAMPLE_TIME);
    let name = format!("M{}", index + 1);
    SuitePlan {
        name: format!("{name}{}", char::from(b'a' + start as u8)),
        motion: name,
        held_out: index >= options.motions - options.held_out_motions,
        inputs: (first..=samples as usize).flat_map(input).map(rounded).collect(),
        runs: (0..options.runs).map(|run| run_plan(motion, first, run, random)).collect(),
    }
}

fn run_plan(motion: &Motion, first: usize, run: usize, random: &mut SplitMix64) -> RunPlan {
    let start = motion.at(first as f64 * SAMPLE_TIME);
    let there_and_back: Vec<f64> = motion.travel.iter().map(|travel| 2.0 * travel).collect();
    let mut scattered =
        |x: Vec<f64>, width: f64| x.iter().map(|x| x + uniform(random, -width, width)).collect();
    RunPlan {
        q: scattered(start.q, SCATTER_Q),
        qd: scattered(start.qd, SCATTER_QD),
        temperatures: hidden::temperatures(&there_and_back, run),
    }
}
