//! An answer for people and programs: findings, their words, and the report of them.

mod check_report;
pub(crate) mod code;
mod dependence_report;
pub(crate) mod finding;
mod findings;
mod fit_report;
pub(crate) mod front_end;
mod model_report;
pub(crate) mod remedy;
pub(crate) mod report;
pub(crate) mod table;
