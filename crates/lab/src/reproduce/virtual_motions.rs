//! Small campaigns of the virtual robot.

use reachtube_arm::{ArmSettings, setup};
use std::ops::Range;

use rayon::prelude::*;
use reachtube_conform::{Keep, Problem, Settings, Silent, Tube, Verdict};
use reachtube_recordings::{MemoryRuns, Run, Torque};
use reachtube_robot::Robot;

use crate::error::Result;
use crate::motion::{Motion, SAMPLE_TIME};
use crate::random::{SplitMix64, uniform};
use crate::virtual_robot::{
    PreRecorded, Recording, Scatter, SuiteRuns, VirtualRobot, record_suite,
};

/// Number of samples of a run: 0.5 s.
const SAMPLES: usize = 126;

/// Runs of one motion, of which the first is cold.
const RUNS: usize = 2;

/// Number of points at which the open loop may begin, as in a campaign.
const START_POINTS: usize = 4;

/// Records motions M0, M1, ... of the virtual robot, on all cores. They are drawn independently
/// from one distribution, a campaign's: random point-to-point motions, of which the open loop
/// begins at one of four points. A motion is a suite of two runs.
pub(super) fn virtual_motions(
    robot: &VirtualRobot,
    count: usize,
    random: &mut SplitMix64,
) -> Result<MemoryRuns> {
    let drawn: Vec<(Motion, SuiteRuns)> =
        (0..count).map(|index| drawn(robot, index, random)).collect();
    let record = |(motion, runs): &(Motion, SuiteRuns)| {
        let recorded = PreRecorded::until(robot, motion, runs.first + runs.samples);
        record_suite(robot, motion, &recorded, runs)
    };
    let recorded: Vec<Vec<Recording>> = drawn.par_iter().map(record).collect::<Result<_>>()?;
    let mut motions = MemoryRuns::default();
    for ((_, SuiteRuns { name, .. }), runs) in drawn.iter().zip(&recorded) {
        for (number, run) in runs.iter().enumerate() {
            motions.push(&format!("{name}_{number}"), Some(name), Some(name), in_memory(run));
        }
    }
    Ok(motions)
}

pub(super) fn motion_names(range: Range<usize>) -> Vec<String> {
    range.map(|m| format!("M{m}")).collect()
}

/// Returns the problem of some of the motions, of which the first `calibrating` are held out.
pub(super) fn problem(
    motions: MemoryRuns,
    used: Range<usize>,
    calibrating: usize,
) -> Result<Problem> {
    let calibrate = motion_names(used.start..used.start + calibrating);
    let settings = Settings { calibrate, ..Settings::default() };
    let arm = ArmSettings::new(Torque::Compensated, 6);
    let setup = setup(Robot::lwa4p(), arm, settings)?;
    Ok(Problem::read(setup, Box::new(motions), &motion_names(used), Keep::Needed, &Silent)?)
}

pub(super) fn truth(next: &Problem, tube: &Tube) -> Result<f64> {
    let tube = Tube::new(next, tube.sets.clone())?;
    let verdict = Verdict::new(next, &tube)?;
    let leaving = verdict.suites.iter().filter(|suite| !suite.holds()).count();
    Ok(leaving as f64 / verdict.suites.len() as f64)
}

fn drawn(robot: &VirtualRobot, index: usize, random: &mut SplitMix64) -> (Motion, SuiteRuns) {
    let motion = Motion::uniform(robot.nominal(), random);
    let start = uniform(random, 0.0, START_POINTS as f64) as usize;
    let first = motion.start_cycle(start, START_POINTS);
    let runs = SuiteRuns {
        name: format!("M{index}"),
        first,
        samples: SAMPLES.min(motion.cycles() - first + 1),
        scatter: (0..RUNS).map(|_| Scatter::random(robot, random)).collect(),
    };
    (motion, runs)
}

fn in_memory(recording: &Recording) -> Run {
    let n = recording.joints;
    let rows = recording.q.chunks_exact(n).zip(recording.qd.chunks_exact(n));
    let states = rows.flat_map(|(q, qd)| q.iter().chain(qd).copied()).collect();
    let times = (0..recording.len()).map(|k| k as f64 * SAMPLE_TIME).collect();
    Run::new(n, times, states, recording.torques.clone()).expect("the sizes fit")
}
