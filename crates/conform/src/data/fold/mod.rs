//! Recordings folded into a state whose size does not grow with their number: parts are folded
//! apart, merged in any order and solved on one machine.

mod bytes;
pub(crate) mod context;
mod defects;
#[expect(clippy::module_inception, reason = "the folder and its main type share the noun")]
pub(crate) mod fold;
pub(crate) mod of_fold;
mod suite_fold;
mod whole_runs;
