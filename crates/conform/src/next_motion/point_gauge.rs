//! By how much sets must grow so that recorded points lie in the reachable set.

use crate::claim::look::{Look, Near};
use crate::claim::notion::{claim, plant};
use crate::data::problem::Problem;
use crate::error::Result;
use crate::next_motion::motions::Motions;
use crate::next_motion::without_motion::LeftOut;
use crate::program::program::Program;
use crate::search::smallest_sets::smallest_sets_alone;
use crate::sets::UncertaintySets;

/// Rounds at most.
const ROUNDS: usize = 60;

/// Returns the least factor, from `rows` on, with which the sets `grown` hold the recorded points
/// of a problem with a linear model. Returns `rows` itself where the notion asks no points, and
/// `None` if no factor was found.
///
/// A point outside shows a direction, and by which factor the set must grow there at least. The
/// largest of these is tried next, so that the factors rise to the answer from below.
///
/// # Guarantee
///
/// Descriptive, in floating point, and to the tolerance of the search for points.
pub(crate) fn point_gauge(
    problem: &Problem,
    rows: f64,
    grown: &dyn Fn(f64) -> UncertaintySets,
) -> Result<Option<f64>> {
    if !problem.settings().notion.asks_points() {
        return Ok(Some(rows));
    }
    let (claim, plant) = (&*claim(problem)?, &*plant(problem)?);
    let tolerance = claim.tolerance().unwrap_or_default();
    let mut factor = rows;
    for _ in 0..ROUNDS {
        let sets = grown(factor);
        let near = vec![Near { sets: sets.clone(), margin: 1.0 + tolerance }];
        let tube = claim.judge(plant, &sets, &Look::Search { tolerance, near })?;
        let outside = tube.judged.iter().flat_map(|judged| judged.furthest.values());
        match outside.map(|point| point.ratio).reduce(f64::max) {
            None => return Ok(Some(factor)),
            Some(ratio) if ratio.is_finite() => factor *= ratio,
            Some(_) => return Ok(None),
        }
    }
    Ok(None)
}

/// Finds the sets of the other motions of a linear model by the notion of the problem, and compares
/// the points of `motion` with them.
pub(crate) fn leave_points_out(problem: &Problem, motion: &str) -> Result<LeftOut> {
    let motions = Motions::new(problem.recordings());
    let [own, others] = [true, false]
        .map(|own| problem.with_suites(|suite| (motions.of_suite(suite) == motion) == own));
    let sets = smallest_sets_alone(&others, &*claim(&others)?)?.tube.sets;
    let input_only = problem.settings().nominal.is_measured();
    let rows = Program::of_problem(&own)?.growth(&sets, input_only);
    let grown = |factor: f64| sets.grown(factor, input_only);
    let gauge = rows.map_or(Ok(None), |rows| point_gauge(&own, rows, &grown))?;
    let tube = claim(&own)?.judge(&*plant(&own)?, &sets, &Look::proof())?;
    let judged = tube.judged.unwrap_or_default();
    Ok(LeftOut {
        motion: motion.into(),
        cost: Some(Program::of_problem(problem)?.cost(&sets)),
        rows: judged.points,
        outside: Some(judged.outside),
        gauge,
        ..LeftOut::default()
    })
}
