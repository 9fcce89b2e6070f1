//! Exciting motions, whose torque identifies the parameters of a robot well.

pub(crate) mod evaluation;
mod evolution;
pub(crate) mod fourier;
pub(crate) mod optimise;
mod search_space;
pub(crate) mod settings;
