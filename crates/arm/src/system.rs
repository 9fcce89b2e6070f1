use std::sync::Arc;

use reachtube_abstraction::{Abstraction, PolynomialModel};
use reachtube_conform::settings::Method;
use reachtube_conform::{Error, Result};
use reachtube_reach::System;
use reachtube_robot::Robot;

use crate::kinematic;
use crate::settings::ArmSettings;

/// Makes the model of `robot` that `settings` select.
///
/// # Errors
///
/// When the robot is not physical at the expansion point, or the order does not fit.
pub(super) fn system(robot: &Robot, settings: &ArmSettings, method: Method) -> Result<System> {
    if settings.equations.is_kinematic() {
        return Ok(System::Linear(kinematic::system(robot.joint_count())?));
    }
    let Abstraction { model, order } = settings.abstraction;
    let polynomials = PolynomialModel::new(robot, model, order, &settings.expansion_point);
    Ok(system_of(polynomials.map_err(Error::other)?, method))
}

/// Takes a model; it counts as linear when its polynomials are and `method` solves a program.
/// [`Method::Bisection`] has no program.
pub(super) fn system_of(polynomials: PolynomialModel, method: Method) -> System {
    let linear = match method {
        Method::Program => polynomials.linear_system().ok(),
        Method::Bisection => None,
    };
    linear.map_or_else(|| System::Nonlinear(Arc::new(polynomials)), System::Linear)
}

/// Returns the polynomials of a model that is not treated as linear.
pub(super) fn polynomials(system: &System) -> Option<&PolynomialModel> {
    system.nonlinear_system().and_then(|system| system.any().downcast_ref())
}
