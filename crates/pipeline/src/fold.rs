use reachtube_identify::prepare::PreparedLog;
use reachtube_robot::Robot;

/// A robot that was identified without some motions, and all recordings prepared for it.
pub(crate) struct Fold {
    /// The motions.
    pub motions: Vec<String>,
    /// The robot.
    pub robot: Robot,
    /// The recordings.
    pub logs: Vec<PreparedLog>,
}
