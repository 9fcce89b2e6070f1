//! Errors of the command line.

use std::path::PathBuf;

use reachtube::conform::result::FrontEnd;
use reachtube::export::ExportError;
use reachtube::pipeline::Error as PipelineError;
use reachtube::recordings::Refusal;
use thiserror::Error;

/// Why a command failed. A model that is not conformant is an [`Outcome`](crate::outcome::Outcome),
/// not an error.
#[derive(Debug, Error)]
pub(crate) enum Error {
    /// The command line is wrong, or asks for help or the version.
    #[error("{}", usage_words(.0))]
    Usage(clap::Error),
    /// A key of the settings was given as an option.
    #[error(
        "--{key} is no option, but {key} is a key of the settings: write it to a file, and give \
         the file with --settings; choices.toml, which this command writes, has all keys"
    )]
    InSettings {
        /// The key.
        key: String,
    },
    /// A settings file is not TOML.
    #[error("{}: {message}", path.display())]
    SettingsSyntax {
        /// The file.
        path: PathBuf,
        /// What is wrong, with line and column.
        message: String,
    },
    /// The result could not be printed.
    #[error(
        "standard output: cannot write: {0}; make room or print elsewhere, and run the command \
         again"
    )]
    Output(#[source] std::io::Error),
    /// `robot show --expansion` has the wrong number of positions.
    #[error("--expansion lists {given}; give {joints} positions in {unit}, one per joint")]
    PositionCount {
        /// Number of values given.
        given: usize,
        /// Number of the robot's joints.
        joints: usize,
        /// Unit of the positions, or their units.
        unit: String,
    },
    /// A robot and the recordings differ in their number of joints.
    #[error(
        "robot {robot} has {joints} joints, but the recordings have {recorded}; name the robot \
         that was recorded"
    )]
    JointCount {
        /// Name or path of the robot.
        robot: String,
        /// Number of its joints.
        joints: usize,
        /// Number of recorded joints.
        recorded: usize,
    },
    /// `model` does not know what the recorded torques are.
    #[error(
        "the meaning of the recorded torques is not given; say --torque motor, link or \
         compensated, or torque = \"..\" in the settings file"
    )]
    NoTorque,
    /// `model` has no recordings.
    #[error(
        "no recordings are given; name some with --data, or with data = [..] in the settings file"
    )]
    NoData,
    /// `identify` has no robot.
    #[error(
        "no robot is given; name one with --robot, or with robot = \"..\" in the settings file"
    )]
    NoRobot,
    /// `--urdf` asks for a URDF of a robot that was not read from one.
    #[error(
        "--urdf writes the identified values into the robot's own URDF, but {robot} is not a URDF \
         file; give --robot a URDF file, or drop --urdf"
    )]
    NotUrdf {
        /// The robot given.
        robot: String,
    },
    /// `--out` names the companion file that `--urdf` writes.
    #[error(
        "--out {}: --urdf writes motors and friction to the same file; choose another name for one \
         of them",
        path.display()
    )]
    CompanionTaken {
        /// The companion of the new URDF.
        path: PathBuf,
    },
    /// An option that takes one number per state has something else.
    #[error(
        "{option}: {problem}; give {words}2 numbers (positions, velocities), or {states} (one \
         per state)"
    )]
    StateValues {
        /// The option.
        option: &'static str,
        /// What is wrong with its value.
        problem: String,
        /// The words that the option takes besides numbers, each with a comma and a space.
        words: &'static str,
        /// Number of states 2n.
        states: usize,
    },
    /// `excite` would write more samples than allowed.
    #[error(
        "--period {period} s at --rate {rate} Hz gives {samples:.0} samples, about {megabytes:.0} \
         MB of CSV, but at most {most} are allowed; shorten the period, lower the rate, or allow \
         more with --most-samples"
    )]
    TooManySamples {
        /// The period, s.
        period: f64,
        /// The sample rate, Hz.
        rate: f64,
        /// Number of samples.
        samples: f64,
        /// Size of the file, MB.
        megabytes: f64,
        /// Largest number of samples.
        most: u64,
    },
    /// No recording fills a window of `prepare`.
    #[error("no recording is left: {}", match window {
        Some(window) => format!(
            "the windows are {window} s long, but the longest prepared recording lasts \
             {longest:.3} s; give a shorter --window"
        ),
        None => "no log has two samples or more; give longer --data".into(),
    })]
    NothingPrepared {
        /// Length of the windows, s, where it is given.
        window: Option<f64>,
        /// Duration of the longest recording, s.
        longest: f64,
    },
    /// `inspect` found recordings that cannot be used.
    #[error("{}", refused.iter().map(Refusal::to_string).collect::<Vec<_>>().join("\n"))]
    Refused {
        /// One entry for each kind of defect.
        refused: Vec<Refusal>,
    },
    /// The recordings' torques mean something else than the torques that a model was found for.
    #[error(
        "--torque {given}, but the model was found with --torque {model}, and its input set covers \
         that only; give --torque {model}, or run conform on recordings with --torque {given}"
    )]
    OtherTorque {
        /// The meaning given.
        given: String,
        /// The model's.
        model: String,
    },
    /// `export` has no model for a tool.
    #[error(
        "only mjcf and urdf take --robot; name a model that `model` or `conform` wrote \
         with --model"
    )]
    NoModel,
    /// `export --update` for a tool whose files are written whole.
    #[error(
        "--update is for one file with --to urdf, and for files of the shield with --to \
         sara-shield; leave it out"
    )]
    NothingToUpdate,
    /// `export` does not use an option for what it writes.
    #[error("--{option} has no effect on an export to {tool}; leave it out")]
    NotForTool {
        /// The option, without dashes.
        option: &'static str,
        /// What the command writes.
        tool: String,
    },
    /// `export` has no recorded input.
    #[error(
        "an export to {tool} needs the recorded input; name the recordings with --data and the \
         suites with --suites"
    )]
    NoRecordedInput {
        /// The tool.
        tool: String,
    },
    /// A sample that `monitor` cannot use.
    #[error("standard input:{line}: {problem}")]
    Sample {
        /// The line, from 1.
        line: u64,
        /// What is wrong, and what to do.
        problem: String,
    },
    /// A log could not be read or cut.
    #[error(transparent)]
    Log(#[from] reachtube_logs::Error),
    /// A model or robot could not be exported.
    #[error(transparent)]
    Export(ExportError),
    /// The question of `verify` has no answer.
    #[error(transparent)]
    Verify(reachtube::verify::Error),
    /// No model could be made of logs.
    #[error(transparent)]
    Pipeline(Box<PipelineError>),
    /// The library reported an error about windows that the command cut.
    #[error("{}", .0.written_for(FrontEnd::Windows))]
    Windows(Box<reachtube::Error>),
    /// The library reported an error.
    #[error("{}", .0.written_for(FrontEnd::CommandLine))]
    Library(Box<reachtube::Error>),
}

impl Error {
    /// Returns what the error is about, as `--json` prints it.
    pub(crate) fn kind(&self) -> &'static str {
        match self {
            Self::Usage(_) | Self::InSettings { .. } => "usage",
            Self::Output(_) => "file",
            Self::Refused { .. } | Self::Sample { .. } => "recordings",
            Self::Pipeline(error) => match **error {
                PipelineError::NoSets { .. } => "conform",
                PipelineError::Choice { .. } => "setting",
                _ => "recordings",
            },
            Self::Log(error) => log_kind(error),
            Self::Export(_) => "export",
            Self::Verify(error) => verify_kind(error),
            Self::Library(error) | Self::Windows(error) => kind(error),
            _ => "setting",
        }
    }
}

/// Returns what an error of `verify` is about.
fn verify_kind(error: &reachtube::verify::Error) -> &'static str {
    use reachtube::verify::Error as E;
    match error {
        E::Mesh { .. } | E::NoCapsules { .. } => "robot",
        _ => "setting",
    }
}

/// Returns what an error of a log is about.
fn log_kind(error: &reachtube_logs::Error) -> &'static str {
    use reachtube_logs::Error as E;
    match error {
        E::File(_) | E::Format { .. } | E::Damaged(_) => "file",
        E::NoTopic { .. }
        | E::SeveralTopics { .. }
        | E::TopicType { .. }
        | E::Setting(_)
        | E::Intervals { .. } => "setting",
        _ => "recordings",
    }
}

/// Returns what an error of the library is about: what is wrong in the end, else the step.
fn kind(error: &reachtube::Error) -> &'static str {
    use reachtube::Error as E;
    use reachtube::abstraction::Error as Abstraction;
    use reachtube::conform::Error as Conform;
    use reachtube::identify::Error as Identify;
    match error {
        E::File(_)
        | E::Identify(Identify::File(_))
        | E::Abstraction(Abstraction::File(_))
        | E::Conform(Conform::File(_)) => "file",
        E::Recordings(_)
        | E::Identify(Identify::Recordings(_))
        | E::Conform(Conform::Recordings(_)) => "recordings",
        E::Robot(_)
        | E::Identify(Identify::Robot(_))
        | E::Abstraction(Abstraction::Robot(_))
        | E::Conform(Conform::Robot(_)) => "robot",
        E::Identify(Identify::Log(error)) => log_kind(error),
        E::Identify(_) => "identify",
        E::Abstraction(_) | E::Conform(Conform::Abstraction(_)) => "abstraction",
        E::Conform(_) => "conform",
        E::Campaign(_) => "campaign",
        E::VirtualRobot(_) => "virtual-robot",
        E::Reproduce(_) => "reproduce",
        E::Page(_) => "report",
        _ => "other",
    }
}

/// Returns clap's message without its mark as an error, and without colours.
fn usage_words(error: &clap::Error) -> String {
    let text = error.render().to_string();
    text.strip_prefix("error: ").unwrap_or(&text).trim_end().into()
}

/// A result of the command line.
pub(crate) type Result<T, E = Error> = std::result::Result<T, E>;

impl From<ExportError> for Error {
    fn from(error: ExportError) -> Self {
        match error {
            ExportError::Conform(error) => error.into(),
            error => Self::Export(error),
        }
    }
}

impl From<reachtube::verify::Error> for Error {
    fn from(error: reachtube::verify::Error) -> Self {
        use reachtube::verify::Error as E;
        match error {
            E::File(error) => error.into(),
            E::Robot(error) => error.into(),
            E::Conform(error) => error.into(),
            E::Recordings(error) => error.into(),
            error => Self::Verify(error),
        }
    }
}

impl From<PipelineError> for Error {
    fn from(error: PipelineError) -> Self {
        match error {
            PipelineError::Identify(error) => (*error).into(),
            PipelineError::Conform(error) => (*error).into(),
            PipelineError::Robot(error) => (*error).into(),
            PipelineError::Abstraction(error) => (*error).into(),
            PipelineError::Verify(error) => (*error).into(),
            PipelineError::File(error) => error.into(),
            PipelineError::Settings { path, message } => Self::SettingsSyntax { path, message },
            error => Self::Pipeline(Box::new(error)),
        }
    }
}

impl From<reachtube::page::Error> for Error {
    fn from(error: reachtube::page::Error) -> Self {
        match error {
            reachtube::page::Error::Conform(error) => error.into(),
            error => Self::Library(Box::new(error.into())),
        }
    }
}

/// Lets `?` pass on the errors of the library's crates.
macro_rules! from_library {
    ($($error:ty),* $(,)?) => {
        $(impl From<$error> for Error {
            fn from(error: $error) -> Self {
                Self::Library(Box::new(error.into()))
            }
        })*
    };
}

from_library!(
    reachtube::Error,
    reachtube::abstraction::Error,
    reachtube::conform::Error,
    reachtube::identify::Error,
    reachtube::recordings::Error,
    reachtube::robot::RobotError,
    reachtube_files::Error,
);
