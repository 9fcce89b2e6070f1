//! A direction of the states, and its row.

use serde::{Deserialize, Serialize};

/// A direction in which a recorded point was outside a computed set.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Direction {
    pub case: usize,
    pub sample: usize,
    /// The run (index in the source) whose point is furthest.
    pub run: usize,
    /// The direction l, 2n.
    pub direction: Vec<f64>,
    /// max lᵀ x over the recorded points.
    pub bound: f64,
    /// max lᵀ x over the last computed set, without the noise set.
    pub reach: f64,
    /// How much further that set reaches than its linearisation, once that is known.
    pub further: Option<f64>,
}

/// One row of the linearisation in any direction l: lᵀ E_k, and the gains of the radii, 3n each.
#[derive(Debug, Clone, Default)]
pub(super) struct DirectionRow {
    pub centre: Vec<f64>,
    pub radius: Vec<f64>,
}
