//! Recordings folded into a state whose size does not grow with their number: parts are folded
//! apart, merged in any order and solved on one machine.

mod bytes;
mod context;
mod defects;
#[expect(clippy::module_inception, reason = "the folder and its main type share the noun")]
mod fold;
mod of_fold;
mod part_points;
mod stored;
mod suite_fold;
mod whole_runs;

pub use fold::Fold;
pub use of_fold::OnDefect;
pub use part_points::{FleetProblem, PartPoints, PartReader};
