use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A side of a set along a state axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Side {
    /// The side of the highest values.
    Upper,
    /// The side of the lowest values.
    Lower,
}

impl Side {
    /// Both sides, the upper one first.
    pub(crate) const BOTH: [Self; 2] = [Self::Upper, Self::Lower];

    pub(crate) fn sign(self) -> f64 {
        match self {
            Self::Upper => 1.0,
            Self::Lower => -1.0,
        }
    }
}
