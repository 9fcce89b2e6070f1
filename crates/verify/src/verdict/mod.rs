//! Whether the links stay clear of the obstacles.

pub(crate) mod clearance;
pub(crate) mod decide;
pub(crate) mod findings;
mod gradient;
mod part_of_step;
pub(crate) mod planned;
mod question;
pub(crate) mod stop_verdict;
mod stop_witness;
mod stopped;
pub(crate) mod stops;
pub(crate) mod verification;
pub(crate) mod witness;
