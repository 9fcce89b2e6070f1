//! Joints that are held at a position.

use crate::error::RobotError;
use crate::joint_kind::JointKind;
use core::fmt;
use core::str::FromStr;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A request to hold a joint at a position. Its link then belongs to the link that carries it.
///
/// # Examples
///
/// ```
/// use reachtube_robot::Lock;
///
/// let lock: Lock = "finger_joint1=0.02".parse()?;
/// assert_eq!((lock.joint.as_str(), lock.position), ("finger_joint1", 0.02));
/// assert_eq!(lock.to_string(), "finger_joint1=0.02");
/// # Ok::<(), reachtube_robot::RobotError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Lock {
    /// Name of the joint.
    pub joint: String,
    /// Position \[rad; m for a prismatic joint\].
    pub position: f64,
}

/// A joint that is held at a position, as a description records it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LockedJoint {
    /// Name of the joint.
    pub name: String,
    /// Kind of the joint.
    #[serde(default, rename = "type", skip_serializing_if = "JointKind::is_revolute")]
    pub kind: JointKind,
    /// Position \[rad; m for a prismatic joint\].
    pub position: f64,
}

impl FromStr for Lock {
    type Err = RobotError;

    fn from_str(text: &str) -> Result<Self, RobotError> {
        let parts =
            text.rsplit_once('=').map(|(joint, value)| (joint.trim(), value.trim().parse()));
        match parts {
            Some((joint, Ok(position))) if !joint.is_empty() && f64::is_finite(position) => {
                Ok(Self { joint: joint.into(), position })
            }
            _ => Err(RobotError::NotALock { text: text.into() }),
        }
    }
}

impl fmt::Display for Lock {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}={}", self.joint, self.position)
    }
}
