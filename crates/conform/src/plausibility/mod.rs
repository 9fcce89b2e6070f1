//! Whether an answer can be right: sets beside the recorded motion and torque, and what most likely
//! caused those that cannot.

mod causes;
mod evidence;
mod nominal_fit;
mod warnings;

pub(crate) use nominal_fit::NominalFit;
pub(crate) use warnings::warnings;
pub use warnings::{Warning, WarningKind};
