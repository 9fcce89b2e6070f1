//! Robot logs as recordings: joint states from MCAP and rosbag2 files, cut into runs.
//!
//! - [`Log::read`] reads `sensor_msgs/msg/JointState` from the topics of a log. Joints are matched
//!   by name, and times are the stamps of the headers.
//! - [`Cutting`] and [`Intervals`] cut logs into runs, and
//!   [`find_repeats`] groups runs that repeat one motion into test suites.
//! - [`read_commands`] reads commanded and actual positions, as text with columns.
//! - [`convert`] checks the runs. [`Recorded::write`] writes them as a data set in the format of
//!   `docs/recordings.md`; [`Recorded::into_runs`] returns them as a source of recordings.
//!
//! The feature `mcap` reads MCAP files and `rosbag` reads .db3 files. Without a feature, files of
//! its format are refused. `docs/logs.md` describes what is read and what is refused.

mod align;
#[cfg(feature = "rosbag")]
mod bag_file;
#[cfg(feature = "rosbag")]
mod bag_state;
mod cdr;
mod commands;
#[cfg(any(feature = "mcap", feature = "rosbag"))]
mod compressed;
mod container;
mod cut;
mod error;
mod files;
mod found;
mod inspect;
mod intervals;
mod log;
mod log_notes;
mod loss;
#[cfg(feature = "mcap")]
mod mcap_file;
#[cfg(feature = "mcap")]
mod mcap_records;
mod merge;
mod message;
mod named_series;
mod recorded;
mod repeats;
mod sample;
mod seconds;
mod series;

pub use commands::{Commands, read_commands};
pub use cut::{Cut, Cutting};
pub use error::Error;
pub use found::LogFiles;
pub use inspect::{LogInspection, inspect_logs};
pub use intervals::Intervals;
pub use log::{Log, LogOptions};
pub use loss::Loss;
pub use reachtube_recordings::LogTime;
pub use recorded::{Recorded, RecordedRun, convert};
pub use repeats::{Repeats, find_repeats};
