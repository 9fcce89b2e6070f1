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
            "there is no suite \"{name}\"; the data set has {}{}",
            listed(some),
            beginning(name, some)
        ),
    })]
    UnknownSuite {
        /// Name of the source's index.
        index: PathBuf,
        /// The requested name.
        name: String,
        /// Names of the suites that exist.
        available: Vec<String>,
    },
    /// A suite was requested more than once.
    #[error("a suite is named twice in {}; name each suite once", names.join(","))]
    RepeatedSuite {
        /// The requested names.
        names: Vec<String>,
    },
}

reachtube_files::kinds!(Error {
    [File] => inner,
    Defects => Recordings,
    _ => Setting,
});

/// Number of suites that an error lists.
const LISTED: usize = 20;

fn listed(suites: &[String]) -> String {
    match suites.len() {
        many if many > LISTED => format!("{}, .. ({many} suites)", suites[..LISTED].join(", ")),
        _ => suites.join(", "),
    }
}

/// Returns the pattern that selects the suites whose names begin with `name`, if there are any.
fn beginning(name: &str, suites: &[String]) -> String {
    match suites.iter().filter(|suite| suite.starts_with(name)).count() {
        0 => String::new(),
        count => format!("; \"{name}*\" selects {count} of them"),
    }
}

/// A result of this crate.
pub(crate) type Result<T, E = Error> = std::result::Result<T, E>;
