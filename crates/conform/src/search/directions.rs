//! Rows of the program in directions in which recorded points were outside the computed sets.

use crate::linear::cut::Cut;
use crate::search::direction::{Direction, DirectionRow};
use crate::search::sensitivity::Sensitivity;
use crate::sets::UncertaintySets;
use crate::tube::judged::{Along, At, Judged};

/// By how much more than what is missing the set must reach, in parts of its reach.
const MARGIN: f64 = 1e-4;

/// Returns the directions, to be asked of the computed sets.
pub(super) fn asked(directions: &[Direction]) -> Vec<(At, Vec<f64>)> {
    directions.iter().map(|known| (known.at(), known.direction.clone())).collect()
}

/// Takes how far the computed sets reach, and adds the directions in which points are outside, with
/// the points `along` that are furthest along them.
pub(super) fn take(directions: &mut Vec<Direction>, judged: &Judged, along: Vec<Along>) {
    for (index, reach) in &judged.reaches {
        let direction = &mut directions[*index];
        (direction.reach, direction.further) = (*reach, None);
    }
    let new =
        judged.furthest.iter().zip(along).map(|((((case, sample), _), point), along)| Direction {
            case: *case as usize,
            sample: *sample as usize,
            run: along.owner.1 as usize,
            direction: point.direction.clone(),
            bound: along.value,
            reach: point.reach.unwrap_or_default(),
            further: None,
        });
    directions.extend(new);
}

impl Direction {
    /// Returns case and sample.
    pub(super) fn at(&self) -> At {
        (self.case as u32, self.sample as u32)
    }

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
