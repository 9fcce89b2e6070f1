//! Gains κ from the radius of the input set to the radius of the reachable set.

pub(crate) mod disturbance;
pub(crate) mod measurable;
pub(crate) mod sampled;
pub(crate) mod taylor_series;

pub use disturbance::Disturbance;
