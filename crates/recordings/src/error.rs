use std::path::PathBuf;

use thiserror::Error;

use crate::defect::{Defect, list_defects};

/// Why recordings could not be used.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum Error {
    /// A file could not be read.
    #[error(transparent)]
    File(#[from] reachtube_files::Error),
    /// The recordings have defects.
    #[error("{}", list_defects(.0))]
    Defects(Vec<Defect>),
    /// The data set has no suite of a name that was asked for.
    #[error("{}: {}", index.display(), match &available[..] {
        [] => "no run has a suite; put the runs that start from one state under one input into a \
               suite, by the column suite".into(),
        some => format!(
            "there is no suite \"{name}\"; the data set has {}", some.join(", ")
        ),
    })]
    UnknownSuite {
        /// The index file.
        index: PathBuf,
        /// The name asked for.
        name: String,
        /// The names that the index has.
        available: Vec<String>,
    },
    /// A suite was asked for twice.
    #[error("a suite is named twice in {}; name each once", names.join(","))]
    RepeatedSuite {
        /// The names asked for.
        names: Vec<String>,
    },
}

/// A result of this crate.
pub type Result<T, E = Error> = std::result::Result<T, E>;
