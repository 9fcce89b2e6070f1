//! Whether an answer is plausible: sets beside the recorded motion and torque, and the most likely
//! causes of implausible ones. `result/findings/plausibility.rs` words what is found.

mod causes;
mod nominal_fit;
mod usefulness;
pub(crate) mod warning;
mod warnings;

pub(crate) use nominal_fit::NominalFit;
pub use usefulness::{JointWidth, Usefulness};
pub(crate) use usefulness::{Vacuity, VacuousSet};
pub use warning::{Remark, Warning, WarningKind};
pub(crate) use warnings::{friction_warning, warnings};
