use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::model_kind::ModelKind;

/// The choice of an abstraction of the forward dynamics: model and order.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Abstraction {
    /// Model 1, 2 or 3 of the paper.
    pub model: ModelKind,
    /// The order p ≥ 1.
    pub order: u32,
}

impl Default for Abstraction {
    /// Returns model 1 of order 1, which is linear.
    fn default() -> Self {
        Self { model: ModelKind::One, order: 1 }
    }
}
