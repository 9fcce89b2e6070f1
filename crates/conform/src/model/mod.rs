//! The model file.

mod candidates;
mod compared;
pub(crate) mod file;
mod fitted;
mod logs;
pub(crate) mod other_data;
pub(crate) mod provenance;
mod reach_record;
pub(crate) mod records;
mod usefulness;
mod validity;

pub use crate::search::found::SearchSummary;
pub use file::{Loader, Model};
pub use provenance::Provenance;
pub use records::{DataRecord, LogRecord, RunRecord, SuiteRecord};
