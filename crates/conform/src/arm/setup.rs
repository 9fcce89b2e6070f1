use std::collections::BTreeMap;
use std::sync::Arc;

use reachtube_abstraction::PolynomialModel;
use reachtube_reach::System;
use reachtube_robot::Robot;

use crate::arm::arm::Arm;
use crate::arm::system::{system, system_of};
use crate::data::problem::Problem;
use crate::data::settings::{Equations, Settings};
use crate::data::setup::Setup;
use crate::error::{Error, Result};

impl Setup {
    /// Makes the model of `robot` that `settings` select.
    ///
    /// # Errors
    ///
    /// Settings that do not fit the robot, a robot that is not physical at the expansion point.
    pub fn new(robot: Robot, settings: Settings) -> Result<Self> {
        settings.validate(robot.joint_count())?;
        let dynamics = system(&robot, &settings)?;
        Self::of(robot, dynamics, settings)
    }

    /// Takes a model as [`PolynomialModel::load`] reads it, with its robot and expansion point.
    ///
    /// # Errors
    ///
    /// Settings that do not fit.
    pub(crate) fn with_abstraction(model: PolynomialModel, settings: Settings) -> Result<Self> {
        let settings = settings.with_abstraction(&model);
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
        Ok(Self::of_arm(Arm::new(robot, None, &settings), dynamics, settings))
    }

    pub(crate) fn of_arm(arm: Arm, dynamics: System, settings: Settings) -> Self {
        let drive = Arc::new(arm);
        Self { drive, dynamics, settings, nominal_starts: BTreeMap::new(), condition: None }
    }

    pub(crate) fn arm(&self) -> &Arm {
        self.drive.any().downcast_ref().expect("an arm drives the system")
    }

    /// Returns the robot.
    #[must_use]
    pub fn robot(&self) -> &Robot {
        self.arm().robot()
    }
}

impl Problem {
    /// Returns the robot.
    #[must_use]
    pub fn robot(&self) -> &Robot {
        self.setup().robot()
    }
}
