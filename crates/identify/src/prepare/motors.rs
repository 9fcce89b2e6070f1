use crate::prepare::log::PreparedLog;
use reachtube_robot::Robot;

/// Adds to the input what the motors' inertia takes, J q̈, which a sensor behind the gear does not
/// measure.
pub(super) fn add_motor_inertia(log: &mut PreparedLog, robot: &Robot) {
    let inertia = robot.joints().iter().map(|joint| joint.armature).cycle();
    let accelerations = log.tau.iter_mut().zip(&log.qdd).zip(inertia);
    accelerations.for_each(|((tau, qdd), inertia)| *tau += inertia * qdd);
}
