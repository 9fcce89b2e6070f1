//! A virtual robot for whole experiments: an arm that differs from its nominal model as the
//! paper's robot did, with its sensors and controllers.
//!
//! The arm has the four-quadrant friction of the nominal model with stiction and the Stribeck
//! effect. Its joints warm up by friction work, and friction falls with their temperature. Links
//! and motors are heavier than nominal, the last link carries an unknown payload, and the motor
//! torque has a ripple. Encoders quantise positions, velocities are filtered, and the torque acts
//! later than commanded. Every effect is a parameter of [`VirtualRobotParameters`].
//!
//! Computed-torque control with the nominal model drives the arm along a motion, and the torque is
//! recorded. A run of a test suite follows the motion to one of its points and continues open loop
//! from there, with the recorded torque (Sec. V-B of the paper).
//!
//! The simulation uses additions, multiplications, divisions and the elementary functions of the
//! crate `libm` only, and rounds what it records. The same seed therefore gives the same bits on
//! every platform.

mod arm;
mod controller;
mod elementary;
#[cfg(test)]
mod fault_tests;
mod friction;
mod parameters;
mod plant;
mod recording;
mod rounding;
mod sensors;
mod suite;
#[cfg(test)]
mod tests;
mod truth;

pub(crate) use arm::{Arm, Logged};
pub use parameters::VirtualRobotParameters;
pub(crate) use recording::Recording;
pub(crate) use suite::{PreRecorded, Scatter, SuiteRuns, record_suite};
pub(crate) use truth::VirtualRobot;
