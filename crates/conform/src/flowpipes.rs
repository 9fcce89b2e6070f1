//! Outer enclosures of the reachable sets of models that are not linear.

use reachtube_reach::{Flowpipe, FlowpipeSettings, PolynomialSystem, UncertainInput};

use crate::error::Result;
use crate::problem::case::Case;
use crate::problem::problem::Problem;
use crate::rows::rows;
use crate::sets::UncertaintySets;

/// Variables over whose vertices remainders are bounded, one number after the other while a set is
/// lost: with 14 a step takes four times as long as with 8, with 18 a hundred times.
const VERTEX_VARIABLES: [usize; 3] = [8, 14, 18];

/// How hard to try where a set is lost.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Effort {
    /// Once: for candidates.
    Quick,
    /// With tighter and tighter remainders: for the verdict.
    Whole,
}

/// Computes the flowpipe of a case under `sets`; of several attempts the one that comes furthest.
///
/// # Guarantee
///
/// Outer, as [`Flowpipe`], for every measurable disturbance with values in U.
///
/// # Errors
///
/// When sizes do not fit.
pub fn flowpipe(
    system: &PolynomialSystem,
    case: &Case,
    sets: &UncertaintySets,
    effort: Effort,
) -> Result<Flowpipe> {
    let (start, input) =
        (case.start.clone(), UncertainInput { measured: &case.inputs, set: &sets.input_set });
    let with = |vertex_variables: usize| {
        let settings = FlowpipeSettings { vertex_variables, ..FlowpipeSettings::default() };
        Flowpipe::new(system, &case.grid, &start, &sets.initial_set, &input, &settings)
    };
    let mut furthest = with(VERTEX_VARIABLES[0])?;
    for vertex_variables in &VERTEX_VARIABLES[1..] {
        if furthest.is_reached() || effort == Effort::Quick {
            break;
        }
        let tighter = with(*vertex_variables)?;
        if tighter.len() > furthest.len() {
            furthest = tighter;
        }
    }
    Ok(furthest)
}

/// How recordings lie to a computed reachable set.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Enclosed {
    /// All rows hold.
    Yes,
    /// The set was followed to the end, and a row does not hold.
    No,
    /// The set was lost before the end.
    Lost,
}

/// Returns whether the flowpipe of a case under `sets` encloses its recordings.
///
/// # Errors
///
/// As [`flowpipe`].
pub fn enclosed(
    problem: &Problem,
    case: &Case,
    sets: &UncertaintySets,
    effort: Effort,
) -> Result<Enclosed> {
    let flowpipe = flowpipe(problem.dynamics().polynomial_system()?, case, sets, effort)?;
    if !flowpipe.is_reached() {
        return Ok(Enclosed::Lost);
    }
    let mut all = true;
    let states = problem.settings().states;
    rows(&case.measured, case.grid.times(), &flowpipe, sets, states, |row| all &= row.holds());
    Ok(if all { Enclosed::Yes } else { Enclosed::No })
}
