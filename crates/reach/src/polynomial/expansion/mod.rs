//! The exact expansion of a polynomial in states, inputs, sines and cosines about a moving point.

pub(crate) mod angles;
pub(crate) mod monomials;
pub(crate) mod operations;
pub(crate) mod power_table;
pub(crate) mod recentred;
pub(crate) mod sine_bounds;
pub(crate) mod univariate;
pub(crate) mod vertex_bound;
