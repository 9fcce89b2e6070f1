//! An answer for people and programs: findings, their words, and the report of them.

mod check_report;
mod check_summary;
pub(crate) mod code;
mod dependence_report;
pub(crate) mod finding;
mod findings;
mod fit_report;
pub(crate) mod front_end;
mod model_report;
mod model_summary;
pub(crate) mod remedy;
pub(crate) mod report;
pub(crate) mod summary;
pub(crate) mod table;

pub use crate::advice::Advice;
pub use crate::search::found::SearchSummary;
pub use code::Code;
pub use finding::Severity;
pub use front_end::{FrontEnd, Setting};
pub use remedy::Remedy;
pub use report::{Report, Section};
pub use summary::Summary;
pub use table::Table;
