use super::settings::ColumnSettings;
use crate::axis::Axis;
use crate::gap_limit::GapLimit;

/// What is read of logs besides positions.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Wanted {
    /// Torques; a log without them is refused.
    Torques,
    /// Torques of logs that have them.
    AnyTorques,
    /// Commanded positions, and no torque; a log without them is refused.
    Commands,
    /// Nothing: the positions are a plan's. Commanded positions count before others.
    Plan,
}

impl Wanted {
    pub(super) fn has_torques(self) -> bool {
        matches!(self, Self::Torques | Self::AnyTorques)
    }
}

/// How logs are read.
#[derive(Debug, Clone, Copy)]
pub struct LoggedOptions<'a> {
    /// The robot's joints, which the columns are matched with. Without them, the positions of a log
    /// are its joints.
    pub robot: Option<&'a [Axis]>,
    /// Names of the robot's joints in the order of numbered columns, or the log's names in the
    /// order of the robot; empty for the robot's names and order. Without a robot, the joints that
    /// are read, in their order; empty for all.
    pub joints: &'a [String],
    /// Names and units of columns that the user gives.
    pub columns: &'a ColumnSettings,
    /// Whether gains turn motor currents into torques.
    pub gains: bool,
    /// What is read besides positions.
    pub wanted: Wanted,
    /// Longest time between two samples that is accepted.
    pub gap_limit: GapLimit,
    /// Time after the first sample beyond which samples are not used, s.
    pub until: Option<f64>,
}
