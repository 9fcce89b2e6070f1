//! Plausibility of an identification: wrong signs and gains contradict the dynamics of rigid
//! bodies.

pub(crate) mod compensated;
pub(crate) mod gain;
pub(crate) mod implausible;
pub(crate) mod offset;
mod scale;
pub(crate) mod validation;
pub(crate) mod warnings;

pub use gain::Gain;
pub use implausible::Implausible;
pub use offset::PositionOffset;
