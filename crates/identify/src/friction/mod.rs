//! Friction (5) to (9) of each joint, with the gravity torque as its load.
//!
//! [`fit`](fn@fit) fits Coulomb and viscous friction to the samples of one joint. [`CoulombForm`]
//! is the dependence of Coulomb friction on the load that these samples determine.

pub(crate) mod fit;
mod form;
pub(crate) mod joints;
mod model;
mod sample;
mod stribeck;

pub use fit::{FrictionFit, JointFriction, fit, fit_with_stribeck};
pub use form::CoulombForm;
pub use sample::FrictionSample;
pub use stribeck::StribeckTrial;
