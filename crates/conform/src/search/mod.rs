//! The smallest sets of a model that is not linear: successive linearisation, or bisection as a
//! baseline.

mod bisection;
pub(crate) mod cutting_planes;
mod direction;
mod directions;
mod journal;
pub(crate) mod sensitivity;
pub(crate) mod smallest_sets;
mod state;
mod successive;
pub(crate) mod traces;
mod worst_case;
