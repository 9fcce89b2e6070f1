use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use reachtube_finding::Remedy;

/// A remark that an answer is implausible, although the sets enclose the recordings.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Warning {
    /// The kind of remark.
    pub kind: WarningKind,
    /// The joints that it is about, from 1; none if it is about all.
    pub joints: Vec<usize>,
    /// The remark in words, without the remedy. Files of earlier versions name settings in it.
    pub text: String,
    /// A setting that helps.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub remedy: Option<Remedy>,
}

/// What a warning remarks.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum WarningKind {
    /// The reachable set is more than twice as wide as the recorded motion.
    ReachableSetSize,
    /// X0 is wider than the recorded motion.
    InitialSetSize,
    /// The positions of X0 reach much further than the recorded starts.
    InitialSetStarts,
    /// 0 lies outside X0 by more than the noise of the sensors.
    InitialSetOffset,
    /// U reaches beyond the recorded input.
    InputSetSize,
    /// U does not contain 0.
    InputSetOffset,
    /// U is 0 in a joint whose input has an error, and many times the error in another one.
    InputSetZero,
    /// V is nearly as wide as the recorded motion.
    NoiseSetSize,
    /// The nominal motion explains little of the recorded one.
    Unexplained,
    /// The recordings are faster than the recordings that friction was fitted to.
    FrictionRange,
    /// Viscous friction falls with speed.
    FallingFriction,
    /// What most likely caused the other warnings.
    Cause,
    /// The fitted nominal model needs larger sets than the identified one for motions that it was
    /// not fitted to.
    Overfitted,
}

impl WarningKind {
    /// All kinds that are about single joints, in the order of the warnings.
    pub(crate) const OF_JOINTS: [Self; 11] = [
        Self::ReachableSetSize,
        Self::InitialSetSize,
        Self::InitialSetStarts,
        Self::InitialSetOffset,
        Self::InputSetSize,
        Self::InputSetOffset,
        Self::InputSetZero,
        Self::NoiseSetSize,
        Self::Unexplained,
        Self::FrictionRange,
        Self::FallingFriction,
    ];

    /// Returns whether the warning needs a cause. X0 covers what U covers otherwise if that is
    /// cheaper, whatever the recordings are, and friction is a cause of its own.
    pub(crate) fn has_cause(self) -> bool {
        !matches!(self, Self::InitialSetStarts | Self::FrictionRange | Self::FallingFriction)
    }
}

/// What is remarked of one joint.
#[derive(Debug, Clone, PartialEq)]
pub struct Remark {
    /// The kind of remark.
    pub kind: WarningKind,
    /// The joint, from 1.
    pub joint: usize,
    /// The state or joint with its sizes.
    pub text: String,
}
