//! What a model leaves out: a proved bound of its error over an operating box.

use serde::{Deserialize, Serialize};

/// Positions, velocities and inputs that a bound holds for, each \[low, high\], one entry a joint.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct OperatingBox {
    /// q, rad.
    pub q: Vec<[f64; 2]>,
    /// q̇, rad/s.
    pub qd: Vec<[f64; 2]>,
    /// u, N m.
    pub u: Vec<[f64; 2]>,
}

/// A bound of f(x, u) - f_p(x, u), the acceleration that a model leaves out.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Remainder {
    /// Where it holds.
    pub operating_box: OperatingBox,
    /// For each joint the acceleration left out lies in \[low, high\], rad/s²; none where no bound was found.
    pub bounds: Vec<Option<[f64; 2]>>,
    /// The largest magnitude seen at sampled states, rad/s²: no bound can be less.
    pub seen: Vec<f64>,
    /// Boxes that the operating box was cut into.
    pub boxes: usize,
}

impl Remainder {
    /// Whether its sizes are those of n joints and its box is not empty.
    pub(super) fn is_of(&self, n: usize) -> bool {
        let OperatingBox { q, qd, u } = &self.operating_box;
        let is = |ranges: &[[f64; 2]]| ranges.len() == n && ranges.iter().all(|[low, high]| low <= high);
        is(q) && is(qd) && is(u) && self.bounds.len() == n && self.seen.len() == n
    }
}
