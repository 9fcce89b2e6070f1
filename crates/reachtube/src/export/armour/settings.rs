//! What ARMOUR takes that no model has, and what it cannot have.

use reachtube_robot::Robot;

use crate::export::ExportError;

/// What ARMOUR takes that no model has.
#[derive(Debug, Clone, PartialEq)]
pub struct ArmourSettings {
    /// Ratio by which each link's mass and each entry of its inertia may differ, 0 to below 1.
    pub uncertainty: f64,
    /// Largest torque of each joint \[N m\].
    pub torque_limits: Vec<f64>,
}

/// Returns the refusal of a part of a robot or of a setting.
pub(super) fn refused(robot: &Robot, place: &str, problem: &str, remedy: &str) -> ExportError {
    ExportError::Refused {
        place: format!("{}: {place}", robot.name()),
        problem: problem.into(),
        remedy: remedy.into(),
    }
}
