//! The smallest sets for which every recorded point lies in the reachable set, by cutting planes.
//!
//! A point outside the reachable set of a program's answer is separated from it by a direction. The
//! row of this direction joins the program, which keeps its unknowns, and the program is solved
//! again (docs/method.md, section 4).

use crate::claim::claim::Claim;
use crate::claim::look::{Look, Near};
use crate::claim::touching::touching;
use crate::data::problem::Problem;
use crate::data::settings::Noise;
use crate::error::{Error, Result};
use crate::found::{Deciding, Found};
use crate::hulls::Hulls;
use crate::linear::program::{Program, Solution};
use crate::linear::smallest_sets::{encloses, program};
use crate::optimality::optimality_gap;
use crate::progress::Progress;
use crate::sets::UncertaintySets;
use crate::tube::judged::{Along, At};
use crate::tube::linear::Linear;

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

/// Finds the smallest sets of a linear model for a claim about its points, lets `widen` make them
/// larger, and inflates them until every row and every point is proved.
///
/// # Errors
///
/// [`Error::Program`] if points are left outside after many rounds; as [`Problem::deviations`], and
/// errors of `widen`.
pub(crate) fn smallest_sets(
    problem: &Problem,
    claim: &dyn Claim,
    progress: &dyn Progress,
    widen: impl FnOnce(UncertaintySets) -> Result<UncertaintySets>,
) -> Result<Found> {
    let plant = Linear::new(problem)?;
    let mut program = program(problem)?;
    let tolerance = match problem.settings().noise {
        Noise::None => TOLERANCE,
        Noise::Fitted | Noise::Fixed(_) => TOLERANCE_WITH_NOISE,
    };
    let (solution, cuts) = solve(claim, &plant, &mut program, tolerance, progress)?;
    let sets = widen(solution.sets)?;
    let hulls = prove((problem, &plant), claim, &sets, tolerance, program.scale())?;
    let (paper_cost, hull_volume) = program.paper_sums(&hulls.sets);
    let (cost, lower_bound) = (program.cost(&hulls.sets), solution.lower_bound);
    let touching = touching(problem, &plant, &program, &hulls, &cuts)?;
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

/// Solves the program by rounds of cutting planes; returns the directions that were added, each
/// with its sample and the point that is furthest along it.
fn solve(
    claim: &dyn Claim,
    plant: &Linear,
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
        let outside = |near: &[Near]| directions_outside((claim, plant), sets, tolerance, near);
        let mut found = outside(&near)?;
        if found.is_empty() {
            // All points are tried, and the ones that may be outside stay in the list.
            near.push(Near { sets: sets.clone(), margin: 1.0 + tolerance });
            found = outside(&near[near.len() - 1..])?;
        }
        if found.is_empty() {
            let directions = cuts.len();
            progress.finished(&format!(
                "the cutting planes ended in round {round}: directions {directions}"
            ));
            return Ok((solution, cuts));
        }
        let furthest = claim.furthest(&found)?;
        for ((at, direction), along) in found.into_iter().zip(furthest) {
            program.cuts.push(plant.cut(at, &direction, along.value));
            cuts.push((at, direction, along));
        }
    }
    Err(Error::Program(format!(
        "{ROUNDS} rounds of cutting planes left points outside; report this with the data"
    )))
}

/// A direction that was added to the program: its sample, its 2n entries, and the point that is
/// furthest along it.
type Added = (At, Vec<f64>, Along);

/// Returns the direction of the point furthest outside at each sample and in each projection.
fn directions_outside(
    (claim, plant): (&dyn Claim, &Linear),
    sets: &UncertaintySets,
    tolerance: f64,
    near: &[Near],
) -> Result<Vec<(At, Vec<f64>)>> {
    let look = Look::Search { tolerance, near: near.to_vec() };
    let outside = claim.judge(plant, sets, &look)?.judged.unwrap_or_default().furthest;
    Ok(outside.into_iter().map(|((at, _), point)| (at, point.direction)).collect())
}

/// Inflates the sets until every row and every point is proved, or for a number of times.
fn prove(
    (problem, plant): (&Problem, &Linear),
    claim: &dyn Claim,
    sets: &UncertaintySets,
    tolerance: f64,
    scale: f64,
) -> Result<Hulls> {
    let (mut left, mut points): (Option<Vec<At>>, Option<usize>) = Default::default();
    for attempt in 0.. {
        let factor = tolerance * 2f64.powi(attempt);
        let term = f64::EPSILON * 4f64.powi(attempt) * scale;
        // Points that were proved for smaller sets lie in larger ones.
        let look = Look::Proof { at: left.take(), asked: Vec::new() };
        let mut hulls = claim.judge(plant, &sets.inflated(1.0 + factor, term), &look)?;
        let all_rows = encloses(problem, &hulls)?;
        let judged = hulls.judged.get_or_insert_default();
        judged.points = *points.get_or_insert(judged.points);
        if (judged.left.is_empty() && all_rows) || attempt + 1 == REPAIRS {
            return Ok(hulls);
        }
        left = Some(judged.left.iter().copied().collect());
    }
    unreachable!("the last attempt returns")
}
