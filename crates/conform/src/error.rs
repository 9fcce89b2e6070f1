use std::path::PathBuf;

use reachtube_files::AnyError;
use reachtube_reach::ReachError;
use thiserror::Error;

use reachtube_finding::{Advice, FrontEnd, Setting, advised};

/// Why a conformance could not be decided. A model that is not conformant is no error but a value.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum Error {
    /// The job was cancelled by its observer.
    #[error("the job was cancelled")]
    Cancelled,
    /// A nominal model that cannot be fitted.
    #[error("the nominal model cannot be fitted: {0}")]
    Fit(String),
    /// A setting has another number of values than the robot's states and inputs ask for.
    #[error("{given} {setting} values; give {needed}: {order}")]
    SettingCount {
        /// The setting.
        setting: &'static str,
        /// How many values it has.
        given: usize,
        /// How many it must have.
        needed: usize,
        /// What they are, in their order.
        order: &'static str,
    },
    /// A value of a setting is not finite or outside its range.
    #[error("{setting}{} is {value}; it must be {}", number(*index), range(*low, *high))]
    SettingRange {
        /// The setting.
        setting: &'static str,
        /// Which of its values, from 1; `None` for a setting with one value.
        index: Option<usize>,
        /// The value.
        value: f64,
        /// The lowest value allowed.
        low: f64,
        /// The highest value allowed.
        high: f64,
    },
    /// A recording is not the one that was read first.
    #[error("{}: the recording has changed since it was first read; run the command again",
        path.display())]
    Changed {
        /// The recording.
        path: PathBuf,
    },
    /// A step for linear models was asked of another one.
    #[error("the model is not linear; use the steps for polynomial models")]
    NotLinear,
    /// Healthy motion cannot be learnt from so few recordings.
    #[error(
        "healthy motion needs at least 2 recordings, of which one half shapes the ranges and the \
         other scales them, and has {count}; give more"
    )]
    TooFewHealthy {
        /// Number of recordings.
        count: usize,
    },
    /// A recording of healthy motion cannot be used.
    #[error("healthy recording {name}: {problem}")]
    Healthy {
        /// Its name.
        name: String,
        /// The problem.
        problem: String,
    },
    /// What drives the model cannot do what was asked.
    #[error("{0}")]
    Drive(Advice),
    /// U was to grow with the rate of the nominal motion, and cannot.
    #[error(
        "U grows with the nominal motion, which needs {0}; choose that, or leave input doubling out"
    )]
    InputDoubling(&'static str),
    /// U was to cover stiction, and cannot.
    #[error("U cannot be widened for stiction: {0}")]
    Stiction(&'static str),
    /// A certificate was asked of hulls, or of a model that is not linear.
    #[error(
        "a certificate is about points in the reachable set of a linear model; ask for them by the \
         notion exact or phase-plane, with model 1 of order 1"
    )]
    NotPoints,
    /// Motions cannot calibrate the sets.
    #[error("calibrate: {0}")]
    Calibration(Advice),
    /// A fold cannot be made, merged or solved.
    #[error("fold: {0}")]
    Fold(Advice),
    /// A model file is not one, or of another version.
    #[error("{}: {problem}", path.display())]
    ModelFile {
        /// The file.
        path: PathBuf,
        /// The problem and the remedy.
        problem: String,
    },
    /// The nominal motion, without any disturbance, leaves every bound.
    #[error(
        "{case}: the model runs away after {time:.3} s under the recorded input alone, so no sets \
         can be found for it; check what the recorded torques are, or use the samples before, \
         shorter windows, another model or order, or the model's equations for nominal motions"
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
    /// A file could not be read or written.
    #[error(transparent)]
    File(#[from] reachtube_files::Error),
    /// What drives the model, or the model itself, could not be made.
    #[error(transparent)]
    Other(#[from] AnyError),
    /// The reachable set could not be computed.
    #[error(transparent)]
    Reach(#[from] ReachError),
}

reachtube_files::kinds!(Error {
    [Recordings | File | Other] => inner,
    ModelFile => Model,
    Changed | Healthy | TooFewHealthy => Recordings,
    SettingCount | SettingRange | NotPoints | Calibration => Setting,
    _ => NoAnswer,
});

impl Error {
    /// Takes an error of what drives a model.
    pub fn other(error: impl reachtube_files::Kind) -> Self {
        Self::Other(AnyError::new(error))
    }

    pub(crate) fn settings(&self) -> Vec<Setting> {
        match self {
            Self::NotPoints => vec![Setting::new("notion", "exact")],
            Self::Calibration(advice) | Self::Drive(advice) | Self::Fold(advice) => {
                advice.settings.clone()
            }
            Self::RunsAway { time, .. } => {
                vec![Setting::new("until", format!("{time:.3}")), Setting::new("torque", "")]
            }
            _ => Vec::new(),
        }
    }

    /// Returns what is wrong, what to do, and the settings that do it as users of a front end write
    /// them. `Display` leaves the settings to the words.
    ///
    /// # Examples
    ///
    /// ```
    /// use reachtube_conform::Error;
    /// use reachtube_finding::FrontEnd;
    ///
    /// let written = Error::NotPoints.written_for(FrontEnd::Python);
    /// assert!(written.ends_with("(notion=\"exact\")"));
    /// ```
    #[must_use]
    pub fn written_for(&self, front_end: FrontEnd) -> String {
        advised(self.to_string(), &self.settings(), front_end)
    }
}

fn number(index: Option<usize>) -> String {
    index.map_or_else(String::new, |index| format!(" {index}"))
}

fn range(low: f64, high: f64) -> String {
    // Powers of ten as a person writes them.
    let number = |x: f64| match x.abs() {
        size if size == 0.0 || (1e-3..1e6).contains(&size) => format!("{x}"),
        _ => format!("{x:e}"),
    };
    if high == f64::MAX {
        format!("{} or more", number(low))
    } else {
        format!("between {} and {}", number(low), number(high))
    }
}

/// The result of a step of a conformance.
pub type Result<T, E = Error> = std::result::Result<T, E>;
