//! Errors of the virtual robot.

/// The reason why a virtual robot could not move.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum VirtualRobotError {
    /// A parameter is outside its range.
    #[error("virtual robot: {name} = {given} is outside [{low:e}, {high:e}]; give a value inside")]
    Parameter {
        /// The parameter.
        name: &'static str,
        /// The value given.
        given: f64,
        /// The least value.
        low: f64,
        /// The largest value.
        high: f64,
    },
    /// The simulation diverged.
    #[error(
        "virtual robot: the simulation of {recording} of {robot} diverged; the robot's inertias \
         are too small for its friction and controller, or not physical: use lwa4p"
    )]
    Diverged {
        /// The recording.
        recording: String,
        /// The robot's name.
        robot: String,
    },
}
