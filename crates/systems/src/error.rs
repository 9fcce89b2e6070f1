use std::path::PathBuf;

use reachtube_scalar::number::counted;
use thiserror::Error;

/// Why a system has no sets, or cannot be compared with recordings.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum Error {
    /// Recordings could not be read.
    #[error(transparent)]
    Recordings(Box<reachtube_recordings::Error>),
    /// A file could not be read.
    #[error(transparent)]
    File(#[from] reachtube_files::Error),
    /// The linear program.
    #[error(transparent)]
    Program(Box<reachtube_conform::Error>),
    /// The reachable sets.
    #[error(transparent)]
    Reach(#[from] reachtube_reach::ReachError),
    /// A description is wrong.
    #[error("{}{problem}", at(file))]
    System {
        /// The file of the description, if there is one.
        file: Option<PathBuf>,
        /// What is wrong with it, and what to do.
        problem: String,
    },
    /// A folder has no recording.
    #[error("{}: the folder has no CSV file; give recordings or folders of them", folder.display())]
    NoRun {
        /// The folder.
        folder: PathBuf,
    },
    /// A recording has too few samples.
    #[error(
        "{run}: it has {}, but {needed} are needed{}; leave it out", counted(*samples, "sample"),
        if *needed > 2 { ": the first ones tell where it starts" } else { "" }
    )]
    Short {
        /// The recording.
        run: String,
        /// The number of its samples.
        samples: usize,
        /// The number that it needs.
        needed: usize,
    },
    /// Samples are not where the system has them.
    #[error("{run}: {problem}; resample it at an even rate")]
    Times {
        /// The recording.
        run: String,
        /// What is wrong with its times.
        problem: String,
    },
    /// The columns of the states are missing.
    #[error(
        "{run}: it has not all columns of the states {}, at which its motion starts; give them, or \
         write start = {{ samples = 10 }} in the system", states.join(", ")
    )]
    NoStates {
        /// The recording.
        run: String,
        /// The states.
        states: Vec<String>,
    },
    /// No set reaches a recorded output.
    #[error(
        "{run}: at {time} s, {output} is {off} off, and no set that is to be found reaches it; let \
         X0, W or V act on it"
    )]
    Unreached {
        /// The recording.
        run: String,
        /// Time since its first sample, s.
        time: f64,
        /// The output.
        output: String,
        /// How far it is from the outputs that can be reached.
        off: f64,
    },
}

reachtube_files::kinds!(Error {
    [Recordings | File | Program] => inner,
    System => Setting,
    Reach | Unreached => NoAnswer,
    _ => Recordings,
});

/// A result of this crate.
pub type Result<T, E = Error> = std::result::Result<T, E>;

fn at(file: &Option<PathBuf>) -> String {
    file.as_ref().map_or(String::new(), |file| format!("{}: ", file.display()))
}

impl From<reachtube_recordings::Error> for Error {
    fn from(error: reachtube_recordings::Error) -> Self {
        Self::Recordings(Box::new(error))
    }
}

impl From<reachtube_conform::Error> for Error {
    fn from(error: reachtube_conform::Error) -> Self {
        Self::Program(Box::new(error))
    }
}
