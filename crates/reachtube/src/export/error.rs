//! Errors of exports.

use super::{InputForm, Tool};

/// The reason why a model or robot cannot be written for another tool.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ExportError {
    /// The model's reachable sets could not be computed.
    #[error(transparent)]
    Conform(#[from] reachtube_conform::Error),
    /// The tool takes affine systems only.
    #[error(
        "{tool} takes affine systems only, but {model} has terms of degree {degree}; export it to \
         cora, flowstar or spaceex, or find sets for model 1 of order 1"
    )]
    NotAffine {
        /// The tool.
        tool: Tool,
        /// The model, in words.
        model: String,
        /// Its degree in states and inputs together.
        degree: u32,
    },
    /// The tool has no disturbance for polynomial systems.
    #[error(
        "{tool} has no input that changes with time for systems such as {model}, so that its set \
         would prove nothing; export it to cora or flowstar, or find sets for model 1 of order 1"
    )]
    NoDisturbance {
        /// The tool.
        tool: Tool,
        /// The model, in words.
        model: String,
    },
    /// Deviations from a nominal motion have no equation of their own.
    #[error(
        "--input deviation needs an affine model: the deviations of {model} from its nominal \
         motion have no equation of their own; use --input {remedy}"
    )]
    DeviationOfPolynomial {
        /// The model, in words.
        model: String,
        /// The form that the tool takes.
        remedy: InputForm,
    },
    /// The tool has no input that changes with time.
    #[error("{tool} has no input that changes at given times; use --input {remedy}")]
    RecordedInput {
        /// The tool.
        tool: Tool,
        /// The form that the tool takes.
        remedy: InputForm,
    },
    /// The tool has one fixed step, and the samples have not.
    #[error(
        "{tool} has one fixed step, but the samples of {case} are not equally spaced; record at a \
         fixed rate, or export to {remedy}"
    )]
    NotUniform {
        /// The tool.
        tool: Tool,
        /// The suite or run.
        case: String,
        /// The tool that takes such samples.
        remedy: &'static str,
    },
    /// A suite has no time between two samples.
    #[error("{case} has a single sample, so nothing moves; give recordings of two or more samples")]
    NoTime {
        /// The suite or run.
        case: String,
    },
    /// A robot, a file or a setting that the tool cannot have.
    #[error("{place}: {problem}; {remedy}")]
    Refused {
        /// The file, line and key, or the robot and joint.
        place: String,
        /// The problem.
        problem: String,
        /// The remedy.
        remedy: String,
    },
    /// A reachable set could not be followed to the end of its motion.
    #[error(
        "{case}: the reachable set ends at {time} s, before the motion; --until uses only the \
         samples before"
    )]
    EndsEarly {
        /// The suite or run.
        case: String,
        /// The last time of the set, s.
        time: f64,
    },
    /// Simulators have one set of masses, for weight and inertia.
    #[error(
        "robot {robot} has masses of its own for gravity, which neither MJCF nor URDF can express; \
         identify it with one set of masses (model.physical = true in the settings of identify)"
    )]
    SeparateGravity {
        /// The robot.
        robot: String,
    },
    /// A link is no body, and no bodies with the robot's torques were found.
    #[error(
        "robot {robot}: the link of {joint} has a mass or inertia that no body has, no bodies with \
         the robot's torques were found, and simulators refuse anything else; identify the robot \
         with physical links (model.physical = true in the settings of identify)"
    )]
    NotPhysical {
        /// The robot.
        robot: String,
        /// The joint that moves the link.
        joint: String,
    },
    /// A model of an arm under its controller is of another arm.
    #[error(transparent)]
    Tracking(#[from] reachtube_tracking::Error),
    /// The capsules of a robot's links cannot be read.
    #[error(transparent)]
    Verify(#[from] reachtube_verify::Error),
    /// A URDF cannot be read or written.
    #[error(transparent)]
    Robot(#[from] reachtube_robot::RobotError),
    /// A URDF that was to be updated describes another arm.
    #[error(
        "{path}: with the inertia of robot {robot} its torques differ by {error:.1e} of the \
         largest, so its links lie elsewhere; name the URDF that the robot was identified with"
    )]
    OtherGeometry {
        /// The robot.
        robot: String,
        /// The URDF file.
        path: String,
        /// The largest difference of torques, relative to the largest torque.
        error: f64,
    },
    /// A written URDF is not read back.
    #[error(
        "robot {robot}: its URDF is not read back; give each joint a name of its own without \
         control characters"
    )]
    Unreadable {
        /// The robot.
        robot: String,
    },
}

reachtube_files::kinds!(ExportError {
    [Conform | Robot | Verify | Tracking] => inner,
    SeparateGravity | NotPhysical | Unreadable => Robot,
    EndsEarly | NoTime | NotUniform => Recordings,
    _ => Setting,
});
