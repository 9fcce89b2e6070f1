//! Links that can physically exist.
//!
//! Ten inertial parameters are physically consistent if some distribution of positive mass has
//! them. [`pseudo_inertia`] maps them to a matrix that is positive definite exactly then, and
//! [`BodyProgram`] finds the physically consistent links nearest to the data.

mod newton;
pub(crate) mod program;
pub(crate) mod pseudo_inertia;
mod rising;

pub use program::{BodyProgram, BodySolution, PositiveColumn};
pub use pseudo_inertia::{PER_LINK, pseudo_inertia};
pub use rising::RisingFriction;
