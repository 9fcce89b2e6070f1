//! The model file.

mod compared;
pub(crate) mod file;
pub(crate) mod records;
mod validity;

pub use file::{FORMAT, MOST_TIGHT, Model, VERSION};
pub use records::{DataRecord, Explained, Residual, RunRecord, SuiteRecord};
