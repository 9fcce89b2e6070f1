//! The matrix exponential e^{A t_k} at the samples of a grid.

pub(crate) mod block;
pub(crate) mod powers;
pub(crate) mod samples;
