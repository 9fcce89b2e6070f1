//! Whether an answer is plausible: sets beside the recorded motion and torque, and the most likely
//! causes of implausible ones. `result/findings/plausibility.rs` words what is found.

mod causes;
mod nominal_fit;
pub(crate) mod remark;
mod usefulness;
mod warnings;

pub(crate) use nominal_fit::NominalFit;
pub use remark::Remark;
pub use usefulness::{PartWidth, Usefulness};
pub(crate) use usefulness::{Vacuity, VacuousSet};
pub(crate) use warnings::{friction_warning, warnings};
