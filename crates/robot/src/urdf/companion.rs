//! The companion of a URDF: a TOML file for the values that URDF cannot express.

use crate::description::joint_description::{FrictionDescription, JointDescription};
use crate::description::robot_description::{ParameterSet, RobotDescription};
use crate::error::RobotError;
use crate::lock::Lock;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Ends of the chain, locked joints, gravity, and motors and friction of joints. Each value
/// overrides the URDF's value.
#[derive(Clone, Debug, Default, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Companion {
    #[serde(skip)]
    origin: String,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub base: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub tip: Option<String>,
    /// Positions of locked joints \[rad; m\] by name.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    lock: BTreeMap<String, f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    gravity: Option<[f64; 3]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    parameters: Option<ParameterSet>,
    /// SHA-256 of the recordings that values were identified from.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    identified_from: Vec<String>,
    #[serde(rename = "joint", default)]
    joints: Vec<Drive>,
}

/// Motor and friction of one joint.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
struct Drive {
    name: String,
    #[serde(skip_serializing_if = "Option::is_none")]
    gear_ratio: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    rotor_inertia: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    armature: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    friction: Option<FrictionDescription>,
}

impl Companion {
    /// Reads a companion. A text with a `schema_version` describes a robot of its own, for which
    /// the result is empty.
    pub(super) fn parse(text: &str, origin: &str) -> Result<Self, RobotError> {
        let syntax = |e: toml::de::Error| RobotError::Syntax {
            origin: origin.into(),
            message: e.to_string(),
        };
        let table: toml::Table = toml::from_str(text).map_err(syntax)?;
        if table.contains_key("schema_version") {
            return Ok(Self::default());
        }
        let companion: Self = toml::from_str(text).map_err(syntax)?;
        Ok(Self { origin: origin.into(), ..companion })
    }

    /// Returns the locks of the companion and `given`, which override them.
    pub(super) fn locks(&self, given: &[Lock]) -> Vec<Lock> {
        let own = self.lock.iter().filter(|(name, _)| given.iter().all(|l| l.joint != **name));
        let own = own.map(|(name, &position)| Lock { joint: name.clone(), position });
        own.chain(given.iter().cloned()).collect()
    }

    /// Writes the values into a description.
    pub(super) fn apply(&self, description: &mut RobotDescription) -> Result<(), RobotError> {
        description.gravity = self.gravity.unwrap_or(description.gravity);
        description.parameters = self.parameters.unwrap_or(description.parameters);
        description.add_identified_from(self.identified_from.iter().cloned());
        let names: Vec<_> = description.joints.iter().map(|j| format!("`{}`", j.name)).collect();
        for drive in &self.joints {
            let joint = description.joints.iter_mut().find(|j| j.name == drive.name);
            let joint = joint.ok_or_else(|| RobotError::Invalid {
                origin: self.origin.clone(),
                place: format!("joint `{}`: ", drive.name),
                problem: "the chain has no joint with this name".into(),
                remedy: format!("name one of {}", names.join(", ")),
            })?;
            drive.apply(joint);
        }
        Ok(())
    }

    /// Makes the companion with the motors and friction of a description.
    pub(super) fn from_description(
        description: &RobotDescription,
        base: Option<String>,
        tip: Option<String>,
        locks: &[Lock],
    ) -> Self {
        let drive = |j: &JointDescription| Drive {
            name: j.name.clone(),
            gear_ratio: j.gear_ratio,
            rotor_inertia: j.rotor_inertia,
            armature: j.armature,
            friction: Some(j.friction),
        };
        Self {
            origin: String::new(),
            base,
            tip,
            lock: locks.iter().map(|lock| (lock.joint.clone(), lock.position)).collect(),
            gravity: Some(description.gravity),
            parameters: Some(description.parameters),
            identified_from: description.identified_from.clone(),
            joints: description.joints.iter().map(drive).collect(),
        }
    }
}

impl Drive {
    /// Writes the values into a joint. An armature replaces a rotor inertia and the reverse.
    fn apply(&self, joint: &mut JointDescription) {
        joint.gear_ratio = self.gear_ratio.or(joint.gear_ratio);
        if self.armature.is_some() || self.rotor_inertia.is_some() {
            (joint.armature, joint.rotor_inertia) = (self.armature, self.rotor_inertia);
        }
        joint.friction = self.friction.unwrap_or(joint.friction);
    }
}
