//! Motions of a model that come close to recordings: what could have happened in a run.

mod chain;
mod closest_motion;
pub(crate) mod explanation;
mod regulate;
mod steps;
#[cfg(test)]
mod tests;
pub(crate) mod trace;

pub use explanation::Explanation;
pub use trace::TraceVerdict;
