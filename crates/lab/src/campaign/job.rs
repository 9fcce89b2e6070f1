//! The independent parts of a campaign.

use super::excitation::ExcitingMotion;
use super::motion_series::MotionSeries;
use crate::error::{Error, Result};
use crate::motion::{Motion, Planned, SAMPLE_TIME};
use crate::virtual_robot::{Arm, Logged, PreRecorded, SuiteRuns, VirtualRobot, record_suite};

/// One part of a campaign, which nothing else depends on.
pub(super) struct Job {
    /// Kind of the recordings, as the index has it.
    pub kind: &'static str,
    /// Paths of the files in the folder, one per recording.
    pub files: Vec<String>,
    /// Number of the first recording in its suite or kind, from 1.
    pub first: usize,
    pub work: Work,
}

/// What the arm does.
pub(super) enum Work {
    /// Runs of a test suite.
    Suite(SuiteOf, Motion, SuiteRuns),
    /// Motions and rests, with the stride of the samples that are logged.
    Series(MotionSeries, usize),
    /// An exciting motion, with that stride.
    Excitation(ExcitingMotion, usize),
}

/// What a suite belongs to.
#[derive(Clone)]
pub(super) struct SuiteOf {
    /// Name of its motion.
    pub motion: String,
    /// Whether it is held out for a check of the model.
    pub is_held_out: bool,
}

impl Job {
    pub(super) fn suite(folder: &str, of: SuiteOf, motion: Motion, runs: SuiteRuns) -> Self {
        let name = &runs.name;
        let digits = runs.scatter.len().to_string().len().max(2);
        let file = |run: usize| format!("{folder}{name}/{name}_{run:0digits$}.csv");
        let files = (1..=runs.scatter.len()).map(file).collect();
        Self { kind: "test_suite", files, first: 1, work: Work::Suite(of, motion, runs) }
    }

    pub(super) fn identification(kind: &'static str, index: usize, work: Work) -> Self {
        let files = vec![format!("{kind}/{kind}_{:03}.csv", index + 1)];
        Self { kind, files, first: index + 1, work }
    }

    pub(super) fn as_suite(&self) -> Option<(&SuiteRuns, &SuiteOf)> {
        match &self.work {
            Work::Suite(of, _, runs) => Some((runs, of)),
            _ => None,
        }
    }

    pub(super) fn record(&self, robot: &VirtualRobot) -> Result<Vec<String>> {
        match &self.work {
            Work::Suite(_, motion, runs) => {
                let recorded = PreRecorded::new(robot, motion);
                let runs = record_suite(robot, motion, &recorded, runs)?;
                Ok(runs.iter().map(|run| run.to_csv(SAMPLE_TIME, 1)).collect())
            }
            Work::Series(series, stride) => {
                self.follow(robot, series.start(), series.cycles(), *stride, |k| series.at(k))
            }
            Work::Excitation(motion, stride) => {
                let plan = |k| motion.at(k as f64 * SAMPLE_TIME);
                self.follow(robot, &motion.centre, ExcitingMotion::cycles(), *stride, plan)
            }
        }
    }

    /// Follows a plan closed loop, and returns the text of a file with every `stride`-th sample.
    /// The joints begin at the nominal temperature, as in an arm that has warmed up.
    fn follow(
        &self,
        robot: &VirtualRobot,
        start: &[f64],
        cycles: usize,
        stride: usize,
        plan: impl Fn(usize) -> Planned,
    ) -> Result<Vec<String>> {
        let warm = vec![robot.parameters().nominal_temperature; start.len()];
        let recording = Arm::at_rest(robot, start, &warm).follow(cycles, Logged::Motor, plan);
        if recording.is_finite() {
            return Ok(vec![recording.to_csv(SAMPLE_TIME, stride)]);
        }
        let (recording, robot) = (self.files[0].clone(), robot.nominal().name().into());
        Err(Error::Diverged { recording, robot })
    }
}
