//! The smallest sets for which every recorded point lies in the reachable set, by cutting planes.
//!
//! A point outside the reachable set of a program's answer is separated from it by a direction. The
//! row of this direction joins the program, which keeps its unknowns, and the program is solved
//! again (docs/method.md, section 4).

use crate::error::{Error, Result};
use crate::found::{Deciding, Found};
use crate::hulls::Hulls;
use crate::linear::program::{Program, Solution};
use crate::linear::smallest_sets::{encloses, program};
use crate::notion::sweep::{Outside, Sweep};
use crate::optimality::optimality_gap;
use crate::problem::problem::Problem;
use crate::progress::Progress;
use crate::sets::UncertaintySets;
use crate::settings::Noise;

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
/// As [`smallest_sets`], and those of `widen`.
pub(crate) fn smallest_sets_widened(
    problem: &Problem,
    progress: &dyn Progress,
    widen: impl FnOnce(UncertaintySets) -> Result<UncertaintySets>,
) -> Result<Found> {
    let sweep = Sweep::new(problem)?;
    let mut program = program(problem)?;
    let tolerance = match problem.settings().noise {
        Noise::None => TOLERANCE,
        Noise::Fitted | Noise::Fixed(_) => TOLERANCE_WITH_NOISE,
    };
    let (solution, cuts) = solve(&sweep, &mut program, tolerance, progress)?;
    let sets = widen(solution.sets)?;
    let hulls = prove(problem, &sweep, &sets, tolerance, program.scale())?;
    let (paper_cost, hull_volume) = program.paper_sums(&hulls.sets);
    let (cost, lower_bound) = (program.cost(&hulls.sets), solution.lower_bound);
    let touching = sweep.touching(problem, &program, &hulls.sets, &cuts);
    Ok(Found {
        cost,
        lower_bound: Some(lower_bound),
        optimality_gap: Some(optimality_gap(cost, lower_bound, program.negligible_cost())),
        paper_cost: Some(paper_cost),
        hull_volume,
        search: None,
        deciding: Deciding::Points(touching),
        hulls,
    })
}

/// Solves the program by rounds of cutting planes; returns the points whose cuts were added.
fn solve(
    sweep: &Sweep,
    program: &mut Program,
    tolerance: f64,
    progress: &dyn Progress,
) -> Result<(Solution, Vec<Outside>)> {
    let mut rows = program.first_rows();
    let (mut near, mut cuts): (Option<Vec<Vec<usize>>>, Vec<Outside>) = (None, Vec::new());
    for round in 1..=ROUNDS {
        progress.go_on()?;
        let solution = program.solve_from(&mut rows)?;
        let near = near.get_or_insert_with(|| sweep.near(&solution.sets, MARGIN));
        let mut outside = sweep.outside(&solution.sets, tolerance, near);
        if outside.is_empty() {
            let others = sweep.near(&solution.sets, 1.0 + tolerance);
            outside = sweep.outside(&solution.sets, tolerance, &others);
            near.iter_mut().zip(others).for_each(|(near, others)| {
                near.extend(others);
                near.sort_unstable();
                near.dedup();
            });
        }
        if outside.is_empty() {
            progress.finished(&format!(
                "the cutting planes ended in round {round}: directions {}, samples {}",
                cuts.len(),
                sweep.points.len()
            ));
            return Ok((solution, cuts));
        }
        program.cuts.extend(outside.iter().map(|outside| sweep.cut(outside)));
        cuts.extend(outside);
    }
    Err(Error::Program(format!(
        "{ROUNDS} rounds of cutting planes left points outside; report this with the data"
    )))
}

/// Inflates the sets until every row and every point is proved, or for a number of times.
fn prove(
    problem: &Problem,
    sweep: &Sweep,
    sets: &UncertaintySets,
    tolerance: f64,
    scale: f64,
) -> Result<Hulls> {
    let mut left: Vec<usize> = (0..sweep.points.len()).collect();
    let mut attempt = 0;
    loop {
        let factor = tolerance * 2f64.powi(attempt);
        let term = f64::EPSILON * 4f64.powi(attempt) * scale;
        let hulls = Hulls::new(problem, sets.inflated(1.0 + factor, term))?;
        // Points that were proved for smaller sets lie in larger ones.
        left = sweep.unproved(&hulls.sets, &left).into_iter().map(|unproved| unproved.at).collect();
        left.dedup();
        attempt += 1;
        if (left.is_empty() && encloses(problem, &hulls)?) || attempt == REPAIRS {
            return Ok(hulls);
        }
    }
}
