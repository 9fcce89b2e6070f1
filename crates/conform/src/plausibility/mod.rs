//! Whether an answer is plausible: sets beside the recorded motion and torque, and the most likely
//! causes of implausible ones. `result/findings/plausibility.rs` words what is found.

pub(crate) mod cause;
mod causes;
mod friction;
mod nominal_fit;
mod usefulness;
pub(crate) mod warning;
mod warnings;

pub(crate) use friction::friction_warning;
pub(crate) use nominal_fit::NominalFit;
pub use usefulness::{JointWidth, Usefulness};
pub(crate) use usefulness::{Vacuity, VacuousSet};
pub use warning::{Warning, WarningKind};
pub(crate) use warnings::warnings;
