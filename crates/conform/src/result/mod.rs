//! An answer for people and programs: findings, their words, and the report of them.

mod check_report;
mod check_summary;
pub(crate) mod code;
mod dependence_report;
pub(crate) mod findings;
mod fit_report;
mod model_report;
mod model_summary;
