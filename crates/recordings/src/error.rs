use std::path::PathBuf;

use thiserror::Error;

use crate::defect::{Defect, list_defects};

/// Why recordings cannot be used.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum Error {
    /// A file could not be read.
    #[error(transparent)]
    File(#[from] reachtube_files::Error),
    /// The recordings have defects, all of which are listed.
    #[error("{}", list_defects(.0))]
    Defects(Vec<Defect>),
    /// The source has no suite of this name, or none at all.
    #[error("{}: {}", index.display(), match &available[..] {
        [] => "no run has a suite; assign the runs that start from one state under one input to a \
               suite, by the column suite".into(),
        some => format!(
            "there is no suite \"{name}\"; the data set has {}", some.join(", ")
        ),
    })]
    UnknownSuite {
        /// Name of the source's index.
        index: PathBuf,
        /// The name asked for.
        name: String,
        /// Names of the suites that exist.
        available: Vec<String>,
    },
    /// A suite was asked for more than once.
    #[error("a suite is named twice in {}; name each suite once", names.join(","))]
    RepeatedSuite {
        /// The names asked for.
        names: Vec<String>,
    },
}

/// A result of this crate.
pub(crate) type Result<T, E = Error> = std::result::Result<T, E>;
