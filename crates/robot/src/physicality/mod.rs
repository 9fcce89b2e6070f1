//! Checks whether a robot's mass matrix is positive definite, as the mass matrix of bodies is.

mod links;
pub(crate) mod outcome;
mod search;
