//! The smallest sets of the notion trace: the sets of the points, widened for motions.

use std::path::Path;

use crate::claim::claim::Claim;
use crate::claim::look::Look;
use crate::data::problem::Problem;
use crate::error::Result;
use crate::explain::trace::{TraceFactor, trace_factors};
use crate::found::Found;
use crate::progress::Progress;
use crate::search::cutting_planes;
use crate::search::smallest_sets as search;
use crate::sets::UncertaintySets;
use crate::tube::polynomial::Polynomial;

/// What the radii of U are widened by first, N m, so that doubles lie in u + U.
const LEAST_RADIUS: f64 = 1e-9;

/// What the radii of X0 are widened by, in parts of V, one number after the other while there is a
/// recording through which no motion passes. The first is the accuracy of the search. The last is
/// what covers the true start: the measured one lies in X0 + V, and is off by V itself.
const START_ROOMS: [f64; 3] = [0.05, 1.0, 2.05];

/// Finds the smallest sets of a linear model in which every recorded point lies, and widens U until
/// one motion of the model passes through all samples of each recording. A recording through which
/// none passes, however wide U is, does not count.
///
/// # Errors
///
/// As [`trace_factors`].
pub(crate) fn smallest_sets(
    problem: &Problem,
    claim: &dyn Claim,
    progress: &dyn Progress,
) -> Result<Found> {
    let widen = |sets| widened(problem, sets, progress);
    cutting_planes::smallest_sets(problem, claim, progress, widen)
}

/// Finds sets as [`smallest_sets`] does, for a model that is not linear.
///
/// # Errors
///
/// As [`search::smallest_sets`] and [`trace_factors`].
pub(crate) fn smallest_outer_sets(
    problem: &Problem,
    claim: &dyn Claim,
    progress: &dyn Progress,
    resume: Option<&Path>,
) -> Result<Found> {
    let found = search::smallest_sets(problem, claim, progress, resume)?;
    let sets = widened(problem, found.hulls.sets, progress)?;
    let hulls = claim.judge(&Polynomial(problem), &sets, &Look::proof())?;
    let (cost, hull_volume) = search::costs(problem, &hulls)?;
    Ok(Found { hulls, cost, hull_volume, ..found })
}

/// Widens X0 until a motion passes through each recording, however wide U is, or through as many
/// as possible, and then U until it does so within U.
fn widened(
    problem: &Problem,
    mut sets: UncertaintySets,
    progress: &dyn Progress,
) -> Result<UncertaintySets> {
    sets.input_set.radius.iter_mut().for_each(|radius| *radius += LEAST_RADIUS);
    let mut best: Option<(usize, UncertaintySets, Vec<TraceFactor>)> = None;
    for room in START_ROOMS {
        progress.go_on()?;
        let mut wider = sets.clone();
        for (i, radius) in wider.initial_set.radius.iter_mut().enumerate() {
            *radius += room * sets.noise_radius(i);
        }
        let factors = trace_factors(problem, &wider)?;
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
