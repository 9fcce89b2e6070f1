use std::path::PathBuf;

/// Why a robot could not be made.
#[derive(Debug, thiserror::Error)]
pub enum RobotError {
    /// No embedded robot has this name and no file could be read.
    #[error("cannot read robot `{}`: {source}; give the path of a TOML or URDF file or an embedded name (lwa4p)", path.display())]
    Read {
        /// The name or path that was asked for.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// The text is not TOML or XML, or lacks a field; the parser's message names line, column and
    /// field.
    #[error("{origin}: {}\ncorrect it; docs/robot.md describes the format", message.trim_end())]
    Syntax {
        /// File or name the text came from.
        origin: String,
        /// The parser's message.
        message: String,
    },
    /// A value makes no robot.
    #[error("{origin}: {place}{problem}; {remedy}")]
    Invalid {
        /// File and line, or name, the value came from.
        origin: String,
        /// The joint, as "joint `name`: ", or nothing for the robot as a whole.
        place: String,
        /// The value and the limit it breaks.
        problem: String,
        /// What to do.
        remedy: String,
    },
    /// The mass matrix is not positive definite: torque on a joint would accelerate it backward.
    #[error(
        "robot `{robot}`: joint `{joint}` has the articulated inertia {pivot:.3e} kg m² at q = {q:.4?} rad, where a body's \
         is positive; correct its inertial parameters or add the motor's armature"
    )]
    NotPhysical {
        /// The robot's name.
        robot: String,
        /// The joint nearest the tip whose pivot is not positive.
        joint: String,
        /// That pivot \[kg m²\].
        pivot: f64,
        /// The position \[rad\].
        q: Vec<f64>,
    },
    /// A setting that allows no answer; the message names setting, value and remedy.
    #[error("{0}")]
    Setting(String),
}
