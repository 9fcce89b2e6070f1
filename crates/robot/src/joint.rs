//! The drive of a joint.

use crate::friction::coulomb::NEAR_STANDSTILL;
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

impl Joint {
    /// Returns the velocity \[rad/s; m/s\] within the limit at which friction at no load drives
    /// the joint most; `None` if it brakes everywhere. Without a limit, friction near standstill
    /// counts.
    ///
    /// # Examples
    ///
    /// ```
    /// use reachtube_robot::Robot;
    /// use reachtube_robot::friction::Viscous;
    ///
    /// let mut joint = Robot::lwa4p().joints()[0].clone();
    /// assert_eq!(joint.friction_drives_at(), None);
    /// joint.friction.viscous = Viscous { v1: -100.0, v2: 0.0, v3: 0.0 };
    /// assert_eq!(joint.friction_drives_at().map(f64::abs), joint.velocity_limit);
    /// ```
    #[must_use]
    pub fn friction_drives_at(&self) -> Option<f64> {
        self.friction.drives_at(self.velocity_limit.unwrap_or(NEAR_STANDSTILL))
    }
}
