//! Recordings of a virtual robot that differs from its nominal model, to try everything on; they
//! take a second or two to make.
//!
//! The experiment is that of Sec. V-B of the paper:
//!
//! - Random point-to-point motions are planned, and the input u of eq. (11) along each motion is
//!   computed from the nominal model.
//! - A run starts at one of several points of the motion (Fig. 3) and applies the input open loop,
//!   with gravity and Coulomb friction of the nominal model added. It therefore drifts off (Fig.
//!   2).
//! - Friction of the virtual robot depends on temperature, and the joints warm up from run to run,
//!   as in Fig. 4.
//! - The virtual robot also has stiction, torque ripple, heavier links and motors, encoders, and
//!   scattered starts. The constants are in `demo/unmodelled.rs`, and in the README beside the
//!   recordings.

mod data_folder;
pub(crate) mod error;
mod options;
mod plan;
mod random_motion;
mod record;
mod rounding;
mod sensors;
#[cfg(test)]
mod tests;
mod unmodelled;
mod virtual_robot;

pub use error::DemoError;
pub use options::DemoOptions;
pub use record::{RecordedDemo, record};
