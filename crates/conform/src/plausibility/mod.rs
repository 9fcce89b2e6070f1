//! Whether an answer is plausible: sets beside the recorded motion and torque, and the most likely
//! causes of implausible ones.

mod causes;
mod evidence;
mod nominal_fit;
mod warnings;

pub(crate) use nominal_fit::NominalFit;
pub(crate) use warnings::warnings;
pub use warnings::{Warning, WarningKind};
