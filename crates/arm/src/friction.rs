//! Friction at speeds that it was not fitted on.

use reachtube_conform::Code;
use reachtube_conform::plausibility::Remark;
use reachtube_robot::Robot;

/// Speeds beyond the fitted ones by this part are remarked: filters differ.
const TOLERANCE: f64 = 0.02;

/// Returns the remark of a kind about the friction of a joint (from 0), if there is one.
pub(super) fn remark(
    robot: &Robot,
    code: Code,
    joint: usize,
    recorded: &dyn Fn(usize) -> [f64; 2],
) -> Option<Remark> {
    let velocities = || recorded(robot.joint_count() + joint);
    let (speed, limit) = match code {
        Code::FrictionRange => beyond_fitted(robot, joint, velocities)?,
        Code::FallingFriction => falling(robot, joint, velocities)?,
        _ => return None,
    };
    let unit = robot.joints()[joint].kind.velocity_unit();
    let text = format!("joint {} {speed:.2} {unit}, {limit:.2}", joint + 1);
    Some(Remark { code, part: joint + 1, text })
}

/// Returns the speed of a joint where the recordings are faster than the recordings that its
/// friction was fitted to, and the fitted speed, where the robot's description knows it.
fn beyond_fitted(
    robot: &Robot,
    joint: usize,
    recorded: impl Fn() -> [f64; 2],
) -> Option<(f64, f64)> {
    let fitted = robot.description().joints[joint].friction.fitted_velocities?;
    let [low, high] = recorded();
    let room = TOLERANCE * (fitted[1] - fitted[0]);
    match (fitted[0] - low, high - fitted[1]) {
        (below, above) if below > room.max(above) => Some((-low, -fitted[0])),
        (_, above) if above > room => Some((high, fitted[1])),
        _ => None,
    }
}

/// Returns the speed from which on the viscous friction of a joint falls, and the velocity limit of
/// the joint before which it does, or the highest recorded speed without one.
fn falling(robot: &Robot, joint: usize, recorded: impl Fn() -> [f64; 2]) -> Option<(f64, f64)> {
    let own = &robot.joints()[joint];
    let [low, high] = recorded();
    let limit = own.velocity_limit.unwrap_or(0.0).max(high.max(-low));
    Some((own.friction.viscous.falls_beyond(limit)?, limit))
}
