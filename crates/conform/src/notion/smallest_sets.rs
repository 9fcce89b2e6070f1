//! The smallest sets for which every recorded point lies in the reachable set, by cutting planes.
//!
//! A point outside the reachable set of a program's answer is separated from it by a direction. The
//! row of this direction joins the program, which keeps its unknowns, and the program is solved
//! again (docs/method.md, section 4).

use crate::data::problem::Problem;
use crate::data::settings::Noise;
use crate::error::{Error, Result};
use crate::found::{Deciding, Found};
use crate::hulls::Hulls;
use crate::linear::program::{Program, Solution};
use crate::linear::smallest_sets::{encloses, program};
use crate::notion::answers::points_of;
use crate::notion::ask::{Answer, At, Near, PointAlong, Points, Question, other_answer};
use crate::notion::sweep::Sweep;
use crate::optimality::optimality_gap;
use crate::progress::Progress;
use crate::sets::UncertaintySets;

/// The sets are taken when no point needs them to grow by more than this part.
const TOLERANCE: f64 = 2e-5;

/// The same with a noise set, which does not grow, so that the others have to grow more.
const TOLERANCE_WITH_NOISE: f64 = 2e-6;

/// Points this close to the boundary in the first round are tried in every round; all others when
/// none of them is outside any more.
const MARGIN: f64 = 0.97;

/// Programs at most.
const ROUNDS: usize = 200;

/// Inflations tried until every point is proved, each twice the one before.
const REPAIRS: i32 = 24;

/// Finds the smallest sets of a linear model for the notion of its settings, and inflates them
/// until every row and every point is proved.
///
/// # Errors
///
/// [`Error::Program`] when points are left outside after many rounds; as [`Problem::deviations`].
pub(crate) fn smallest_sets(problem: &Problem, progress: &dyn Progress) -> Result<Found> {
    smallest_sets_widened(problem, progress, Ok)
}

/// As [`smallest_sets`], with sets that `widen` has made larger.
///
/// # Errors
///
/// As [`smallest_sets`], and the errors of `widen`.
pub(crate) fn smallest_sets_widened(
    problem: &Problem,
    progress: &dyn Progress,
    widen: impl FnOnce(UncertaintySets) -> Result<UncertaintySets>,
) -> Result<Found> {
    let (points, frame) = (points_of(problem)?, Sweep::without_points(problem)?);
    let mut program = program(problem)?;
    let tolerance = match problem.settings().noise {
        Noise::None => TOLERANCE,
        Noise::Fitted | Noise::Fixed(_) => TOLERANCE_WITH_NOISE,
    };
    let (solution, cuts) = solve(&*points, &frame, &mut program, tolerance, progress)?;
    let sets = widen(solution.sets)?;
    let hulls = prove(problem, &*points, &sets, tolerance, program.scale())?;
    let (paper_cost, hull_volume) = program.paper_sums(&hulls.sets);
    let (cost, lower_bound) = (program.cost(&hulls.sets), solution.lower_bound);
    let touching = frame.touching(problem, &program, &hulls.sets, &cuts);
    Ok(Found {
        cost,
        lower_bound: Some(lower_bound),
        optimality_gap: Some(optimality_gap(cost, lower_bound, program.negligible_cost())),
        paper_cost: Some(paper_cost),
        hull_volume,
        search: None,
        left_out: Vec::new(),
        deciding: Deciding::Points(touching),
        hulls,
    })
}

/// A direction that was added to the program, with the point that is furthest along it.
pub(super) struct Added {
    pub at: At,
    /// 2n entries.
    pub direction: Vec<f64>,
    pub furthest: PointAlong,
}

/// Solves the program by rounds of cutting planes; returns the directions that were added.
fn solve(
    points: &dyn Points,
    frame: &Sweep,
    program: &mut Program,
    tolerance: f64,
    progress: &dyn Progress,
) -> Result<(Solution, Vec<Added>)> {
    let mut rows = program.first_rows();
    let (mut near, mut cuts): (Vec<Near>, Vec<Added>) = Default::default();
    for round in 1..=ROUNDS {
        progress.go_on()?;
        let solution = program.solve_from(&mut rows)?;
        let sets = &solution.sets;
        if near.is_empty() {
            near.push(Near { sets: sets.clone(), margin: MARGIN });
        }
        let mut outside = directions_outside(points, sets, tolerance, &near)?;
        if outside.is_empty() {
            // All points are tried, and points that may be outside stay in the list.
            near.push(Near { sets: sets.clone(), margin: 1.0 + tolerance });
            outside = directions_outside(points, sets, tolerance, &near[near.len() - 1..])?;
        }
        if outside.is_empty() {
            let directions = cuts.len();
            progress.finished(&format!(
                "the cutting planes ended in round {round}: directions {directions}"
            ));
            return Ok((solution, cuts));
        }
        for added in furthest(points, outside)? {
            let (grid, sample) = (added.at.0 as usize, added.at.1 as usize);
            let value = added.furthest.value;
            program.cuts.push(frame.cut((grid, sample), &added.direction, value));
            cuts.push(added);
        }
    }
    Err(Error::Program(format!(
        "{ROUNDS} rounds of cutting planes left points outside; report this with the data"
    )))
}

/// Returns the direction of the point furthest outside at each sample and in each projection.
fn directions_outside(
    points: &dyn Points,
    sets: &UncertaintySets,
    tolerance: f64,
    near: &[Near],
) -> Result<Vec<(At, Vec<f64>)>> {
    let question = Question::Outside { sets: sets.clone(), tolerance, near: near.to_vec() };
    let Answer::Outside(outside) = points.ask(&question)? else { return Err(other_answer()) };
    Ok(outside.into_iter().map(|((at, _), point)| (at, point.direction)).collect())
}

/// Finds the points furthest along directions.
fn furthest(points: &dyn Points, directions: Vec<(At, Vec<f64>)>) -> Result<Vec<Added>> {
    let question = Question::Furthest { directions: directions.clone() };
    let Answer::Furthest(found) = points.ask(&question)? else { return Err(other_answer()) };
    let added = |((at, direction), furthest): ((At, Vec<f64>), Option<PointAlong>)| {
        let furthest = furthest.ok_or_else(other_answer)?;
        Ok(Added { at, direction, furthest })
    };
    directions.into_iter().zip(found).map(added).collect()
}

/// Inflates the sets until every row and every point is proved, or for a number of times.
fn prove(
    problem: &Problem,
    points: &dyn Points,
    sets: &UncertaintySets,
    tolerance: f64,
    scale: f64,
) -> Result<Hulls> {
    let mut left: Option<Vec<At>> = None;
    let mut attempt = 0;
    loop {
        let factor = tolerance * 2f64.powi(attempt);
        let term = f64::EPSILON * 4f64.powi(attempt) * scale;
        let hulls = Hulls::new(problem, sets.inflated(1.0 + factor, term))?;
        // Points that were proved for smaller sets lie in larger ones.
        let question = Question::Unproved { sets: hulls.sets.clone(), at: left };
        let Answer::Unproved(unproved) = points.ask(&question)? else {
            return Err(other_answer());
        };
        attempt += 1;
        if (unproved.is_empty() && encloses(problem, &hulls)?) || attempt == REPAIRS {
            return Ok(hulls);
        }
        left = Some(unproved);
    }
}
