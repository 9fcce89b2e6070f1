use std::sync::Arc;

use reachtube_conform::data::Drive;
use reachtube_conform::{Error, Problem, Result, Settings, Setup};
use reachtube_finding::Advice;
use reachtube_reach::System;
use reachtube_robot::Robot;

use crate::arm::Arm;
use crate::kinematic::Kinematic;
use crate::settings::{ArmSettings, Equations};

/// Makes the setup of a robot with a model of its motion.
///
/// # Errors
///
/// [`Error::Drive`] for the robot's own equations about a model that is not linear; settings that
/// do not fit.
pub fn setup_of(
    robot: Robot,
    dynamics: System,
    arm: ArmSettings,
    settings: Settings,
) -> Result<Setup> {
    if arm.equations == Equations::Robot && dynamics.linear_system().is_none() {
        return Err(not_linear());
    }
    Setup::new(driven(Arm::new(robot, None, arm)), dynamics, settings)
}

/// Returns what drives the model of an arm: its torque, or nothing but where it starts.
pub(crate) fn driven(arm: Arm) -> Arc<dyn Drive> {
    match arm.settings.equations.is_kinematic() {
        true => Arc::new(Kinematic(arm)),
        false => Arc::new(arm),
    }
}

/// Nominal motions by the robot's own equations were asked of a model that is not linear.
pub(crate) fn not_linear() -> Error {
    let words = "nominal motions by the robot's own equations need a linear model, which then \
                 describes deviations only; use model 1 of order 1 with the method program, or let \
                 nominal motions follow the model's equations";
    Error::Drive(Advice::from(words).with("equations", "model"))
}

/// What is driven by an arm.
pub trait OfArm {
    /// Returns the arm.
    ///
    /// # Panics
    ///
    /// Where something else drives the system.
    fn arm(&self) -> &Arm;

    /// Returns the robot.
    ///
    /// # Panics
    ///
    /// As [`arm`](Self::arm).
    fn robot(&self) -> &Robot {
        self.arm().robot()
    }
}

impl OfArm for Setup {
    fn arm(&self) -> &Arm {
        self.drive().any().downcast_ref().expect("an arm drives the system")
    }
}

impl OfArm for Problem {
    fn arm(&self) -> &Arm {
        self.setup().arm()
    }
}
