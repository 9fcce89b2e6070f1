//! Errors of the command line.

use std::path::Path;

use reachtube::finding::FrontEnd;
use reachtube_files::{ErrorKind, Kind};
use thiserror::Error;

/// Why a command failed. A model that is not conformant is an [`Outcome`](crate::outcome::Outcome),
/// not an error.
#[derive(Debug, Error)]
pub(crate) enum Error {
    /// The command line is wrong, or asks for help or the version.
    #[error("{}", usage_words(.0))]
    Usage(clap::Error),
    /// What was given cannot be used: what it is, what is wrong and what to do.
    #[error("{1}")]
    Given(ErrorKind, String),
    /// The library reported an error, whose remedies are written for these users.
    #[error("{}", words(&**.0, *.1))]
    Library(Box<dyn Kind>, FrontEnd),
}

/// `identify` and `model` have no robot.
pub(crate) const NO_ROBOT: &str =
    "no robot is given; name one with --robot, or with robot = \"..\" in the settings file";

/// `conform` and `model` do not know what the recorded torques are.
pub(crate) const NO_TORQUE: &str = "the meaning of the recorded torques is not given; say --torque \
                                    motor, link or compensated, or torque = \"..\" in the settings \
                                    file";

impl Error {
    pub(crate) fn setting(problem: impl Into<String>) -> Self {
        Self::Given(ErrorKind::Setting, problem.into())
    }

    pub(crate) fn settings_file(path: &Path, problem: impl std::fmt::Display) -> Self {
        Self::setting(format!("{}: {problem}", path.display()))
    }

    pub(crate) fn output(error: std::io::Error) -> Self {
        let problem = format!(
            "standard output: cannot write: {error}; make room or print elsewhere, and run the \
             command again"
        );
        Self::Given(ErrorKind::File, problem)
    }

    /// Returns the error with remedies for the users of another front end.
    pub(crate) fn written_for(self, front_end: FrontEnd) -> Self {
        match self {
            Self::Library(error, _) => Self::Library(error, front_end),
            error => error,
        }
    }

    /// Returns what the error is about, as `--json` prints it.
    pub(crate) fn kind(&self) -> ErrorKind {
        match self {
            Self::Usage(_) => ErrorKind::Usage,
            Self::Given(kind, _) => *kind,
            Self::Library(error, _) => error.kind(),
        }
    }
}

impl<E: Kind> From<E> for Error {
    fn from(error: E) -> Self {
        Self::Library(Box::new(error), FrontEnd::CommandLine)
    }
}

/// Returns the text of an error of the library, with the settings that help.
fn words(error: &dyn Kind, front_end: FrontEnd) -> String {
    match error.find::<reachtube::conform::Error>() {
        Some(error) => error.written_for(front_end),
        None => error.to_string(),
    }
}

/// Returns clap's message without its mark as an error, and without colours.
fn usage_words(error: &clap::Error) -> String {
    let text = error.render().to_string();
    text.strip_prefix("error: ").unwrap_or(&text).trim_end().into()
}

/// A result of the command line.
pub(crate) type Result<T, E = Error> = std::result::Result<T, E>;
