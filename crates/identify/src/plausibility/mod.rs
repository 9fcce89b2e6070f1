//! Plausibility of an identification: wrong signs and gains contradict the dynamics of rigid
//! bodies.

pub(crate) mod gain;
mod sign;
pub(crate) mod warnings;

pub use gain::Gain;
