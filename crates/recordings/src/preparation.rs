use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::reading::{ColumnSettings, LogSettings};
use crate::torque::Torque;

/// Preparation of logs as the recordings of a model: what was done to them before its sets were
/// found, and what has to be done to other logs before they are compared with it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Preparation {
    /// The kind of the torques of the logs. Gravity and dry friction of the model's robot are
    /// subtracted from them, unless they are compensated already.
    pub torque: Torque,
    /// Factors of the torques, one per joint; none if they count as recorded.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub gains: Vec<f64>,
    /// Cut-off frequency of the low-pass, Hz; none if nothing is filtered.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub cut_off: Option<f64>,
    /// Length of the windows into which logs are cut, s; none if recordings count from their start,
    /// and all recordings of one motion are a suite.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub window: Option<f64>,
    /// Whether velocities are the differentiated positions, as in most of the model's recordings.
    #[serde(default, skip_serializing_if = "is_default")]
    pub differentiated: bool,
    /// Columns of CSV files, if their names are ambiguous.
    #[serde(default, skip_serializing_if = "is_default")]
    pub columns: ColumnSettings,
    /// Topics, joints and times of MCAP and rosbag2 logs, if the logs are ambiguous.
    #[serde(default, skip_serializing_if = "is_default")]
    pub log: LogSettings,
}

fn is_default<T: Default + PartialEq>(settings: &T) -> bool {
    *settings == T::default()
}
