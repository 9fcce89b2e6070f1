//! Recordings that are motions of the model: the notion trace.

use crate::claim::claim::Claim;
use crate::claim::look::Look;
use crate::claim::points::Points;
use crate::data::problem::Problem;
use crate::error::Result;
use crate::explain::trace::{TraceFactor, trace_factors};
use crate::progress::Progress;
use crate::sets::UncertaintySets;
use crate::tube::judged::{Along, At};
use crate::tube::plant::Plant;
use crate::tube::tube::Tube;

/// What the radii of U are widened by first, N m, so that doubles lie in u + U.
const LEAST_RADIUS: f64 = 1e-9;

/// What the radii of X0 are widened by, in parts of V, one number after the other while there is a
/// recording through which no motion passes. The first is the accuracy of the search. The last is
/// what covers the true start: the measured one lies in X0 + V, and is off by V itself.
const START_ROOMS: [f64; 3] = [0.05, 1.0, 2.05];

/// Recordings whose points lie in the reachable set, and through whose samples one motion of the
/// model passes. The sets of the points are widened for the motions.
pub(crate) struct Traces<'a> {
    pub problem: &'a Problem,
    pub points: Points<'a>,
}

impl Claim for Traces<'_> {
    fn judge(&self, plant: &dyn Plant, sets: &UncertaintySets, look: &Look) -> Result<Tube> {
        self.points.judge(plant, sets, look)
    }

    fn furthest(&self, directions: &[(At, Vec<f64>)]) -> Result<Vec<Along>> {
        self.points.furthest(directions)
    }

    fn tolerance(&self) -> Option<f64> {
        self.points.tolerance()
    }

    /// Widens X0 until a motion passes through each recording, however wide U is, or through as
    /// many as possible, and then U until it does so within U. A recording through which none
    /// passes does not count.
    fn widen(&self, mut sets: UncertaintySets, progress: &dyn Progress) -> Result<UncertaintySets> {
        sets.input_set.radius.iter_mut().for_each(|radius| *radius += LEAST_RADIUS);
        let mut best: Option<(usize, UncertaintySets, Vec<TraceFactor>)> = None;
        for room in START_ROOMS {
            progress.go_on()?;
            let mut wider = sets.clone();
            for (i, radius) in wider.initial_set.radius.iter_mut().enumerate() {
                *radius += room * sets.noise_radius(i);
            }
            let factors = trace_factors(self.problem, &wider)?;
            let without = factors.iter().filter(|trace| trace.factor.is_none()).count();
            if best.as_ref().is_none_or(|(least, ..)| without < *least) {
                best = Some((without, wider, factors));
            }
            if without == 0 {
                break;
            }
        }
        let (_, sets, factors) = best.expect("there is at least one room");
        let factor = factors.iter().filter_map(|trace| trace.factor).fold(1.0, f64::max);
        progress.finished(&format!(
            "{} of {} recordings are motions of the model within V; U is widened by {factor:.3}",
            factors.iter().filter(|trace| trace.holds()).count(),
            factors.len()
        ));
        Ok(sets.with_input_scaled(factor))
    }
}
