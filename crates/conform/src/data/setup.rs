use std::collections::BTreeMap;

use reachtube_abstraction::{OperatingBox, PolynomialModel};
use reachtube_reach::System;
use reachtube_recordings::{GapLimit, ReadOptions};
use reachtube_robot::Robot;

use crate::arm::system::{system, system_of};
use crate::data::condition::Condition;
use crate::data::correction::InputCorrection;
use crate::data::notion::Notion;
use crate::data::settings::{Equations, Settings};
use crate::error::{Error, Result};

/// What decides a conformance besides the recordings: the robot, its model and the settings.
///
/// The robot names the joints, turns recorded torques into inputs and is written into the model
/// file; all that follows the reading uses only the model.
#[derive(Debug, Clone)]
pub struct Setup {
    /// The robot.
    pub(crate) robot: Robot,
    /// The model of its motion.
    pub(crate) dynamics: System,
    /// The settings.
    pub(crate) settings: Settings,
    /// The nominal initial states of suites by their name, 2n each, where they are known. Any
    /// other suite starts at the mean of the recordings at hand.
    pub(crate) nominal_starts: BTreeMap<String, Vec<f64>>,
    /// What is taken off the recorded inputs along the nominal motions, where anything is.
    pub(crate) correction: Option<InputCorrection>,
    /// The condition that friction is taken in, whatever a run's condition is; `None` if each run
    /// has its own.
    pub(crate) condition: Option<Condition>,
}

impl Setup {
    /// Makes the model of `robot` that `settings` ask for.
    ///
    /// # Errors
    ///
    /// Settings that do not fit the robot, a robot that is not physical at the expansion point.
    pub fn new(robot: Robot, settings: Settings) -> Result<Self> {
        settings.validate(robot.joint_count())?;
        let dynamics = system(&robot, &settings)?;
        Self::of(robot, dynamics, settings)
    }

    /// Takes a model as [`PolynomialModel::load`] reads it, with its robot, expansion point and
    /// operating box.
    ///
    /// # Errors
    ///
    /// [`Error::Unbounded`] when the model's error was found to have no bound over its box, and
    /// settings that do not fit.
    pub(crate) fn with_abstraction(model: PolynomialModel, settings: Settings) -> Result<Self> {
        let settings = settings.with_abstraction(&model)?;
        settings.validate(model.joints())?;
        let robot = Robot::from_description(model.robot())?;
        let dynamics = system_of(model, settings.method);
        Self::of(robot, dynamics, settings)
    }

    /// Takes a model of the motion of `robot`.
    ///
    /// # Errors
    ///
    /// [`Error::Equations`] for the robot's own equations about a model that is not linear.
    pub fn of(robot: Robot, dynamics: System, settings: Settings) -> Result<Self> {
        if settings.equations == Equations::Robot && dynamics.linear_system().is_none() {
            return Err(Error::Equations);
        }
        let nominal_starts = BTreeMap::new();
        let (correction, condition) = (None, None);
        Ok(Self { robot, dynamics, settings, nominal_starts, correction, condition })
    }

    /// Returns the robot.
    #[must_use]
    pub fn robot(&self) -> &Robot {
        &self.robot
    }

    /// Returns the model of its motion.
    #[must_use]
    pub fn dynamics(&self) -> &System {
        &self.dynamics
    }

    /// Returns the settings.
    #[must_use]
    pub fn settings(&self) -> &Settings {
        &self.settings
    }

    /// Replaces what recordings are judged by: the notion and the end of the runs where they are
    /// given, and the limit of gaps.
    #[must_use]
    pub fn judged_by(
        mut self,
        notion: Option<Notion>,
        until: Option<f64>,
        gap_limit: GapLimit,
    ) -> Self {
        let Settings { notion: own_notion, until: own_until, .. } = self.settings;
        self.settings.notion = notion.unwrap_or(own_notion);
        self.settings.until = until.or(own_until);
        self.settings.gap_limit = gap_limit;
        self
    }

    /// Returns whether the model's input is the recorded one, with nothing taken off it along the
    /// nominal motion.
    pub(crate) fn is_recorded_input(&self) -> bool {
        self.correction.is_none()
            && self.robot.warms_by().is_empty()
            && self.settings.equations == Equations::Model
    }
}

pub(crate) fn read_options(setup: &Setup) -> ReadOptions {
    let Settings { gap_limit, until, .. } = setup.settings;
    ReadOptions { joints: Some(setup.robot.joint_count()), gap_limit, until }
}

/// The side of the box for state `i`, q then q̇.
pub(crate) fn side(operating_box: &OperatingBox, i: usize) -> [f64; 2] {
    let n = operating_box.q.len();
    if i < n { operating_box.q[i] } else { operating_box.qd[i - n] }
}
