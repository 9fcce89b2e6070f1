//! The kinds of joint, and the units that belong to them.

use crate::placement::{Placement, rotation_from_z, rotation_z, snapped_sin_cos};
use core::f64::consts::{PI, TAU};
use core::fmt;
use nalgebra::Vector3;
use reachtube_finding::Units;
use reachtube_scalar::SineCosine;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The kind of a joint: how its position moves the link.
///
/// # Examples
///
/// ```
/// use reachtube_robot::JointKind;
///
/// assert_eq!(JointKind::Revolute.velocity_unit(), "rad/s");
/// assert_eq!(JointKind::Prismatic.force_unit(), "N");
/// assert_eq!(JointKind::Prismatic.sin_cos(&0.3), (0.3, 1.0));
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum JointKind {
    /// The link rotates about the axis: q in rad, q̇ in rad/s, torque in N m, armature in kg m².
    #[default]
    Revolute,
    /// The link slides along the axis: q in m, q̇ in m/s, the force along the axis in N as its
    /// torque, and a mass in kg as its armature.
    Prismatic,
}

impl JointKind {
    /// Returns whether this is the default kind.
    pub(crate) fn is_revolute(&self) -> bool {
        *self == Self::Revolute
    }

    /// Returns the unit of a position.
    #[must_use]
    pub fn position_unit(self) -> &'static str {
        match self {
            Self::Revolute => "rad",
            Self::Prismatic => "m",
        }
    }

    /// Returns the unit of a velocity.
    #[must_use]
    pub fn velocity_unit(self) -> &'static str {
        match self {
            Self::Revolute => "rad/s",
            Self::Prismatic => "m/s",
        }
    }

    /// Returns the unit of an acceleration.
    #[must_use]
    pub fn acceleration_unit(self) -> &'static str {
        match self {
            Self::Revolute => "rad/s²",
            Self::Prismatic => "m/s²",
        }
    }

    /// Returns the unit of a torque, which is a force for a prismatic joint.
    #[must_use]
    pub fn force_unit(self) -> &'static str {
        match self {
            Self::Revolute => "N m",
            Self::Prismatic => "N",
        }
    }

    /// Returns the unit of viscous friction.
    #[must_use]
    pub fn damping_unit(self) -> &'static str {
        match self {
            Self::Revolute => "N m s/rad",
            Self::Prismatic => "N s/m",
        }
    }

    /// Returns the unit of an armature or of a pivot of the mass matrix.
    #[must_use]
    pub fn inertia_unit(self) -> &'static str {
        match self {
            Self::Revolute => "kg m^2",
            Self::Prismatic => "kg",
        }
    }

    /// Returns the units of a list of values, one per joint.
    #[must_use]
    pub fn column(kinds: &[Self], unit: fn(Self) -> &'static str) -> Units {
        Units::new(kinds.iter().map(|kind| unit(*kind)))
    }

    /// Returns the motion of a joint by q along or about a unit axis.
    pub(crate) fn motion(self, axis: &Vector3<f64>, q: f64) -> Placement {
        match self {
            Self::Revolute if q == 0.0 => Placement::identity(),
            Self::Revolute => {
                let onto_axis = rotation_from_z(axis);
                let about_z = rotation_z(snapped_sin_cos(q));
                Placement::rotation(onto_axis * about_z * onto_axis.transpose())
            }
            Self::Prismatic => Placement::translation(q * axis.x, q * axis.y, q * axis.z),
        }
    }

    /// Returns the lowest and the highest position \[rad\] of a joint without limits of its own;
    /// nothing bounds a prismatic joint.
    pub(crate) fn default_limits(self) -> Option<[f64; 2]> {
        (self == Self::Revolute).then_some([-PI, PI])
    }

    /// Returns why a joint with these limits cannot be locked at a position.
    pub(crate) fn problem_of_lock(self, q: f64, limits: Option<[f64; 2]>) -> Option<String> {
        let unit = self.position_unit();
        match (limits, self) {
            (Some([low, high]), _) if !(low..=high).contains(&q) => Some(format!(
                "it is locked at {q} {unit}, but its limits are {low} and {high} {unit}"
            )),
            // A value in degrees.
            (None, Self::Revolute) if q.is_nan() || q.abs() > TAU => {
                Some(format!("it is locked at {q} {unit}, more than a turn"))
            }
            _ => None,
        }
    }

    /// Returns the pair of functions of q that the dynamics takes: (sin q, cos q) of a revolute
    /// joint, and (q, 1) of a prismatic one. The dynamics does not read the 1.
    pub fn sin_cos<S: SineCosine>(self, q: &S) -> (S, S) {
        match self {
            Self::Revolute => q.sin_cos(),
            Self::Prismatic => (q.clone(), S::one()),
        }
    }
}

impl fmt::Display for JointKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Revolute => "revolute",
            Self::Prismatic => "prismatic",
        })
    }
}
