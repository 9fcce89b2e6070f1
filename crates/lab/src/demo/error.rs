//! Errors of the demo.

use std::path::PathBuf;

/// The reason why a demo could not be recorded.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum DemoError {
    /// All motions are held out.
    #[error(
        "demo: {motions} motions, of which {held_out} are held out, leave none to train with; \
         hold out fewer motions"
    )]
    NoTrainingMotion {
        /// Number of motions.
        motions: usize,
        /// Number of motions held out.
        held_out: usize,
    },
    /// The number of start points is not supported.
    #[error("demo: {given} start points per motion; give 1 to {most}")]
    StartPoints {
        /// The number given.
        given: usize,
        /// The largest number.
        most: usize,
    },
    /// A suite has no runs.
    #[error("demo: 0 runs per suite; give at least 1")]
    NoRuns,
    /// The duration of the motions is not supported.
    #[error("demo: motions of {given} s; give {shortest} to {longest} s")]
    Duration {
        /// The duration given \[s\].
        given: f64,
        /// The shortest duration \[s\].
        shortest: f64,
        /// The longest duration \[s\].
        longest: f64,
    },
    /// The folder holds files that no demo has written.
    #[error(
        "{}: the folder holds files that no demo has written and that could be overwritten; give \
         an empty folder",
        folder.display()
    )]
    ForeignFolder {
        /// The folder.
        folder: PathBuf,
    },
}
