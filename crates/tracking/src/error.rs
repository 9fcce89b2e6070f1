use std::path::PathBuf;

use reachtube_scalar::number::{counted, significant};
use thiserror::Error;

/// Why no model could be made of commanded and actual positions, or compared with others.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum Error {
    /// Recordings could not be read.
    #[error(transparent)]
    Recordings(Box<reachtube_recordings::Error>),
    /// A file could not be read.
    #[error(transparent)]
    File(#[from] reachtube_files::Error),
    /// No path is given.
    #[error("no recordings are given; name some with --data")]
    NoData,
    /// A folder has no log.
    #[error("{}: the folder has no log; give logs or folders of logs", folder.display())]
    NoLog {
        /// The folder.
        folder: PathBuf,
    },
    /// An MCAP or rosbag2 log could not be read.
    #[error(transparent)]
    Log(Box<reachtube_logs::Error>),
    /// The recordings are of different joints.
    #[error(
        "{}: it has the joints {}, but {} has {}; give recordings of one arm",
        file.display(), joints.join(", "), other.display(), others.join(", ")
    )]
    Joints {
        /// The recording.
        file: PathBuf,
        /// Its joints.
        joints: Vec<String>,
        /// The first recording.
        other: PathBuf,
        /// The joints of that.
        others: Vec<String>,
    },
    /// A recording or a robot has other joints than the model.
    #[error(
        "{}: it has the joints {}, but the model has {}; give a recording or a robot of the \
         model's arm, or make the model with `--robot`, of this robot",
        file.display(), joints.join(", "), of_model.join(", ")
    )]
    OtherJoints {
        /// The recording, or the robot.
        file: PathBuf,
        /// Its joints.
        joints: Vec<String>,
        /// The joints of the model.
        of_model: Vec<String>,
    },
    /// A recording has too few samples.
    #[error("{}: it has {samples} samples; a motion needs 3 at least", file.display())]
    Short {
        /// The recording.
        file: PathBuf,
        /// The number of its samples.
        samples: usize,
    },
    /// Nothing moves.
    #[error("no commanded position changes in any recording; give recordings of motions")]
    NoMotion,
    /// The actual positions are commands of earlier samples.
    #[error(
        "{}: in {copied} samples, the actual positions are the commanded ones of {} before, \
         exactly: they are no measurement; log what the encoders measure",
        file.display(), counted(*before, "sample")
    )]
    NoMeasurement {
        /// The recording.
        file: PathBuf,
        /// How many samples before.
        before: usize,
        /// In how many samples.
        copied: usize,
    },
    /// A plan is faster than what the model was made of.
    #[error(
        "{}: the command of {joint} reaches {} {unit} at {time:.3} s, but the model was made of \
         commands up to {} {unit}; {}make the model of recordings that are as fast",
        file.display(), significant(*value, 3), significant(*largest, 3), slower(*part)
    )]
    Beyond {
        /// The plan.
        file: PathBuf,
        /// The joint.
        joint: String,
        /// The unit of its speed, or of its acceleration.
        unit: String,
        /// What it reaches.
        value: f64,
        /// The largest of the recordings.
        largest: f64,
        /// The time, s.
        time: f64,
        /// The part of its speed at which the model holds for the plan.
        part: f64,
    },
    /// The smallest sets were not found.
    #[error("the smallest sets were not found: {0}")]
    Program(String),
}

reachtube_files::kinds!(Error {
    [Recordings | File | Log] => inner,
    NoData | OtherJoints => Setting,
    Program => NoAnswer,
    _ => Recordings,
});

/// A result of this crate.
pub type Result<T, E = Error> = std::result::Result<T, E>;

impl From<reachtube_logs::Error> for Error {
    fn from(error: reachtube_logs::Error) -> Self {
        Self::Log(Box::new(error))
    }
}

impl From<reachtube_recordings::Error> for Error {
    fn from(error: reachtube_recordings::Error) -> Self {
        Self::Recordings(Box::new(error))
    }
}

/// Returns the remedy of a plan that the model holds for at a part of its speed.
fn slower(part: f64) -> String {
    match (100.0 * part).floor() {
        0.0 => String::new(),
        percent => format!("send the plan at {percent} % of its speed, or "),
    }
}
