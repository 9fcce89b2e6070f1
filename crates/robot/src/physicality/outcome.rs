//! The outcome of a check for physicality.

/// The evidence that the mass matrix M_m(q) is positive definite.
#[derive(Clone, Debug, PartialEq)]
pub enum Physicality {
    /// A proof for every position by interval arithmetic: each link's pseudo-inertia is positive
    /// semidefinite, and the own inertia of each joint is positive.
    Links {
        /// Lower bound of all pivots at all positions \[kg m²; kg for prismatic joints\].
        least_pivot: f64,
    },
    /// A search without a proof: no violation was found among the sampled positions.
    Searched {
        /// Number of positions, including the positions of the descents.
        positions: usize,
        /// Index of the joint with the smallest pivot.
        joint: usize,
        /// The smallest pivot \[kg m²; kg\].
        pivot: f64,
        /// The position with that pivot \[rad; m\].
        q: Vec<f64>,
    },
}
