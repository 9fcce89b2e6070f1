use std::path::PathBuf;

use reachtube_finding::Finding;
use thiserror::Error;

/// Why no model could be made of the recordings.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum Error {
    /// Recordings could not be read or prepared, or a robot could not be identified.
    #[error(transparent)]
    Identify(Box<reachtube_identify::Error>),
    /// A conformance could not be decided.
    #[error(transparent)]
    Conform(Box<reachtube_conform::Error>),
    /// The robot's description is wrong.
    #[error(transparent)]
    Robot(Box<reachtube_robot::RobotError>),
    /// The expansion point does not fit the robot.
    #[error(transparent)]
    Abstraction(Box<reachtube_abstraction::Error>),
    /// A question about a robot's links has no answer.
    #[error(transparent)]
    Verify(Box<reachtube_verify::Error>),
    /// A plan cannot be followed as a model says.
    #[error(transparent)]
    Tracking(Box<reachtube_tracking::Error>),
    /// A file could not be read.
    #[error(transparent)]
    File(#[from] reachtube_files::Error),
    /// A file of choices is not what `model` writes.
    #[error("{}: {message}", path.display())]
    Settings {
        /// The file.
        path: PathBuf,
        /// The problem, with line and column.
        message: String,
    },
    /// A choice has a value that it cannot have.
    #[error("{key} = {value}; give {needed}")]
    Choice {
        /// The key in the settings.
        key: &'static str,
        /// The value.
        value: String,
        /// What it can be.
        needed: &'static str,
    },
    /// No recording shows a motion of several joints.
    #[error(
        "none of the {recordings} recordings shows a motion of several joints: {rest} at rest, \
         {one} of one joint at a time; give recordings in which all joints move"
    )]
    NoMotion {
        /// Number of recordings.
        recordings: usize,
        /// Number of recordings at rest.
        rest: usize,
        /// Number of recordings in which one joint moves.
        one: usize,
    },
    /// A recording that is to be held out does not exist.
    #[error(
        "--held-out \"{name}\" is no motion of the recordings; the motions are {}",
        motions.join(", ")
    )]
    HeldOut {
        /// The name.
        name: String,
        /// All motions.
        motions: Vec<String>,
    },
    /// Every motion is held out.
    #[error("--held-out names every motion; leave one at least for the sets")]
    NothingLeft,
    /// The recordings allow no sets at any horizon.
    #[error("no sets were found, even over {shortest} s: {reason}")]
    NoSets {
        /// The shortest horizon that was tried, s.
        shortest: f64,
        /// Why.
        reason: String,
    },
    /// Another error, most likely because the recordings contradict the robot's description.
    #[error("{cause}; {error}")]
    Because {
        /// What contradicts it.
        cause: String,
        /// The error.
        error: Box<Error>,
    },
    /// Too much of a recording is missing, wrong, or between gaps that are close.
    #[error(
        "{flaw}; so much is missing or wrong there that {lost:.1} s of {duration:.1} s cannot be \
         used: record again, or leave the log out"
    )]
    Lost {
        /// The first samples that are missing or wrong, and the number of others.
        flaw: String,
        /// The time that is lost, s.
        lost: f64,
        /// The duration of the recording, s.
        duration: f64,
    },
    /// No recording is as long as a window.
    #[error("no recording is as long as the horizon of {horizon} s; give a shorter one")]
    NoWindow {
        /// The horizon, s.
        horizon: f64,
    },
}

reachtube_files::kinds!(Error {
    [Identify | Conform | Robot | Abstraction | Verify | Tracking | File] => inner,
    Settings | Choice | HeldOut | NothingLeft => Setting,
    NoSets => NoAnswer,
    _ => Recordings,
});

/// A result of this crate.
pub(crate) type Result<T, E = Error> = std::result::Result<T, E>;

impl Error {
    /// Names the most likely cause of an error, if one is known.
    pub(crate) fn because(self, causes: &[Finding]) -> Self {
        let texts: Vec<&str> =
            causes.iter().map(|cause| cause.text.trim_end_matches('.')).collect();
        match &texts[..] {
            [] => self,
            texts => Self::Because { cause: texts.join("; "), error: Box::new(self) },
        }
    }
}

/// Lets `?` pass on the errors of a crate below, boxed because they are large.
macro_rules! from_below {
    ($($variant:ident: $error:ty),* $(,)?) => {
        $(impl From<$error> for Error {
            fn from(error: $error) -> Self {
                Self::$variant(Box::new(error))
            }
        })*
    };
}

from_below!(
    Identify: reachtube_identify::Error,
    Conform: reachtube_conform::Error,
    Robot: reachtube_robot::RobotError,
    Abstraction: reachtube_abstraction::Error,
    Verify: reachtube_verify::Error,
    Tracking: reachtube_tracking::Error,
);
