use std::path::{Path, PathBuf};

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
         with --excitation or excitation = [..]"
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
    /// The names of the columns' joints differ from the robot's.
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
    #[error(
        "{}: the folder has no CSV file and no log in MCAP or rosbag2; name a folder with \
         recordings",
        folder.display()
    )]
    NoCsvFile {
        /// The folder.
        folder: PathBuf,
    },
    /// The cut-off frequency is not between 0 and half the sample rate.
    #[error(
        "cut_off = {cut_off} Hz must be above 0 and below {limit:.4} Hz, half the sample rate of \
         {log}; choose a value between, or remove it to have one chosen"
    )]
    CutOff {
        /// The cut-off \[Hz\].
        cut_off: f64,
        /// Half the lowest sample rate \[Hz\].
        limit: f64,
        /// Name of the recording with the lowest sample rate.
        log: String,
    },
    /// A validation recording is also a recording of a fit.
    #[error(
        "{}: this validation recording is not held out, because the fit uses {} over the same \
         times; name another recording with --validate, or give the two disjoint intervals with \
         from and until",
        validate.display(),
        same_content(validate, fitted)
    )]
    NotHeldOut {
        /// The validation recording.
        validate: PathBuf,
        /// The recording of the fit.
        fitted: PathBuf,
    },
    /// Separate gravity moments are requested, but nothing determines them.
    #[error(
        "model.separate_gravity = true needs recordings for a gravity fit; name poses at rest with \
         --rest or slow motions with --one-joint, or remove the setting"
    )]
    SeparateGravity,
    /// The static recordings hold no pose.
    #[error(
        "the static recordings have no pose: in none of them does every joint stay below \
         model.rest_speed = {rest_speed} rad/s for {shortest} s; record rests, raise \
         model.rest_speed, or name motions with --one-joint or --excitation"
    )]
    NoPose {
        /// Speed up to which the robot counts as at rest \[rad/s\].
        rest_speed: f64,
        /// Shortest rest that counts as a pose \[s\].
        shortest: f64,
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
        "{log}: the sample rate of {rate:.4} Hz is not above twice cut_off = {cut_off} Hz; check \
         that its times are in s, lower cut_off, or remove the recording from the settings"
    )]
    SampledTooSlowly {
        /// Name of the recording.
        log: String,
        /// Its sample rate \[Hz\].
        rate: f64,
        /// The cut-off \[Hz\].
        cut_off: f64,
    },
    /// A window is shorter than the time between the samples of a recording.
    #[error(
        "{log}: a window of {window} s is shorter than the time between samples, {} s; give a \
         window of that length at least, or recordings with more samples",
        microseconds(*step)
    )]
    ShortWindow {
        /// Name of the recording.
        log: String,
        /// Length of the window \[s\].
        window: f64,
        /// Median time between its samples \[s\].
        step: f64,
    },
    /// All joints stand still in the recordings for the inertial parameters.
    #[error(
        "no joint moves in the recordings for the inertial parameters; name recordings of motions \
         with --excitation or excitation = [..]"
    )]
    NoMotion,
    /// The recordings do not determine all parameters, and no prior may decide.
    #[error(
        "the recordings do not determine {count} of {total} combinations of parameters (condition \
         above {limit:.0e}), which leaves these open: {}; move all joints through more positions \
         and faster, or set model.physical = true to let the description decide about them",
        combinations.join("; ")
    )]
    Undetermined {
        /// Number of combinations that are not determined.
        count: usize,
        /// The base parameters that depend on them.
        combinations: Vec<String>,
        /// Number of all combinations.
        total: usize,
        /// Condition above which a combination counts as not determined.
        limit: f64,
    },
    /// Least squares gives values that no robot has.
    #[error(
        "least squares gives a robot that cannot exist: {problem}; set model.physical = true for \
         the nearest physical links{}",
        causes.iter().map(|cause| format!("\nprobable cause: {cause}")).collect::<String>()
    )]
    ImpossibleRobot {
        /// The value that is not possible.
        problem: String,
        /// Warnings about the recordings that may explain it.
        causes: Vec<String>,
    },
    /// The search for physically consistent links failed.
    #[error(
        "no physically consistent links were found near the data; check the units, gains and signs \
         of the torques, or set model.physical = false to see the least-squares fit{}",
        cause.iter().map(|cause| format!("\nprobable cause: {cause}")).collect::<String>()
    )]
    NoPhysicalLinks {
        /// A warning about the recordings that may explain it.
        cause: Option<String>,
    },
    /// The recordings have defects or could not be read.
    #[error(transparent)]
    Recordings(#[from] reachtube_recordings::Error),
    /// A log in MCAP or rosbag2 could not be read.
    #[error(transparent)]
    Log(#[from] reachtube_logs::Error),
    /// A file could not be read or written.
    #[error(transparent)]
    File(#[from] reachtube_files::Error),
    /// The robot's description is wrong.
    #[error(transparent)]
    Robot(#[from] reachtube_robot::RobotError),
}

reachtube_files::kinds!(Error {
    [Recordings | Log | File | Robot] => inner,
    NoCsvFile | NotHeldOut | NoPose | TooShort | SampledTooSlowly | NoMotion => Recordings,
    Undetermined | ImpossibleRobot | NoPhysicalLinks => NoAnswer,
    _ => Setting,
});

fn microseconds(time: f64) -> f64 {
    (1e6 * time).round() / 1e6
}

/// Names the recording of a fit that has the content of a validation recording.
fn same_content(validate: &Path, fitted: &Path) -> String {
    if validate == fitted {
        "it".into()
    } else {
        format!("{}, which has the same content,", fitted.display())
    }
}

/// A result of this crate.
pub(crate) type Result<T, E = Error> = std::result::Result<T, E>;
