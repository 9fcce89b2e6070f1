use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::error::Error;

/// One of the paper's three models (Sec. IV-B).
///
/// # Examples
///
/// ```
/// use reachtube_abstraction::ModelKind;
///
/// assert_eq!(ModelKind::try_from(2)?, ModelKind::Two);
/// assert!(ModelKind::try_from(4).is_err());
/// # Ok::<(), reachtube_abstraction::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(try_from = "u32", into = "u32")]
pub enum ModelKind {
    /// (13): constant mass matrix, viscous friction, no Coriolis terms.
    One,
    /// (14), (15): constant mass matrix, viscous friction, Coriolis terms in sin q and cos q.
    Two,
    /// (16): the Taylor polynomial of the forward dynamics in (q̇, sin q, cos q, u).
    Three,
}

impl From<ModelKind> for u32 {
    fn from(kind: ModelKind) -> u32 {
        kind as u32 + 1
    }
}

impl TryFrom<u32> for ModelKind {
    type Error = Error;

    fn try_from(number: u32) -> Result<Self, Error> {
        match number {
            1 => Ok(Self::One),
            2 => Ok(Self::Two),
            3 => Ok(Self::Three),
            _ => Err(Error::UnknownModel { number }),
        }
    }
}
