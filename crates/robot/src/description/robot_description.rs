//! The description of a robot.

use super::joint_description::{Convention, JointDescription};
use crate::joint_kind::JointKind;
use crate::lock::LockedJoint;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;

/// The version of the format that this crate writes, and the only one that it reads.
pub(crate) const SCHEMA_VERSION: u32 = 1;

/// The description of a robot in SI units (m, rad, kg, s, N, N m), with the structure of the TOML
/// format.
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
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RobotDescription {
    /// Version of the format: 1.
    pub schema_version: u32,
    /// The robot's name.
    pub name: String,
    /// Meaning of the inertial parameters.
    #[serde(default)]
    pub parameters: ParameterSet,
    /// Denavit-Hartenberg convention of the joints' `dh`.
    #[serde(default)]
    pub convention: Convention,
    /// Gravitational acceleration in the base frame \[m/s²\]; the default is 9.81 m/s² along -z.
    #[serde(default = "earth_gravity")]
    pub gravity: [f64; 3],
    /// Joints that are held at a position, whose links belong to the links that carry them.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub locked: Vec<LockedJoint>,
    /// SHA-256 of the recordings that parameters were identified from or fitted to, sorted; empty
    /// if they are unknown. Nothing is computed from them: a bound for motions that were held out
    /// does not hold for a robot that has seen them.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub identified_from: Vec<String>,
    /// The joints from base to tip, each with the link it moves.
    #[serde(rename = "joint")]
    pub joints: Vec<JointDescription>,
}

impl RobotDescription {
    /// Adds recordings, by their SHA-256, that parameters were identified from or fitted to.
    pub fn add_identified_from(&mut self, digests: impl IntoIterator<Item = String>) {
        let known = std::mem::take(&mut self.identified_from);
        let all: BTreeSet<String> = known.into_iter().chain(digests).collect();
        self.identified_from = all.into_iter().filter(|digest| !digest.is_empty()).collect();
    }

    /// Returns the kinds of the joints from base to tip.
    #[must_use]
    pub fn kinds(&self) -> Vec<JointKind> {
        self.joints.iter().map(|joint| joint.kind).collect()
    }
}

fn earth_gravity() -> [f64; 3] {
    [0.0, 0.0, -9.81]
}

/// The meaning of the inertial parameters of the links.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum ParameterSet {
    /// Each link is a body: its mass and inertia must belong to some distribution of mass.
    #[default]
    Physical,
    /// Only the base parameters (the combinations that torque depends on) have a meaning. The
    /// values of a single link have none and may even be negative.
    Base,
}
