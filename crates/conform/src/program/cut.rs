//! Rows of the program in directions other than the states.

/// A row of the program in any direction l of the states:
/// lᵀ E_k c + a(l) r + |l| r_v >= lᵀ d for the point d that is furthest along l.
#[derive(Debug, Clone)]
pub(crate) struct Cut {
    /// lᵀ E_k, 3n.
    pub centre: Vec<f64>,
    /// a(l) = (|lᵀ e^{A t_k}|, κ(l, t_k)), 3n.
    pub radius: Vec<f64>,
    /// |l|, 2n.
    pub noise: Vec<f64>,
    /// lᵀ d.
    pub bound: f64,
}
