use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Kinds of statements about motions that were not recorded.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum TrustKind {
    /// It holds for all distributions of motions that satisfy the assumption of its basis.
    Guarantee,
    /// The formula of a guarantee where a condition of its theorem is not met. It bounds nothing.
    Indication,
    /// It describes the recordings at hand. It bounds nothing.
    Description,
}
