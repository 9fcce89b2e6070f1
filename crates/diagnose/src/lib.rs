//! What recordings of a robot may mean instead of what was stated.
//!
//! A [`Hypothesis`] says what is wrong, in words and as a [`Change`] of how each number is read. It
//! is named only if the torques are explained much better under it:
//!
//! - [`RobotMisfit`] compares the recorded input with the one that a known robot needs.
//! - [`FreeMisfit`] leaves the robot's parameters free.
//! - [`Described`] compares recorded torques with the ones that a description needs: whether they
//!   contain gravity, along which direction, and in which unit. Each [`Contradiction`] has its
//!   number and remedy.
//!
//! [`torque_lag`] finds by how much torques come later than the motion that they belong to,
//! [`payload`] the body at the last link that a recording shows, and [`wrong_samples`] samples that
//! cannot be right whatever the robot is.
//!
//! [`Agreement`] is the measure of how recorded torques follow the ones that a robot needs, and
//! [`input`] what recorded torques mean for a robot.

mod agreement;
mod axes;
mod change;
mod contradiction;
mod described;
mod described_units;
mod free_misfit;
mod hypothesis;
mod late;
mod likeliest;
mod moments;
mod needed;
mod payload;
mod reading;
mod robot_misfit;
mod samples;
mod signals;

pub use agreement::{Agreement, median};
pub use axes::{axes, input};
pub use change::Change;
pub use contradiction::Contradiction;
pub use described::Described;
pub use free_misfit::FreeMisfit;
pub use hypothesis::{Columns, Hypothesis};
pub use late::{remaining_lag, torque_lag};
pub use needed::NeededTorques;
pub use payload::{ShownPayload, payload};
pub use reading::gains;
pub use robot_misfit::RobotMisfit;
pub use samples::{WrongSamples, wrong_samples};
pub use signals::Signals;
