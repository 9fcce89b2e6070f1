//! Errors of the command line.

use std::path::PathBuf;

use thiserror::Error;

/// Why a command failed. A model that is not conformant is an [`Outcome`](crate::outcome::Outcome),
/// not an error.
#[derive(Debug, Error)]
pub enum Error {
    /// The result could not be printed.
    #[error(
        "standard output: cannot write: {0}; make room or print elsewhere, and run the command \
         again"
    )]
    Output(#[source] std::io::Error),
    /// `--at` has the wrong number of positions.
    #[error("--at lists {given}; give {joints} positions in {unit}, one per joint")]
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
    /// `--explain` is neither `none` nor two numbers.
    #[error(
        "--explain: \"{given}\" is neither none nor 2 numbers; give none, or 2 numbers separated \
         by a comma: rad, rad/s"
    )]
    ExplainTolerance {
        /// The value given.
        given: String,
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
    /// The library reported an error.
    #[error(transparent)]
    Library(#[from] reachtube::Error),
}

/// A result of the command line.
pub type Result<T, E = Error> = std::result::Result<T, E>;

/// Lets `?` pass on the errors of the library's crates.
macro_rules! from_library {
    ($($error:ty),* $(,)?) => {
        $(impl From<$error> for Error {
            fn from(error: $error) -> Self {
                Self::Library(error.into())
            }
        })*
    };
}

from_library!(
    reachtube::abstraction::Error,
    reachtube::conform::Error,
    reachtube::identify::Error,
    reachtube::recordings::Error,
    reachtube::report::ReportError,
    reachtube::robot::RobotError,
    reachtube_files::Error,
);
