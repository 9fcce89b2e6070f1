use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Which times the samples of a log have.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub enum LogTime {
    /// The stamps in the headers of the messages.
    #[default]
    #[serde(rename = "header")]
    Header,
    /// The times at which the log received the messages.
    #[serde(rename = "log")]
    Receipt,
}

/// Topics, joints and times of MCAP and rosbag2 logs, if the logs are ambiguous: the table `log` of
/// the settings.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct LogSettings {
    /// Topics with joint states; empty for the only one that names joints of the robot.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub topic: Vec<String>,
    /// Names of the joints in the log, in the robot's order; empty for the robot's names.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub joints: Vec<String>,
    /// Topic that marks runs. Without it, each log is one recording.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub marker: Option<String>,
    /// Which times the samples have.
    #[serde(skip_serializing_if = "is_default")]
    pub time: LogTime,
}

fn is_default(time: &LogTime) -> bool {
    *time == LogTime::default()
}
