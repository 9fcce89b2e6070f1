//! Outer enclosures of the reachable sets of models that are not linear.

use reachtube_reach::{Flowpipe, FlowpipeSettings, PolynomialSystem, UncertainInput, Visit};

use crate::data::case::Case;
use crate::data::problem::Problem;
use crate::error::Result;
use crate::sets::UncertaintySets;
use crate::tube::rows::{RecordedBounds, Row, rows};
use crate::tube::strand::Strand;

/// Variables over whose vertices remainders are bounded, one number after the other while a set is
/// lost: with 14 a step takes four times as long as with 8, with 18 a hundred times.
const VERTEX_VARIABLES: [usize; 3] = [8, 14, 18];

/// Effort after a set is lost.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Effort {
    /// Once: for candidates.
    Quick,
    /// With tighter and tighter remainders: for the verdict.
    Whole,
}

/// Attempts a flowpipe with more and more variables over whose vertices remainders are bounded, and
/// returns the attempt that came furthest.
pub(crate) fn furthest<T>(
    effort: Effort,
    attempt: impl Fn(usize) -> Result<T>,
    flowpipe: impl Fn(&T) -> &Flowpipe,
) -> Result<T> {
    let mut furthest = attempt(VERTEX_VARIABLES[0])?;
    for vertex_variables in &VERTEX_VARIABLES[1..] {
        if flowpipe(&furthest).is_reached() || effort == Effort::Quick {
            break;
        }
        let tighter = attempt(*vertex_variables)?;
        if flowpipe(&tighter).len() > flowpipe(&furthest).len() {
            furthest = tighter;
        }
    }
    Ok(furthest)
}

pub(crate) fn attempt(
    system: &PolynomialSystem,
    case: &Case,
    sets: &UncertaintySets,
    vertex_variables: usize,
    visit: Option<Visit>,
) -> Result<Flowpipe> {
    let (start, input) =
        (&case.start, UncertainInput { measured: &case.inputs, set: &sets.input_set });
    let settings = FlowpipeSettings { vertex_variables, ..FlowpipeSettings::default() };
    let Case { grid, .. } = case;
    Ok(Flowpipe::visiting(system, grid, start, &sets.initial_set, &input, &settings, visit)?)
}

/// How recordings lie to a computed reachable set.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Enclosed {
    /// All rows hold.
    Yes,
    /// The set was followed to the end, and a row does not hold.
    No,
    /// The set was lost before the end.
    Lost,
}

/// Returns how many rows of a case, both sides together, the flowpipe under `sets` does not
/// enclose; `None` if it is lost.
pub(crate) fn rows_outside(
    problem: &Problem,
    case: &Case,
    sets: &UncertaintySets,
) -> Result<Option<usize>> {
    let system = problem.nonlinear().polynomial_system()?;
    let flowpipe = attempt(system, case, sets, VERTEX_VARIABLES[0], None)?;
    let mut outside = 0;
    let is_reached = for_each_row(problem, case, flowpipe, sets, |row| {
        outside += usize::from(!row.holds());
    });
    Ok(is_reached.then_some(outside))
}

pub(crate) fn enclosed(
    problem: &Problem,
    case: &Case,
    sets: &UncertaintySets,
    effort: Effort,
) -> Result<Enclosed> {
    let system = problem.nonlinear().polynomial_system()?;
    let of = |vertices: usize| attempt(system, case, sets, vertices, None);
    let flowpipe = furthest(effort, of, |flowpipe| flowpipe)?;
    let mut all = true;
    let is_reached = for_each_row(problem, case, flowpipe, sets, |row| all &= row.holds());
    Ok(match (is_reached, all) {
        (false, _) => Enclosed::Lost,
        (true, true) => Enclosed::Yes,
        (true, false) => Enclosed::No,
    })
}

/// Hands the rows of a case beside its flowpipe to `visit`, and returns whether the flowpipe
/// reaches the end.
fn for_each_row(
    problem: &Problem,
    case: &Case,
    flowpipe: Flowpipe,
    sets: &UncertaintySets,
    visit: impl FnMut(&Row),
) -> bool {
    let (recorded, strand) = (RecordedBounds::of_case((0, case)), Strand::along(case, flowpipe));
    rows(&recorded, &strand, sets, problem.settings().states, visit);
    strand.lost.is_none()
}
