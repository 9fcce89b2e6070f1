use reachtube_recordings::{Axis, Torque};
use reachtube_robot::{Joint, JointDescription, JointKind, Robot};

/// Returns the joints of a robot as reading its recordings needs them.
#[must_use]
pub fn axes(robot: &Robot) -> Vec<Axis> {
    let axis = |(joint, described): (&Joint, &JointDescription)| Axis {
        name: joint.name.clone(),
        is_revolute: joint.kind == JointKind::Revolute,
        units: [joint.kind.position_unit(), joint.kind.velocity_unit(), joint.kind.force_unit()],
        position_limits: described.position_limits,
        velocity_limit: joint.velocity_limit,
    };
    robot.joints().iter().zip(&robot.description().joints).map(axis).collect()
}

/// Returns the input u (n, N m) of the model at one sample with positions `q` (n, rad), velocities
/// `qd` (n, rad/s) and recorded torques `tau` (n, N m). The result in double precision is by
/// definition the input of the model.
#[must_use]
pub fn input(torque: Torque, robot: &Robot, q: &[f64], qd: &[f64], tau: &[f64]) -> Vec<f64> {
    match torque {
        Torque::Compensated => tau.to_vec(),
        Torque::Motor => robot.input_from_motor_torque(q, qd, tau).data.into(),
        Torque::Link => robot.input_from_link_torque(q, qd, tau).data.into(),
    }
}
