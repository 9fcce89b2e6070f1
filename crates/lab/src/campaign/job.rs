//! The independent parts of a campaign.

use crate::error::Result;
use crate::motion::{Motion, Planned, SAMPLE_TIME};
use crate::virtual_robot::{
    Arm, Logged, PreRecorded, SuiteRuns, VirtualRobot, VirtualRobotError, record_suite,
};

use super::excitation::ExcitingMotion;
use super::joint_motion::JointMotion;
use super::pose_series::PoseSeries;

/// Samples of a recording of poses between two that are logged: 50 Hz suffice for an arm that
/// mostly rests.
const POSE_STRIDE: usize = 5;

/// One part of a campaign, which nothing else depends on.
pub(super) struct Job {
    /// Kind of the recordings, as the index has it.
    pub kind: &'static str,
    /// Suite and motion, where there is one.
    pub suite: Option<[String; 2]>,
    /// Paths of the files in the folder, one per recording.
    pub files: Vec<String>,
    /// Number of the first recording in its suite or kind, from 1.
    pub first: usize,
    work: Work,
}

/// What the arm does.
pub(super) enum Work {
    /// Runs of a test suite.
    Suite(Motion, SuiteRuns),
    /// Static poses.
    Poses(PoseSeries),
    /// Slow motions of one joint.
    Friction(JointMotion),
    /// An exciting motion.
    Excitation(ExcitingMotion),
}

/// A suite of a campaign before it was recorded.
pub(crate) struct PlannedSuite {
    /// Its name.
    pub name: String,
    /// Name of the motion that it is part of.
    pub motion_name: String,
    /// That motion.
    pub motion: Motion,
    /// Cycle of the motion at which the open loop begins.
    pub first: usize,
}

impl Job {
    /// Returns the job of a test suite.
    pub(super) fn suite(motion_name: &str, motion: Motion, runs: SuiteRuns) -> Self {
        let name = &runs.name;
        let digits = runs.scatter.len().to_string().len().max(2);
        let file = |run: usize| format!("suites/{name}/{name}_{run:0digits$}.csv");
        Self {
            kind: "test_suite",
            suite: Some([name.clone(), motion_name.into()]),
            files: (1..=runs.scatter.len()).map(file).collect(),
            first: 1,
            work: Work::Suite(motion, runs),
        }
    }

    /// Returns the job of recording `index` (from 0) of a kind that identifies the robot.
    pub(super) fn identification(kind: &'static str, index: usize, work: Work) -> Self {
        let files = vec![format!("{kind}/{kind}_{:03}.csv", index + 1)];
        Self { kind, suite: None, files, first: index + 1, work }
    }

    /// Returns the plan of a suite.
    pub(super) fn planned(self) -> Option<PlannedSuite> {
        let [name, motion_name] = self.suite?;
        match self.work {
            Work::Suite(motion, SuiteRuns { first, .. }) => {
                Some(PlannedSuite { name, motion_name, motion, first })
            }
            _ => None,
        }
    }

    /// Simulates the robot and returns the text of each file.
    pub(super) fn record(&self, robot: &VirtualRobot) -> Result<Vec<String>> {
        match &self.work {
            Work::Suite(motion, runs) => {
                let recorded = PreRecorded::new(robot, motion);
                let runs = record_suite(robot, motion, &recorded, runs)?;
                Ok(runs.iter().map(|run| run.to_csv(SAMPLE_TIME, 1)).collect())
            }
            Work::Poses(series) => {
                let plan = |k| series.at(k);
                self.follow(robot, series.start(), series.cycles(), POSE_STRIDE, plan)
            }
            Work::Friction(motion) => {
                self.follow(robot, motion.start(), motion.cycles(), 1, |k| motion.at(k))
            }
            Work::Excitation(motion) => {
                let plan = |k| motion.at(k as f64 * SAMPLE_TIME);
                self.follow(robot, &motion.centre, ExcitingMotion::cycles(), 1, plan)
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
        Err(VirtualRobotError::Diverged { recording, robot }.into())
    }
}
