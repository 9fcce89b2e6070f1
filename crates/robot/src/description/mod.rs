//! A robot as users write it: the TOML format, also embedded as JSON in model files.

mod check;
mod read;

pub(crate) use check::Finding;

use serde::{Deserialize, Serialize};

/// The version of the format that this crate writes, and the only one it reads.
pub const SCHEMA_VERSION: u32 = 1;

/// A robot in SI units (m, rad, kg, s, N m), as in a TOML file.
///
/// # Examples
///
/// ```
/// use reachtube_robot::{Robot, RobotDescription};
///
/// let pendulum = r#"
///     schema_version = 1
///     name = "pendulum"
///
///     [[joint]]
///     name = "hinge"
///     placement = { translation = [0.0, 0.0, 1.0] }
///     axis = [1.0, 0.0, 0.0]
///     mass = 2.0
///     com = [0.0, 0.0, -0.5]
/// "#;
/// let robot = Robot::from_toml(pendulum, "pendulum.toml").unwrap();
/// assert!((robot.mass_matrix(&[0.3])[(0, 0)] - 0.5).abs() < 1e-15);
/// ```
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RobotDescription {
    /// Version of the format: [`SCHEMA_VERSION`].
    pub schema_version: u32,
    /// The robot's name.
    pub name: String,
    /// What the inertial parameters claim.
    #[serde(default)]
    pub parameters: Parameters,
    /// Which Denavit-Hartenberg convention the joints' `dh` follows.
    #[serde(default)]
    pub convention: Convention,
    /// Gravitational acceleration in the base frame \[m/s²\]; 9.81 along -z when left out.
    #[serde(default = "earth_gravity")]
    pub gravity: [f64; 3],
    /// The joints from base to tip, each with the link it moves.
    #[serde(rename = "joint")]
    pub joints: Vec<JointDescription>,
}

fn earth_gravity() -> [f64; 3] {
    [0.0, 0.0, -9.81]
}

/// What the inertial parameters of the links claim.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Parameters {
    /// Each link is a body: mass and inertia are checked to be those of some distribution of mass.
    #[default]
    Physical,
    /// Only the combinations that motion shows are meant; single links may even have negative
    /// inertia.
    Base,
}

/// Denavit-Hartenberg convention.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Convention {
    /// Rz(q + theta) Tz(d) Tx(a) Rx(alpha).
    #[default]
    Standard,
    /// Craig: Rx(alpha) Tx(a) Rz(q + theta) Tz(d).
    Modified,
}

/// Denavit-Hartenberg parameters; angles within 1e-12 of a multiple of pi/2 are taken as exactly
/// that.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Dh {
    /// Link length \[m\].
    pub a: f64,
    /// Link twist \[rad\].
    pub alpha: f64,
    /// Joint offset added to q \[rad\].
    pub theta: f64,
    /// Link offset \[m\].
    pub d: f64,
}

/// Placement of a joint frame in the frame of the link before; left-out parts are the identity.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PlacementDescription {
    /// Rotation matrix, row by row; child to parent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rotation: Option<[[f64; 3]; 3]>,
    /// Roll, pitch, yaw \[rad\]: Rz(yaw) Ry(pitch) Rx(roll), as in URDF.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rpy: Option<[f64; 3]>,
    /// Translation \[m\].
    #[serde(default)]
    pub translation: [f64; 3],
}

/// The point that an inertia tensor is about.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum InertiaPoint {
    /// The link's centre of mass.
    #[default]
    Com,
    /// The origin of the link's frame.
    Origin,
}

/// Mass moments that act in gravity alone, where they were identified apart from the inertial ones.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GravityMoments {
    /// Mass \[kg\].
    pub mass: f64,
    /// Mass times centre of mass in the link's frame \[kg m\].
    pub first_moment: [f64; 3],
}

/// Friction coefficients of a joint, eqs. (5) to (9).
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FrictionDescription {
    /// a1 to a8: offset \[N m\] and slope of driving forward, driving backward, braking backward,
    /// braking forward.
    #[serde(default)]
    pub coulomb: [f64; 8],
    /// v1 \[N m s/rad\], v2 \[N m s²/rad²\], v3 \[N m s³/rad³\].
    #[serde(default)]
    pub viscous: [f64; 3],
}

/// A joint and the link that it moves.
///
/// The link's frame is the joint frame turned by q (`placement`), or the Denavit-Hartenberg frame
/// of the link (`dh`).
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct JointDescription {
    /// The joint's name, unique in the robot.
    pub name: String,
    /// Geometry by Denavit-Hartenberg parameters; or `placement` and `axis`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub dh: Option<Dh>,
    /// Geometry by the placement of the joint frame in the link before.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub placement: Option<PlacementDescription>,
    /// Axis in the joint frame, any length but zero; z when left out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub axis: Option<[f64; 3]>,
    /// Mass of the link \[kg\].
    #[serde(default)]
    pub mass: f64,
    /// Centre of mass in the link's frame \[m\].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub com: Option<[f64; 3]>,
    /// Mass times centre of mass \[kg m\], in place of `com`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub first_moment: Option<[f64; 3]>,
    /// Inertia tensor ixx, ixy, ixz, iyy, iyz, izz in the link's axes \[kg m²\].
    #[serde(default)]
    pub inertia: [f64; 6],
    /// The point that `inertia` is about.
    #[serde(default)]
    pub about: InertiaPoint,
    /// Mass moments used for gravity in place of `mass` and `com`; all joints or none have them.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub gravity_moments: Option<GravityMoments>,
    /// Gear ratio k_r (dimensionless).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub gear_ratio: Option<f64>,
    /// Rotor inertia I_m on the motor's side \[kg m²\]; the armature is k_r² I_m.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rotor_inertia: Option<f64>,
    /// Motor inertia on the link's side \[kg m²\], in place of `rotor_inertia`; 0 when neither is
    /// given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub armature: Option<f64>,
    /// Lowest and highest position \[rad\]; ±pi when left out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub position_limits: Option<[f64; 2]>,
    /// Highest speed \[rad/s\].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub velocity_limit: Option<f64>,
    /// Friction; none when left out.
    #[serde(default)]
    pub friction: FrictionDescription,
}
