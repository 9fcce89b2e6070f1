//! Least squares over many rows: by triangular factors that are joined, robust to outliers, with
//! standard errors that know how many samples are independent.

mod residuals;
mod solution;
mod triangle;

pub use residuals::{
    huber_weight, robust_deviation, root_mean_square, samples_per_independent_one,
};
pub use solution::Solution;
pub use triangle::Triangle;
