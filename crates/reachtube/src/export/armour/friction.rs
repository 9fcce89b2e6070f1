//! Friction as ARMOUR has it.

use reachtube_robot::Robot;
use reachtube_robot::friction::{Friction, Viscous};
use reachtube_scalar::Interval;

use super::settings::refused;
use crate::export::ExportError;
use crate::export::robot::SimulatedFriction;

/// Part by which the bound is wider than computed, for the rounding of a difference.
const ROUNDING: f64 = 1e-9;

/// Friction of a joint as ARMOUR has it: a viscous line, and a bound of the rest.
pub(super) struct JointFriction {
    /// Viscous coefficient \[N m s/rad\].
    pub damping: f64,
    /// Bound of the rest \[N m\].
    pub dry: f64,
    /// Velocity limit \[rad/s\].
    pub speed: f64,
}

impl JointFriction {
    pub(super) fn new(robot: &Robot, j: usize, torque: f64) -> Result<Self, ExportError> {
        let joint = &robot.joints()[j];
        let speed = joint.velocity_limit.ok_or_else(|| {
            let remedy = "add `velocity_limit` to the joint in the robot file";
            refused(robot, &format!("joint {}", joint.name), "it has no velocity limit", remedy)
        })?;
        let damping = SimulatedFriction::new(robot, j).line();
        let viscous = joint.friction.viscous;
        let rest =
            Friction { viscous: Viscous { v1: viscous.v1 - damping, ..viscous }, ..joint.friction };
        let [load, velocity] = [torque, speed].map(|limit| Interval::centred(0.0, limit));
        let dry = rest.range_near_zero(load, velocity).mag() * (1.0 + ROUNDING);
        Ok(Self { damping, dry, speed })
    }
}
