use std::path::PathBuf;

use reachtube_reach::ReachError;
use thiserror::Error;

use crate::data::Defect;

/// What can go wrong. A model that is not conformant is not an error, it is a value, as in
/// [`Proof`](crate::conform::Proof) and [`Check`](crate::conform::Check).
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum Error {
    /// A file could not be read.
    #[error("{}: cannot read: {source}; {remedy}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// Why.
        source: std::io::Error,
        /// What to do.
        remedy: &'static str,
    },
    /// A file could not be written; nothing was left behind.
    #[error("{}: cannot write: {source}; nothing was written, and a file of that name is as it was; choose a place with room and permission", path.display())]
    Write {
        /// The file.
        path: PathBuf,
        /// Why.
        source: std::io::Error,
    },
    /// A result could not be printed.
    #[error(
        "standard output: cannot write: {0}; make room or print elsewhere, and run the command again"
    )]
    Output(std::io::Error),
    /// The recordings have defects.
    #[error("{}", crate::data::list_defects(.0))]
    Defects(Vec<Defect>),
    /// A suite was asked for that the data set does not have.
    #[error("{}: {}", index.display(), match &available[..] {
        [] => "no run has a suite; put the runs that start from one state under one input into a suite, by the column suite".into(),
        some => format!("there is no suite \"{name}\"; the data set has {}", some.join(", ")),
    })]
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
    /// The model's own motion, without any disturbance, leaves every bound.
    #[error(
        "{case}: the model runs away after {time:.3} s under the recorded input alone, so no sets can be found for it; use --until {time:.3}, another order or another model"
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
    /// The robot's description is wrong.
    #[error(transparent)]
    Robot(#[from] reachtube_robot::RobotError),
    /// Polynomials of that order do not fit.
    #[error(transparent)]
    Space(#[from] reachtube_scalar::TaylorSpaceError),
    /// The reachable set could not be computed.
    #[error(transparent)]
    Reach(#[from] ReachError),
    /// A figure or page could not be drawn.
    #[error(transparent)]
    Report(#[from] crate::report::ReportError),
}

/// A result of this crate.
pub type Result<T, E = Error> = std::result::Result<T, E>;
