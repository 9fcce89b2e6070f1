//! The errors of this crate.

use thiserror::Error;

/// The result of a fallible function of this crate.
pub(crate) type Result<T> = core::result::Result<T, Error>;

pub(crate) fn line_of(text: &str, at: usize) -> usize {
    text[..at].matches('\n').count() + 1
}

/// Why a question about a robot's links has no answer.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum Error {
    /// A text is not TOML, or has keys that are not known.
    #[error(
        "{origin}: {}\ncorrect the text; docs/verify.md describes the format",
        message.trim_end()
    )]
    Syntax {
        /// The file that the text came from.
        origin: String,
        /// The parser's message, with line and column.
        message: String,
    },
    /// A value is outside its range.
    #[error("{origin}:{line}: {place}{problem}; {remedy}")]
    Invalid {
        /// The file that the value came from.
        origin: String,
        /// The line, from 1.
        line: usize,
        /// The object of the value, as "capsule 2: ".
        place: String,
        /// The value and the limit that it violates.
        problem: String,
        /// The remedy.
        remedy: String,
    },
    /// The collision mesh of a link cannot be used.
    #[error(
        "the collision mesh `{mesh}` of link `{link}` {problem}; {remedy}, or give the link's \
         capsules in a TOML file"
    )]
    Mesh {
        /// The link.
        link: String,
        /// The file of the mesh, as the URDF names it.
        mesh: String,
        /// The problem.
        problem: String,
        /// The remedy.
        remedy: String,
    },
    /// No capsules are known for a robot.
    #[error(
        "no capsules are known for the links of robot `{robot}`; give a TOML file with \
         [[capsule]] tables, or the URDF with collision shapes"
    )]
    NoCapsules {
        /// The robot.
        robot: String,
    },
    /// Links are described by the URDF of another robot.
    #[error(
        "{urdf}: {problem}, so its shapes do not fit the links of robot `{robot}`; name the URDF \
         that the model was made from, or a TOML file with [[capsule]] tables"
    )]
    OtherRobot {
        /// The file.
        urdf: String,
        /// The robot of the model.
        robot: String,
        /// The difference.
        problem: String,
    },
    /// Nothing is compared with anything.
    #[error(
        "no obstacle concerns a link that has a capsule, so there is nothing to decide; name other \
         `links` of the obstacles, or give these links capsules"
    )]
    NoPair,
    /// The recordings of a suite have other sample times.
    #[error(
        "suite {suite}: its recordings have different sample times, but are one motion; give \
         recordings of another sample time a suite of their own in runs.csv"
    )]
    OtherTimes {
        /// The suite.
        suite: String,
    },
    /// A motion has no step.
    #[error(
        "{case} has a single sample, so nothing moves; give recordings of two or more samples, or \
         a later `until`"
    )]
    SingleSample {
        /// The suite, and the run.
        case: String,
    },
    /// Stops of category 1 are requested, and no deceleration is given.
    #[error(
        "{origin}: stops of category 1 need the greatest deceleration of each joint; add the line \
         `deceleration = [4, 4, 4, 6, 6, 6]`, one number for each joint in rad/s²"
    )]
    NoDeceleration {
        /// The file of the brakes.
        origin: String,
    },
    /// A file could not be read.
    #[error(transparent)]
    File(#[from] reachtube_files::Error),
    /// A robot could not be read.
    #[error(transparent)]
    Robot(#[from] reachtube_robot::RobotError),
    /// Recordings could not be read.
    #[error(transparent)]
    Recordings(#[from] reachtube_recordings::Error),
    /// The motion of a model could not be computed.
    #[error(transparent)]
    Conform(#[from] reachtube_conform::Error),
}

reachtube_files::kinds!(Error {
    [File | Robot | Recordings | Conform] => inner,
    Mesh | NoCapsules => Robot,
    OtherTimes | SingleSample => Recordings,
    _ => Setting,
});
