use std::path::PathBuf;

use reachtube_reach::ReachError;
use thiserror::Error;

use crate::data::Defect;

/// What can go wrong. A model that is not conformant is not an error, it is a [`Verdict`](crate::conform::Verdict).
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum Error {
    /// A file could not be read.
    #[error("{}: cannot read: {source}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// Why.
        source: std::io::Error,
    },
    /// A file could not be written; nothing was left behind.
    #[error("{}: cannot write: {source}; nothing was written, and a file of that name is as it was", path.display())]
    Write {
        /// The file.
        path: PathBuf,
        /// Why.
        source: std::io::Error,
    },
    /// The recordings have defects.
    #[error("{}", crate::data::list_defects(.0))]
    Defects(Vec<Defect>),
    /// A suite was asked for that the data set does not have.
    #[error("{}: there is no suite \"{name}\"; the data set has {}", index.display(), if available.is_empty() { "no suite at all (the column suite of runs.csv is empty)".into() } else { available.join(", ") })]
    UnknownSuite {
        /// The index file.
        index: PathBuf,
        /// The name asked for.
        name: String,
        /// The names there are.
        available: Vec<String>,
    },
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
    /// The solver of the linear program gave up.
    #[error("the linear program was not solved: {0}")]
    Program(String),
    /// The robot's description is wrong.
    #[error(transparent)]
    Robot(#[from] reachtube_robot::RobotError),
    /// The reachable set could not be computed.
    #[error(transparent)]
    Reach(#[from] ReachError),
    /// A figure or page could not be drawn.
    #[error(transparent)]
    Report(#[from] crate::report::ReportError),
}

/// A result of this crate.
pub type Result<T, E = Error> = std::result::Result<T, E>;
