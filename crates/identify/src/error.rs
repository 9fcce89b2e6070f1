use thiserror::Error;

/// Why a robot could not be identified.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum Error {
    /// A setting does not fit.
    #[error("{0}")]
    Setting(String),
    /// Recordings have defects, or could not be read.
    #[error(transparent)]
    Recordings(#[from] reachtube_recordings::Error),
    /// A file could not be read or written.
    #[error(transparent)]
    File(#[from] reachtube_files::Error),
    /// The robot's description is wrong.
    #[error(transparent)]
    Robot(#[from] reachtube_robot::RobotError),
}

/// A result of this crate.
pub type Result<T, E = Error> = std::result::Result<T, E>;
