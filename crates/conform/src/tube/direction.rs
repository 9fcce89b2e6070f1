//! A direction in which a recorded point was outside a reachable set, and its row.

use serde::{Deserialize, Serialize};

use crate::program::cut::Cut;
use crate::sets::UncertaintySets;
use crate::tube::judged::{Along, At};

/// By how much more than what is missing the set must reach, in parts of its reach.
const MARGIN: f64 = 1e-4;

/// A direction in which a recorded point was outside a reachable set.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Direction {
    pub at: At,
    /// The direction l, 2n.
    pub direction: Vec<f64>,
    /// The recorded point that is furthest along it.
    pub along: Along,
    /// max lᵀ x over the last computed set, without the noise set; 0 if the plant is exact.
    pub reach: f64,
    /// How much further that set reaches than its linearisation, once that is known.
    pub further: Option<f64>,
}

/// One row of a linearisation in any direction l: lᵀ E_k, and the gains of the radii, 3n each.
#[derive(Debug, Clone, Default)]
pub(super) struct DirectionRow {
    pub centre: Vec<f64>,
    pub radius: Vec<f64>,
}

impl Direction {
    /// Returns the row of a linearised program, for the nominal state x̂ of its sample, 2n. With x̂
    /// from the centres c of the round before, the new centres c' and radii r' must satisfy
    /// lᵀ x̂ + lᵀ E (c' - c) + a r' + further >= lᵀ x.
    pub(super) fn cut(
        &mut self,
        row: &DirectionRow,
        nominal: &[f64],
        sets: &UncertaintySets,
    ) -> Cut {
        let UncertaintySets { initial_set, input_set, .. } = sets;
        let l = &self.direction;
        let nominal = dot(l, nominal);
        let moved = dot(&row.centre, initial_set.centre.iter().chain(&input_set.centre));
        let linearised = dot(&row.radius, initial_set.radius.iter().chain(&input_set.radius));
        let further = *self.further.get_or_insert(self.reach - nominal - linearised);
        Cut {
            centre: row.centre.clone(),
            radius: row.radius.clone(),
            noise: l.iter().map(|l| l.abs()).collect(),
            bound: self.along.value - nominal + moved - further + MARGIN * linearised,
        }
    }
}

fn dot<'a>(x: &[f64], y: impl IntoIterator<Item = &'a f64>) -> f64 {
    x.iter().zip(y).map(|(x, y)| x * y).sum()
}
