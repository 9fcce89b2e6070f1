//! The drive of a joint.

use crate::friction::joint_friction::Friction;

/// Name, limits, motor and friction of a joint, without the link that it moves.
#[derive(Clone, Debug, PartialEq)]
pub struct Joint {
    /// Name, unique in the robot.
    pub name: String,
    /// Lowest and highest position \[rad\].
    pub position_limits: [f64; 2],
    /// Highest speed \[rad/s\], if known.
    pub velocity_limit: Option<f64>,
    /// Gear ratio k_r, if known.
    pub gear_ratio: Option<f64>,
    /// Motor inertia on the link side k_r² I_m \[kg m²\].
    pub armature: f64,
    /// Friction.
    pub friction: Friction,
}
