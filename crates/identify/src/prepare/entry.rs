use crate::prepare::raw_log::RawLog;
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Recordings named in settings: a log or a folder of logs, whole or an interval of time.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum LogEntry {
    /// A log, or a folder with all its logs except runs.csv, in the order of their names; if it has
    /// none, the recordings of its subfolders. A log is a CSV file, an MCAP file, a .db3 file, or
    /// the folder of a bag.
    Path(PathBuf),
    /// An interval of time of each of these files.
    Stretch {
        /// The file or folder.
        path: PathBuf,
        /// First time that is used \[s\].
        #[serde(default)]
        from: f64,
        /// Last time that is used \[s\].
        #[serde(default)]
        until: Option<f64>,
        /// Number of the recording since the robot's start, from 1. Further files of a folder
        /// follow in the order of their names.
        #[serde(default)]
        order: Option<u64>,
        /// Whether `tau` is the input u, to which the robot's controllers add gravity and Coulomb
        /// friction of the description.
        #[serde(default)]
        compensated: bool,
    },
    /// A recording that was read already.
    #[serde(skip)]
    Recording(Arc<RawLog>),
}

impl LogEntry {
    pub(super) fn parts(&self) -> (&Path, f64, Option<f64>) {
        match self {
            Self::Path(path) => (path, 0.0, None),
            Self::Recording(log) => (&log.file, 0.0, None),
            Self::Stretch { path, from, until, .. } => (path, *from, *until),
        }
    }

    pub(crate) fn is_compensated(&self) -> bool {
        matches!(self, Self::Stretch { compensated: true, .. })
    }

    /// Returns the number of its first recording since the robot's start, from 1.
    pub(super) fn order(&self) -> Option<u64> {
        match self {
            Self::Path(_) => None,
            Self::Recording(log) => log.order,
            Self::Stretch { order, .. } => *order,
        }
    }
}

impl From<PathBuf> for LogEntry {
    fn from(path: PathBuf) -> Self {
        Self::Path(path)
    }
}
