use std::path::PathBuf;

use reachtube_reach::ReachError;
use thiserror::Error;

/// Why a model could not be made, read or bounded.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum Error {
    /// A setting does not fit.
    #[error("{0}")]
    Setting(String),
    /// A file is not one of an abstraction, or of another version.
    #[error("{}: {problem}", path.display())]
    ModelFile {
        /// The file.
        path: PathBuf,
        /// What is wrong and what to do.
        problem: String,
    },
    /// A file could not be read or written.
    #[error(transparent)]
    File(#[from] reachtube_files::Error),
    /// The robot's description is wrong.
    #[error(transparent)]
    Robot(#[from] reachtube_robot::RobotError),
    /// Polynomials of that order do not fit.
    #[error(transparent)]
    Space(#[from] reachtube_scalar::TaylorSpaceError),
    /// The system does not fit a reachable-set computation.
    #[error(transparent)]
    Reach(#[from] ReachError),
}

/// A result of this crate.
pub type Result<T, E = Error> = std::result::Result<T, E>;
