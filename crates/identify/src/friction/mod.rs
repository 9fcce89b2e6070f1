//! Friction (5) to (9) of each joint, with the gravity torque as its load.
//!
//! `fit` fits Coulomb and viscous friction to the samples of one joint. `CoulombForm`
//! is the dependence of Coulomb friction on the load that these samples determine. `falling` keeps
//! viscous friction from falling with speed.

pub(crate) mod falling;
pub(crate) mod fit;
pub(crate) mod form;
pub(crate) mod joints;
pub(crate) mod sample;
