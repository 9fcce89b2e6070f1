use std::borrow::Cow;

use reachtube_abstraction::{Abstraction, PolynomialModel};
use reachtube_conform::{Error, Result, Settings, Setup};
use reachtube_finding::Advice;
use reachtube_recordings::Torque;
use reachtube_robot::Robot;

use crate::settings::ArmSettings;
use crate::setup::setup_of;
use crate::system::{system, system_of};

/// Makes the setup of a conformance of a robot, or of an abstraction of one.
///
/// # Errors
///
/// As [`Basis::setup`].
pub fn setup(basis: impl Into<Basis>, arm: ArmSettings, settings: Settings) -> Result<Setup> {
    basis.into().setup(arm, settings)
}

const MOTORS: &str = "the abstraction has the inertia of motors, which torques behind the gears do \
                      not drive; make it again of a robot without `armature`";

/// What the nominal model is made of.
#[derive(Debug, Clone)]
pub enum Basis {
    /// A robot, whose model the settings select.
    Robot(Box<Robot>),
    /// A model of a robot, with its own expansion point and order.
    Abstraction(Box<PolynomialModel>),
}

impl From<Robot> for Basis {
    fn from(robot: Robot) -> Self {
        Self::Robot(Box::new(robot))
    }
}

impl From<PolynomialModel> for Basis {
    fn from(model: PolynomialModel) -> Self {
        Self::Abstraction(Box::new(model))
    }
}

impl Basis {
    /// Returns the number of joints n.
    #[must_use]
    pub fn joints(&self) -> usize {
        match self {
            Self::Robot(robot) => robot.joint_count(),
            Self::Abstraction(model) => model.joints(),
        }
    }

    /// Returns the robot.
    ///
    /// # Errors
    ///
    /// A description in the file of an abstraction that is none.
    pub fn robot(&self) -> Result<Cow<'_, Robot>> {
        Ok(match self {
            Self::Robot(robot) => Cow::Borrowed(robot),
            Self::Abstraction(model) => {
                Cow::Owned(Robot::from_description(model.robot()).map_err(Error::other)?)
            }
        })
    }

    /// Makes the setup of a conformance. Torques behind the gears do not drive the motors, whose
    /// inertia the model then does not have.
    ///
    /// # Errors
    ///
    /// Settings that do not fit the robot or the model; a robot that is not physical.
    pub fn setup(self, arm: ArmSettings, settings: Settings) -> Result<Setup> {
        match self {
            Self::Robot(robot) => {
                let robot = match arm.torque {
                    Torque::Link => Box::new(robot.without_motors()),
                    Torque::Motor | Torque::Compensated => robot,
                };
                robot.check_physical().map_err(Error::other)?;
                settings.validate(robot.joint_count())?;
                let dynamics = system(&robot, &arm, settings.method)?;
                setup_of(*robot, dynamics, arm, settings)
            }
            Self::Abstraction(model) => {
                let robot = Robot::from_description(model.robot()).map_err(Error::other)?;
                let has_motors = robot.joints().iter().any(|joint| joint.armature > 0.0);
                if arm.torque == Torque::Link && has_motors {
                    return Err(Error::Drive(Advice::from(MOTORS)));
                }
                robot.check_physical().map_err(Error::other)?;
                let abstraction = Abstraction { model: model.kind(), order: model.order() };
                let expansion_point = model.expansion_point().clone();
                let arm = ArmSettings { abstraction, expansion_point, ..arm };
                setup_of(robot, system_of(*model, settings.method), arm, settings)
            }
        }
    }
}
