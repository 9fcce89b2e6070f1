use reachtube_recordings::Run;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// What the drive of a system may depend on in one run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Condition {
    /// The run's place in the order of its suite, from 1.
    pub place: u64,
    /// The mean temperature of each part, n, °C, if it was recorded.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub temperatures: Option<Vec<f64>>,
}

impl Condition {
    pub(crate) fn of(place: u64, run: &Run) -> Self {
        Self { place, temperatures: run.mean_temperature() }
    }

    pub(crate) fn first() -> Self {
        Self { place: 1, temperatures: None }
    }
}
