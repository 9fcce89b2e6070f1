//! The smallest sets of a linear model: one linear program, and the repair of its answer.

pub(crate) mod block;
mod cost_of_sets;
pub(crate) mod costs;
pub(crate) mod cut;
mod cut_rows;
pub(crate) mod dot;
mod gains;
pub(crate) mod layout;
mod limits;
mod of_problem;
mod other_recordings;
pub(crate) mod paper;
#[expect(clippy::module_inception, reason = "the folder and its main type share the noun")]
pub(crate) mod program;
pub(crate) mod reached;
mod repair;
pub(crate) mod solver;
mod units;
