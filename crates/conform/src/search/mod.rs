//! The smallest sets of a model over recordings: one search for every plant and claim, or bisection
//! as a baseline.

mod bisection;
pub(crate) mod found;
pub(crate) mod optimality;
pub(crate) mod prove;
#[expect(clippy::module_inception, reason = "the folder and its main function share the noun")]
mod search;
pub(crate) mod smallest_sets;
