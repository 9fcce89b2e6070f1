//! Logs that commands read, and the options about them.

use std::path::Path;

use clap::Args;
use reachtube::recordings::{ColumnSettings, LogSettings, LogTime};
use reachtube_logs::{Log, LogOptions};

use crate::error::Result;
use crate::option_values::{Choices, explained};
use crate::output;

/// Which times samples of logs have.
pub(crate) const TIMES: Choices =
    &[("header", "stamps in the messages"), ("log", "times of receipt")];

// Options about logs with ambiguous names or topics.
#[derive(Debug, Args)]
pub(crate) struct LogArguments {
    /// Columns of CSV files whose names do not tell, such as q=pos_{},qd=vel_{},tau=m_{},time=t_1;
    /// also rate=100 (Hz) for logs without a time, first=0, time_unit=ms and angle=deg
    #[arg(long, hide_short_help = true, value_name = "KEY=VALUE,..")]
    pub columns: Option<ColumnSettings>,
    /// Topics with joint states in MCAP and rosbag2, which complement each other; without torques,
    /// the actual and then the commanded positions [default: the only one that names joints of the
    /// robot]
    #[arg(long, hide_short_help = true, value_name = "NAME", num_args = 1..)]
    pub topic: Vec<String>,
    /// Names of the joints in MCAP and rosbag2, in the robot's order; without a robot, the joints
    /// that are read of any log [default: the robot's names, or all]
    #[arg(long, hide_short_help = true, value_name = "NAME,..", value_delimiter = ',')]
    pub joints: Vec<String>,
    /// Topic that marks runs while it is not empty, true or not 0 [default: each log is one
    /// recording]
    #[arg(long, hide_short_help = true, value_name = "NAME")]
    pub marker: Option<String>,
    /// Times of the samples in MCAP and rosbag2 [default: header]
    #[arg(long, hide_short_help = true, value_name = "TIMES", value_parser = explained(TIMES))]
    pub time: Option<String>,
}

impl LogArguments {
    pub(crate) fn settings(&self) -> LogSettings {
        LogSettings {
            topic: self.topic.clone(),
            joints: self.joints.clone(),
            marker: self.marker.clone(),
            time: log_time(self.time.as_deref()),
        }
    }
}

pub(crate) fn log_time(name: Option<&str>) -> LogTime {
    if name == Some("log") { LogTime::Receipt } else { LogTime::Header }
}

/// Reads a log, prints its notes, and warns of what is lost.
pub(crate) fn read_log(path: &Path, options: &LogOptions) -> Result<Log> {
    let log = Log::read(path, options)?;
    output::notes(log.notes());
    output::warnings(&log.losses().iter().map(ToString::to_string).collect::<Vec<_>>());
    if !log.losses().is_empty() {
        output::warn(&format!("{}: {} samples are kept", path.display(), log.len()));
    }
    Ok(log)
}
