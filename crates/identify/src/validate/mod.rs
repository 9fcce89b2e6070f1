//! Validation of a robot on recordings that it was not fitted to.
//!
//! Torque is predicted from the recorded motion, and motion is simulated from the recorded torque.

pub(crate) mod simulation;
pub(crate) mod torque;

pub use simulation::WindowErrors;
pub use torque::{JointError, LogValidation, TorqueTrace};
