//! Least squares over many rows.
//!
//! `TriangularFactor` condenses any number of rows to a triangular matrix, and factors of parts are
//! joined. `Solution` holds the parameters with their covariance and names the parameters that the
//! rows do not determine. Residuals give the weights of a robust fit and the number of independent
//! samples.

mod reflections;
pub(crate) mod residuals;
pub(crate) mod singular;
pub(crate) mod solution;
pub(crate) mod triangular_factor;
