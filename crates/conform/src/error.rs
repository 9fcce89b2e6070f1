use std::path::PathBuf;

use reachtube_reach::ReachError;
use thiserror::Error;

/// Why a conformance could not be decided. A model that is not conformant is no error but a value.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum Error {
    /// A setting does not fit.
    #[error("{0}")]
    Setting(String),
    /// A model file is not one, or of another version.
    #[error("{}: {problem}", path.display())]
    ModelFile {
        /// The file.
        path: PathBuf,
        /// What is wrong and what to do.
        problem: String,
    },
    /// The model's own motion, without any disturbance, leaves every bound.
    #[error(
        "{case}: the model runs away after {time:.3} s under the recorded input alone, so no sets \
         can be found for it; use --until {time:.3}, another order or another model"
    )]
    RunsAway {
        /// The suite or run.
        case: String,
        /// The last sample time it could be followed to, s.
        time: f64,
    },
    /// The solver of the linear program gave up.
    #[error("the linear program was not solved: {0}")]
    Program(String),
    /// Recordings have defects, or could not be read.
    #[error(transparent)]
    Recordings(#[from] reachtube_recordings::Error),
    /// The model could not be made.
    #[error(transparent)]
    Abstraction(#[from] reachtube_abstraction::Error),
    /// A file could not be read or written.
    #[error(transparent)]
    File(#[from] reachtube_files::Error),
    /// The robot's description is wrong.
    #[error(transparent)]
    Robot(#[from] reachtube_robot::RobotError),
    /// The reachable set could not be computed.
    #[error(transparent)]
    Reach(#[from] ReachError),
}

/// A result of this crate.
pub type Result<T, E = Error> = std::result::Result<T, E>;
