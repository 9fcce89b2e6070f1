//! The errors of this crate.

use crate::joint_kind::JointKind;
use std::path::PathBuf;

/// The reason why a robot could not be made or a question about it has no answer.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum RobotError {
    /// No embedded robot has this name and no file could be read.
    #[error(
        "cannot read robot `{}`: {source}; give the path of a TOML or URDF file or an embedded \
         name (lwa4p)",
        path.display()
    )]
    Read {
        /// The requested name or path.
        path: PathBuf,
        /// The error of the operating system.
        source: std::io::Error,
    },
    /// The file is a xacro file, from which a URDF is made.
    #[error(
        "robot `{}` is a xacro file, from which a URDF is made; make it first: xacro {} > {}",
        path.display(), path.display(), urdf.display()
    )]
    Xacro {
        /// The requested path.
        path: PathBuf,
        /// The path that the URDF might have.
        urdf: PathBuf,
    },
    /// The text is not TOML or XML, or a field is missing; the parser's message names line, column
    /// and field.
    #[error(
        "{origin}: {}\ncorrect the text; docs/robot.md describes the format",
        message.trim_end()
    )]
    Syntax {
        /// The file that the text came from, or its name.
        origin: String,
        /// The parser's message.
        message: String,
    },
    /// A value describes no robot.
    #[error("{origin}: {place}{problem}; {remedy}")]
    Invalid {
        /// The file and line that the value came from, or the name of its text.
        origin: String,
        /// The joint, as "joint `name`: ", or empty for the robot as a whole.
        place: String,
        /// The value and the limit that it violates.
        problem: String,
        /// The remedy.
        remedy: String,
    },
    /// The mass matrix is not positive definite: torque on a joint would accelerate it backward.
    #[error(
        "robot `{robot}`: joint `{joint}` has the articulated inertia {pivot:.3e} {} at \
         q = {q:.4?} {}, but it must be positive; correct its inertial parameters or the \
         parameters of later links, or add the motor's armature",
        kind.inertia_unit().replace("^2", "²"),
        JointKind::column(kinds, JointKind::position_unit).list()
    )]
    NotPhysical {
        /// The robot's name.
        robot: String,
        /// The joint nearest the tip whose pivot is not positive.
        joint: String,
        /// The kind of this joint.
        kind: JointKind,
        /// The pivot of this joint \[kg m²; kg for a prismatic joint\].
        pivot: f64,
        /// The position \[rad; m\].
        q: Box<[f64]>,
        /// The kinds of all joints.
        kinds: Box<[JointKind]>,
    },
    /// A setting is outside its range.
    #[error("{setting} = {value} {problem}; give {range}")]
    Setting {
        /// Name of the setting.
        setting: &'static str,
        /// Its value, with its unit.
        value: String,
        /// The problem.
        problem: &'static str,
        /// The values that are allowed.
        range: String,
    },
    /// A text does not describe a locked joint.
    #[error(
        "\"{text}\" locks no joint; give JOINT=VALUE, the name of a joint and its position in rad, \
         or in m for a prismatic joint"
    )]
    NotALock {
        /// The text.
        text: String,
    },
}

reachtube_files::kinds!(RobotError {
    Setting | NotALock => Setting,
    _ => Robot,
});
