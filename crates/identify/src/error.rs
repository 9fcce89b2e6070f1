use std::path::PathBuf;

use thiserror::Error;

/// Reasons why a robot could not be identified.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum Error {
    /// The settings are not valid TOML, or have a field that does not exist.
    #[error("{origin}: {}\ncorrect it; docs/identify.md lists the settings", message.trim_end())]
    Syntax {
        /// File or name of the settings.
        origin: String,
        /// The parser's message with line, column and field.
        message: String,
    },
    /// The settings name no recordings of exciting motions.
    #[error(
        "the inertial parameters need recordings of exciting motions, but none is named; name some \
         with --dynamic or dynamic = [..]"
    )]
    NoExcitingMotions,
    /// A setting that must be a positive number is not.
    #[error("{setting} = {value} must be finite and above 0; choose another value")]
    NotPositive {
        /// Name of the setting.
        setting: &'static str,
        /// Its value.
        value: f64,
    },
    /// The number of gains differs from the number of joints.
    #[error(
        "gains: {given} given; give one for each of the {joints} joints, in the order of the \
         robot's joints"
    )]
    GainCount {
        /// Number of gains.
        given: usize,
        /// Number of joints.
        joints: usize,
    },
    /// A gain is 0 or not finite.
    #[error("gains: gain {number} is {gain}; a gain must be finite and other than 0")]
    Gain {
        /// Number of the joint, counted from 1.
        number: usize,
        /// The gain.
        gain: f64,
    },
    /// The names of the columns' joints are not those of the robot.
    #[error(
        "joints = {given:?} must name each of the robot's {} joints once, in the order of the \
         recordings' columns; the robot's joints are {}",
        joints.len(),
        joints.join(", ")
    )]
    JointNames {
        /// The names in the settings.
        given: Vec<String>,
        /// The names of the robot's joints.
        joints: Vec<String>,
    },
    /// A folder has no recordings.
    #[error("{}: the folder has no CSV file; name a folder with recordings", folder.display())]
    NoCsvFile {
        /// The folder.
        folder: PathBuf,
    },
    /// The cut-off frequency is not between 0 and half the sample rate.
    #[error(
        "cut_off = {cut_off} Hz must be above 0 and below half the sample rate, {limit:.4} Hz; \
         choose a value between, or remove it to have one chosen"
    )]
    CutOff {
        /// The cut-off \[Hz\].
        cut_off: f64,
        /// Half the lowest sample rate \[Hz\].
        limit: f64,
    },
    /// A recording is too short for the low-pass.
    #[error(
        "{log}: {samples} samples over {duration:.3} s are too few for a low-pass of {cut_off} \
         Hz; remove the recording from the settings or raise cut_off"
    )]
    TooShort {
        /// Name of the recording.
        log: String,
        /// Number of its samples.
        samples: usize,
        /// Its duration \[s\].
        duration: f64,
        /// The cut-off \[Hz\].
        cut_off: f64,
    },
    /// A recording is sampled too slowly for the low-pass.
    #[error(
        "{log}: the sample rate of {rate:.4} Hz is not above twice cut_off = {cut_off} Hz; lower \
         cut_off or remove the recording from the settings"
    )]
    SampledTooSlowly {
        /// Name of the recording.
        log: String,
        /// Its sample rate \[Hz\].
        rate: f64,
        /// The cut-off \[Hz\].
        cut_off: f64,
    },
    /// All joints stand still in the recordings for the inertial parameters.
    #[error(
        "no joint moves in the recordings for the inertial parameters; name recordings of motions \
         with --dynamic or dynamic = [..]"
    )]
    NoMotion,
    /// The recordings do not determine all parameters, and no prior may decide.
    #[error(
        "the recordings do not determine {} of {total} combinations of parameters (condition \
         above {limit:.0e}): {}; move all joints through more positions and faster, or set \
         model.physical = true to let the description decide about them",
        combinations.len(),
        combinations.join("; ")
    )]
    Undetermined {
        /// The combinations that are not determined.
        combinations: Vec<String>,
        /// Number of all combinations.
        total: usize,
        /// Condition above which a combination counts as not determined.
        limit: f64,
    },
    /// The search for physically consistent links failed.
    #[error(
        "no physically consistent links were found near the data; check gains and signs, or set \
         model.physical = false to see the least-squares fit"
    )]
    NoPhysicalLinks,
    /// The recordings have defects or could not be read.
    #[error(transparent)]
    Recordings(#[from] reachtube_recordings::Error),
    /// A file could not be read or written.
    #[error(transparent)]
    File(#[from] reachtube_files::Error),
    /// The robot's description is wrong.
    #[error(transparent)]
    Robot(#[from] reachtube_robot::RobotError),
}

/// A result of this crate.
pub type Result<T, E = Error> = std::result::Result<T, E>;
