//! The drive of a joint.

use crate::friction::joint_friction::Friction;
use crate::joint_kind::JointKind;

/// Name, limits, motor and friction of a joint, without the link that it moves.
#[derive(Clone, Debug, PartialEq)]
pub struct Joint {
    /// Name, unique in the robot.
    pub name: String,
    /// Kind, from which the units of all values follow.
    pub kind: JointKind,
    /// Lowest and highest position \[rad; m for a prismatic joint\].
    pub position_limits: [f64; 2],
    /// Highest speed \[rad/s; m/s\], if known.
    pub velocity_limit: Option<f64>,
    /// Gear ratio k_r, if known \[dimensionless; rad/m for a prismatic joint\].
    pub gear_ratio: Option<f64>,
    /// Motor inertia on the link side k_r² I_m \[kg m²; kg\].
    pub armature: f64,
    /// Friction.
    pub friction: Friction,
}
