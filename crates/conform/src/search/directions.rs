//! Rows of the program in directions in which recorded points were outside the computed sets.

use serde::{Deserialize, Serialize};

use crate::flowpipes::OuterSet;
use crate::linear::cut::Cut;
use crate::notion::outer::Asked;
use crate::search::sensitivity::Sensitivity;
use crate::sets::UncertaintySets;

/// By how much more than what is missing the set must reach, in parts of its reach.
const MARGIN: f64 = 1e-4;

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
    reach: f64,
    /// How much further that set reaches than its linearisation, once that is known.
    further: Option<f64>,
}

/// One row of the linearisation in any direction l: lᵀ E_k, and the gains of the radii, 3n each.
#[derive(Debug, Clone, Default)]
pub(super) struct DirectionRow {
    pub centre: Vec<f64>,
    pub radius: Vec<f64>,
}

/// Returns the directions of one case, to be asked of its computed sets, and their indices.
pub(super) fn of_case(directions: &[Direction], case: usize) -> (Vec<usize>, Vec<Asked<'_>>) {
    let mine = directions.iter().enumerate().filter(|(_, known)| known.case == case);
    mine.map(|(index, known)| (index, Asked { sample: known.sample, direction: &known.direction }))
        .unzip()
}

/// Takes how far the computed sets of all cases reach, and adds the directions in which points are
/// outside. Returns whether there are any.
pub(super) fn take(directions: &mut Vec<Direction>, sets: &[OuterSet]) -> bool {
    let known = directions.len();
    for (case, set) in sets.iter().enumerate() {
        let (indices, _) = of_case(&directions[..known], case);
        for (index, reach) in &set.points.reaches {
            let direction = &mut directions[indices[*index]];
            (direction.reach, direction.further) = (*reach, None);
        }
        directions.extend(set.points.furthest.iter().map(|point| Direction {
            case,
            sample: point.sample,
            run: point.bound_run,
            direction: point.direction.clone(),
            bound: point.bound,
            reach: point.reach,
            further: None,
        }));
    }
    directions.len() > known
}

impl Direction {
    /// Returns the row of the program. With x̂ the motion from the centres c of the round before,
    /// the new centres c' and radii r' must satisfy
    /// lᵀ x̂ + lᵀ E (c' - c) + a r' + further >= lᵀ x.
    pub(super) fn cut(
        &mut self,
        row: &DirectionRow,
        sensitivity: &Sensitivity,
        sets: &UncertaintySets,
    ) -> Cut {
        let UncertaintySets { initial_set, input_set, .. } = sets;
        let l = &self.direction;
        let nominal = dot(l, &sensitivity.nominal[self.sample * l.len()..]);
        let moved = dot(&row.centre, initial_set.centre.iter().chain(&input_set.centre));
        let linearised = dot(&row.radius, initial_set.radius.iter().chain(&input_set.radius));
        let further = *self.further.get_or_insert(self.reach - nominal - linearised);
        Cut {
            centre: row.centre.clone(),
            radius: row.radius.clone(),
            noise: l.iter().map(|l| l.abs()).collect(),
            bound: self.bound - nominal + moved - further + MARGIN * linearised,
        }
    }
}

fn dot<'a>(x: &[f64], y: impl IntoIterator<Item = &'a f64>) -> f64 {
    x.iter().zip(y).map(|(x, y)| x * y).sum()
}
