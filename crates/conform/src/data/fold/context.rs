use std::path::Path;

use reachtube_recordings::{Defect, DefectKind, ReadOptions, Run, Torque};
use reachtube_robot::Robot;
use sha2::{Digest, Sha256};

use crate::advice::Advice;
use crate::data::input::RunInput;
use crate::data::settings::{NominalStart, Settings};
use crate::data::setup::{Setup, read_options, side};
use crate::error::{Error, Result};

/// What the reading of recordings depends on.
#[derive(Debug)]
pub(crate) struct Context {
    pub robot: Robot,
    pub torque: Torque,
    pub options: ReadOptions,
    /// Whether every run has a nominal motion of its own, whatever its input.
    pub is_own: bool,
    /// The box that runs must start in, 2n, where there is one.
    pub start_box: Option<Vec<[f64; 2]>>,
    /// SHA-256 of all this.
    pub digest: [u8; 32],
}

impl Context {
    /// Takes from a setup what the reading depends on.
    ///
    /// # Errors
    ///
    /// Settings that need every run sample by sample.
    pub(crate) fn new(setup: &Setup) -> Result<Self> {
        let Setup { robot, settings, correction, .. } = setup;
        settings.validate(robot.joint_count())?;
        let is_linear = setup.dynamics.linear_system().is_some();
        let Settings { notion, .. } = settings;
        if notion.asks_points() && !is_linear {
            let problem = "every notion but the hull needs whole recordings of a model that is \
                           not linear: use the notion hull, or read the recordings on one machine";
            return Err(Error::Fold(Advice::from(problem).with("notion", "hull")));
        }
        let is_own = settings.nominal == NominalStart::Own
            || setup.condition.is_none()
                && (!robot.warms_by().is_empty()
                    || correction.as_ref().is_some_and(|c| c.differs_by_run()));
        let start_box = settings.operating_box.as_ref();
        let start_box =
            start_box.map(|sides| (0..2 * robot.joint_count()).map(|i| side(sides, i)).collect());
        let options = read_options(setup);
        let parts = (robot.description(), settings.torque, settings.until, &start_box, is_own);
        let mut text = serde_json::to_string(&parts).expect("settings have string keys");
        text += &format!("{:?}", options.gap_limit);
        let digest = Sha256::digest(text).into();
        let (robot, torque) = (robot.clone(), settings.torque);
        Ok(Self { robot, torque, options, is_own, start_box, digest })
    }

    /// Returns the input along a run.
    ///
    /// # Errors
    ///
    /// The defects of the run.
    pub(crate) fn input(&self, file: &str, run: &Run) -> Result<RunInput, Vec<Defect>> {
        let (path, n) = (Path::new(file), self.robot.joint_count());
        let lengths = [run.states.len(), 2 * run.torques.len()];
        if run.joints != n || run.is_empty() || lengths != [2 * n * run.len(); 2] {
            let problem = format!(
                "the run has {} samples of {} joints, but the robot has {n}",
                run.len(),
                run.joints
            );
            let remedy = "give the robot of the recordings, and one sample at least";
            let defect = Defect::new(path, None, problem, remedy).of_kind(DefectKind::Joints);
            return Err(vec![defect]);
        }
        RunInput::new(path, run, &self.robot, self.torque)
    }
}
