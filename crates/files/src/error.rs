use std::path::PathBuf;

use thiserror::Error;

/// Why a file cannot be read or written.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum Error {
    /// A file could not be read.
    #[error("{}: cannot read: {source}; {remedy}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// The operating system's reason.
        source: std::io::Error,
        /// The remedy.
        remedy: &'static str,
    },
    /// A file could not be written. No part of it remains, and an older file of its name is as it
    /// was.
    #[error(
        "{}: cannot write: {source}; an existing file was not changed; choose a place \
         with room and permission",
        path.display()
    )]
    Write {
        /// The file.
        path: PathBuf,
        /// The operating system's reason.
        source: std::io::Error,
    },
    /// A file does not hold the progress of this job.
    #[error("{}: {problem}; give the file of this job, or a new one", path.display())]
    Progress {
        /// The file.
        path: PathBuf,
        /// The problem.
        problem: String,
    },
    /// A file is not what it should be.
    #[error("{}: {problem}", path.display())]
    Content {
        /// The file.
        path: PathBuf,
        /// What is wrong with it, and what to do.
        problem: String,
    },
    /// A file is where a folder is needed.
    #[error("{}: this is a file, but a folder is needed; give another name", path.display())]
    NotFolder {
        /// The file.
        path: PathBuf,
    },
    /// A file exists that reachtube did not write.
    #[error(
        "{}: a file of this name exists, and it carries no mark of reachtube, so it is not \
         overwritten; choose another name, or overwrite it with --force",
        path.display()
    )]
    Exists {
        /// The file.
        path: PathBuf,
    },
}

crate::kinds!(Error { Content => Model, _ => File });

/// A result of this crate.
pub(crate) type Result<T, E = Error> = std::result::Result<T, E>;
