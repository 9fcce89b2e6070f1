use std::path::PathBuf;

use thiserror::Error;

use crate::loss::Loss;

/// Why a log cannot be used.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum Error {
    /// A file could not be read or written.
    #[error(transparent)]
    File(#[from] reachtube_files::Error),
    /// Recordings in the log have defects, all of which are listed.
    #[error(transparent)]
    Recordings(#[from] reachtube_recordings::Error),
    /// The file is in no format that is read.
    #[error("{}: {problem}", path.display())]
    Format {
        /// The file.
        path: PathBuf,
        /// The problem and the remedy.
        problem: String,
    },
    /// A part of the file cannot be read.
    #[error(
        "{}; reachtube convert --recover keeps what is whole and prints what is lost",
        .0.place()
    )]
    Damaged(Loss),
    /// The log has no topic of this name.
    #[error("{}: there is no topic {topic}; {}", path.display(), match &available[..] {
        [] => "the log has no topics".into(),
        some => format!("give one of {}", some.join(", ")),
    })]
    NoTopic {
        /// The file or folder.
        path: PathBuf,
        /// The requested name.
        topic: String,
        /// Topics of the log, with their types.
        available: Vec<String>,
    },
    /// A topic has messages of another type than its role needs.
    #[error(
        "{}: topic {topic} has messages of type {found}, but {expected} in the encoding cdr is \
         needed; name another topic",
        path.display()
    )]
    TopicType {
        /// The file.
        path: PathBuf,
        /// The topic.
        topic: String,
        /// Type and encoding of its messages.
        found: String,
        /// The types that are read.
        expected: &'static str,
    },
    /// The log has no topic of joint states.
    #[error(
        "{}: no topic has sensor_msgs/msg/JointState in the encoding cdr; {}",
        path.display(),
        match &available[..] {
            [] => "the log has no topics".into(),
            some => format!("the topics are {}", some.join(", ")),
        }
    )]
    NoJointStates {
        /// The file or folder.
        path: PathBuf,
        /// Topics of the log, with their types.
        available: Vec<String>,
    },
    /// Several topics name joints of the robot, and none was chosen.
    #[error(
        "{}: {} topics name joints of the robot: {}; choose one with --topic, or several that \
         complement each other",
        path.display(),
        topics.len(),
        topics.join(", ")
    )]
    SeveralTopics {
        /// The file or folder.
        path: PathBuf,
        /// The topics.
        topics: Vec<String>,
    },
    /// No topics have commanded and actual positions.
    #[error(
        "{}: {problem}; commanded and actual positions are in one topic of \
         control_msgs/msg/JointTrajectoryControllerState, or in two of \
         sensor_msgs/msg/JointState: name them with --topic STATE COMMAND; {}",
        path.display(),
        match &available[..] {
            [] => "the log has no topics".into(),
            some => format!("the topics are {}", some.join(", ")),
        }
    )]
    NoCommands {
        /// The file or folder.
        path: PathBuf,
        /// What is missing.
        problem: String,
        /// Topics of the log, with their types.
        available: Vec<String>,
    },
    /// A topic of joint states has no message.
    #[error("{}: topic {topic} has no message; record it, or name another topic", path.display())]
    NoMessages {
        /// The file or folder.
        path: PathBuf,
        /// The topic.
        topic: String,
    },
    /// All stamps of a topic are 0.
    #[error(
        "{}: all stamps in the headers of {topic} are 0, so they are no times; --time log takes \
         the times at which the log received the messages",
        path.display()
    )]
    ZeroStamps {
        /// The file or folder.
        path: PathBuf,
        /// The topic.
        topic: String,
    },
    /// Options contradict each other, or an option and the log do.
    #[error("{0}")]
    Setting(String),
    /// A list of intervals has a wrong line.
    #[error("{}:{line}: {problem}", path.display())]
    Intervals {
        /// The list.
        path: PathBuf,
        /// Line in it, from 1.
        line: u64,
        /// The problem and the remedy.
        problem: String,
    },
    /// No run was found.
    #[error("no run is found: {0}")]
    NoRun(String),
}

reachtube_files::kinds!(Error {
    [File | Recordings] => inner,
    Format | Damaged => File,
    NoTopic | NoCommands | SeveralTopics | TopicType | Setting | Intervals => Setting,
    _ => Recordings,
});

/// A result of this crate.
pub(crate) type Result<T, E = Error> = std::result::Result<T, E>;
