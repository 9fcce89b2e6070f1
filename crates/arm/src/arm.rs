//! An arm and what its recorded torques are.

use std::sync::Arc;

use reachtube_conform::data::{Condition, Signals};
use reachtube_robot::Robot;

use crate::correction::InputCorrection;
use crate::settings::{ArmSettings, Equations};
use crate::signals::signals;

/// An arm that drives a model of its motion by the torques of recordings.
#[derive(Debug, Clone)]
pub struct Arm {
    pub(crate) robot: Arc<Robot>,
    /// What is taken off the recorded inputs along the nominal motions, where anything is.
    pub(crate) correction: Option<InputCorrection>,
    /// What the recorded torques are, and the model that was selected.
    pub settings: ArmSettings,
    pub(crate) signals: Signals,
}

impl Arm {
    /// Takes a robot, a correction of its inputs, and what settings say of both.
    pub(crate) fn new(
        robot: Robot,
        correction: Option<InputCorrection>,
        settings: ArmSettings,
    ) -> Self {
        let signals = signals(&robot, settings.equations);
        Self { robot: Arc::new(robot), correction, settings, signals }
    }

    /// Returns the robot.
    #[must_use]
    pub fn robot(&self) -> &Robot {
        &self.robot
    }

    /// Returns the robot as warm as it is in a condition; `None` if its friction does not change.
    /// A law of temperature without a recorded temperature keeps its reference.
    pub(super) fn warm(&self, at: &Condition) -> Option<Robot> {
        if self.robot.warms_by().is_empty() {
            return None;
        }
        let warm = self.robot.at_run(at.place as f64);
        Some(match &at.temperatures {
            Some(temperatures) => warm.at_temperature(temperatures),
            None => warm,
        })
    }

    /// Returns whether the model's input is the recorded one, with nothing taken off it along the
    /// nominal motion.
    pub(super) fn is_recorded_input(&self) -> bool {
        self.correction.is_none()
            && self.robot.warms_by().is_empty()
            && self.settings.equations != Equations::Robot
    }
}
