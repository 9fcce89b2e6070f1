//! The model file.

mod compared;
pub(crate) mod file;
mod reach_record;
pub(crate) mod records;
mod usefulness;
mod validity;

pub use file::Model;
pub use records::{DataRecord, Explained, Residual, RunRecord, SuiteRecord};
