//! Whether the links stay clear of the obstacles.

pub(crate) mod clearance;
pub(crate) mod decide;
mod gradient;
mod part_of_step;
mod stopped;
pub(crate) mod stops;
pub(crate) mod verification;
pub(crate) mod witness;
