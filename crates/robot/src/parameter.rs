//! The parameters that torque is linear in: inertial parameters, motor inertia, friction and
//! torque offset of each joint.

use crate::inertia::INERTIAL;
use core::fmt;
use serde::{Deserialize, Serialize};

/// One parameter that torque is linear in. It has one column in a regressor.
///
/// # Examples
///
/// ```
/// use reachtube_robot::{Parameter, ParameterKind};
///
/// assert_eq!(Parameter { joint: 2, kind: ParameterKind::Ixx }.to_string(), "Ixx3");
/// assert_eq!(Parameter { joint: 1, kind: ParameterKind::Viscous1 }.to_string(), "v1_2");
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct Parameter {
    /// Index of the joint, from 0; names count from 1.
    pub joint: usize,
    /// Kind of the parameter.
    pub kind: ParameterKind,
}

/// The kinds of parameter that a joint with its link has. Motor inertia, friction and offset of a
/// prismatic joint have kg, N, m and s in their units in place of kg m², N m, rad and s.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
pub enum ParameterKind {
    /// Mass m \[kg\].
    Mass,
    /// First moment m c_x \[kg m\] in the link's frame.
    MomentX,
    /// First moment m c_y \[kg m\].
    MomentY,
    /// First moment m c_z \[kg m\].
    MomentZ,
    /// Moment of inertia about the link's origin \[kg m²\].
    Ixx,
    /// Entry xy of the inertia tensor about the link's origin \[kg m²\] (minus the product of
    /// inertia ∫ x y dm).
    Ixy,
    /// Moment of inertia about the link's origin \[kg m²\].
    Iyy,
    /// Entry xz of the inertia tensor about the link's origin \[kg m²\].
    Ixz,
    /// Entry yz of the inertia tensor about the link's origin \[kg m²\].
    Iyz,
    /// Moment of inertia about the link's origin \[kg m²\].
    Izz,
    /// Motor inertia on the link side J = k_r² I_m \[kg m²; kg for a prismatic joint\]; its
    /// regressor entry is q̈.
    MotorInertia,
    /// Viscous friction v1 \[N m s/rad\]; its regressor entry is q̇.
    Viscous1,
    /// Viscous friction v2 \[N m s²/rad²\]; its regressor entry is q̇².
    Viscous2,
    /// Viscous friction v3 \[N m s³/rad³\]; its regressor entry is q̇³.
    Viscous3,
    /// Coulomb friction of one magnitude \[N m\]; its regressor entry is sign(q̇), 0 at rest.
    Coulomb,
    /// Constant torque \[N m\], such as the zero offset of a sensor; its regressor entry is 1.
    Offset,
}

impl ParameterKind {
    /// The ten inertial parameters in the order of
    /// [`Robot::inertial_regressor`](crate::Robot::inertial_regressor).
    pub const INERTIAL: [Self; INERTIAL] = [
        Self::Mass,
        Self::MomentX,
        Self::MomentY,
        Self::MomentZ,
        Self::Ixx,
        Self::Ixy,
        Self::Iyy,
        Self::Ixz,
        Self::Iyz,
        Self::Izz,
    ];

    /// Returns the part of the name before the joint's number: `m`, `mx`, `Ixx`, `J`, `v1_`, `fc`,
    /// `o`.
    pub(crate) fn symbol(self) -> &'static str {
        match self {
            Self::Mass => "m",
            Self::MomentX => "mx",
            Self::MomentY => "my",
            Self::MomentZ => "mz",
            Self::Ixx => "Ixx",
            Self::Ixy => "Ixy",
            Self::Iyy => "Iyy",
            Self::Ixz => "Ixz",
            Self::Iyz => "Iyz",
            Self::Izz => "Izz",
            Self::MotorInertia => "J",
            Self::Viscous1 => "v1_",
            Self::Viscous2 => "v2_",
            Self::Viscous3 => "v3_",
            Self::Coulomb => "fc",
            Self::Offset => "o",
        }
    }

    /// Returns whether this is one of the ten inertial parameters.
    pub fn is_inertial(self) -> bool {
        (self as usize) < INERTIAL
    }

    /// Returns the only entry of a drive parameter in the regressor, which is in the joint's own
    /// row; 0 for an inertial parameter.
    pub(crate) fn drive_entry(self, qd: f64, qdd: f64) -> f64 {
        match self {
            Self::MotorInertia => qdd,
            Self::Viscous1 => qd,
            Self::Viscous2 => qd * qd,
            Self::Viscous3 => qd * qd * qd,
            Self::Coulomb if qd == 0.0 => 0.0,
            Self::Coulomb => qd.signum(),
            Self::Offset => 1.0,
            _ => 0.0,
        }
    }
}

impl Parameter {
    /// Returns the parameters of the given kinds for n joints, joint by joint.
    pub fn of_joints(n: usize, kinds: &[ParameterKind]) -> Vec<Self> {
        (0..n).flat_map(|joint| kinds.iter().map(move |&kind| Self { joint, kind })).collect()
    }
}

impl fmt::Display for Parameter {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}{}", self.kind.symbol(), self.joint + 1)
    }
}
