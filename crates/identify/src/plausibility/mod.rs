//! Plausibility of an identification: wrong signs and gains, found from what rigid bodies cannot do.

pub(crate) mod gain;
mod sign;
pub(crate) mod warnings;

pub use gain::Gain;
