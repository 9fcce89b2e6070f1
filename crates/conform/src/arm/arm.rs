//! An arm and what its recorded torques are.

use std::sync::Arc;

use reachtube_abstraction::{Abstraction, ExpansionPoint};
use reachtube_recordings::Torque;
use reachtube_robot::Robot;

use crate::arm::correction::InputCorrection;
use crate::data::condition::Condition;
use crate::data::part::Part;
use crate::data::settings::{Equations, Settings};

/// An arm that drives a model of its motion by the torques of recordings.
#[derive(Debug, Clone)]
pub(crate) struct Arm {
    pub robot: Arc<Robot>,
    /// What is taken off the recorded inputs along the nominal motions, where anything is.
    pub correction: Option<InputCorrection>,
    /// What the recorded torques are.
    pub torque: Torque,
    pub abstraction: Abstraction,
    pub expansion_point: ExpansionPoint,
    /// Whose equations of motion the nominal motions satisfy.
    pub equations: Equations,
    /// The joints, with the position and the velocity of each.
    pub parts: Vec<Part>,
}

impl Arm {
    /// Takes a robot, a correction of its inputs, and what settings say of both.
    pub(crate) fn new(
        robot: Robot,
        correction: Option<InputCorrection>,
        settings: &Settings,
    ) -> Self {
        let n = robot.joint_count();
        Self {
            parts: (0..n).map(|joint| Part { states: vec![joint, n + joint] }).collect(),
            robot: Arc::new(robot),
            correction,
            torque: settings.torque,
            abstraction: settings.abstraction,
            expansion_point: settings.expansion_point.clone(),
            equations: settings.equations,
        }
    }

    pub(crate) fn robot(&self) -> &Robot {
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
            && self.equations == Equations::Model
    }
}
