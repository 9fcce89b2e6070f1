//! Variants of a robot: the same geometry with other parameters.

use crate::bodies::pseudo_inertia::PER_LINK;
use crate::error::Result;
use nalgebra::DVector;
use reachtube_robot::{
    FrictionDescription, GravityMoments, Parameter, ParameterSet, Robot, RobotDescription,
};

/// Returns the robot with the gravity of its links.
///
/// Without `motor_inertia` it has no motor inertia either, because the torque does not drive it.
pub(crate) fn with_gravity_of_links(robot: &Robot, motor_inertia: bool) -> Result<Robot> {
    let robot = if motor_inertia { robot } else { &robot.without_motors() };
    let mut description = robot.description().clone();
    description.joints.iter_mut().for_each(|joint| joint.gravity_moments = None);
    Ok(Robot::from_description(&description)?)
}

pub(crate) fn with_friction(robot: &Robot, friction: &[FrictionDescription]) -> Result<Robot> {
    let mut description = robot.description().clone();
    for (joint, friction) in description.joints.iter_mut().zip(friction) {
        joint.friction = *friction;
    }
    Ok(Robot::from_description(&description)?)
}

/// Returns the robot with other inertial parameters, which need not be physically consistent.
pub(crate) fn with_parameters(
    robot: &Robot,
    columns: &[Parameter],
    values: &DVector<f64>,
) -> Result<Robot> {
    let base = RobotDescription { parameters: ParameterSet::Base, ..robot.description().clone() };
    Ok(Robot::from_description(&base.with_values(columns, values.as_slice())?)?)
}

pub(crate) fn set_gravity_moments(description: &mut RobotDescription, fitted: &Robot) {
    let parameters = fitted.inertial_parameters();
    for (joint, link) in description.joints.iter_mut().zip(parameters.chunks_exact(PER_LINK)) {
        joint.gravity_moments =
            Some(GravityMoments { mass: link[0], first_moment: [link[1], link[2], link[3]] });
    }
}
