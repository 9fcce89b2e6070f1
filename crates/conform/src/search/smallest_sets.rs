use std::collections::HashSet;
use std::path::Path;

use crate::claim::claim::Claim;
use crate::claim::witness::{PointWitness, SeparatedPoint};
use crate::data::case::Case;
use crate::data::envelope::Envelope;
use crate::data::problem::Problem;
use crate::data::settings::{Method, Notion, Weights};
use crate::error::{Error, Result};
use crate::found::{Deciding, Found, TOUCHING};
use crate::hulls::Hulls;
use crate::linear::costs::shares;
use crate::next_motion::left_out::leave_each_out_of_search;
use crate::nominal::simulate::nominal;
use crate::progress::Progress;
use crate::search::bisection;
use crate::search::direction::Direction;
use crate::search::journal::Journal;
use crate::search::successive::{SearchResult, SuccessiveLinearisation};
use crate::weights::state_weights;
use crate::witness::Witness;

/// Finds the smallest sets of a model that is not linear by the method of the settings. What is
/// finished is kept in the file `resume` and removed at the end.
///
/// # Errors
///
/// When the model cannot be followed along a case, a program is not solved, or the journal cannot
/// be read or written.
pub(crate) fn smallest_sets(
    problem: &Problem,
    claim: &dyn Claim,
    progress: &dyn Progress,
    resume: Option<&Path>,
) -> Result<Found> {
    let cases = problem.cases()?;
    let weights = case_weights(problem, cases)?;
    let journal = Journal::new(resume, problem);
    let search = SuccessiveLinearisation { problem, cases, claim, weights };
    let settings = problem.settings();
    let found = match settings.method {
        Method::Program => search.run(&journal, progress)?,
        Method::Bisection if settings.notion != Notion::Hull => return Err(Error::Notion),
        Method::Bisection => bisection::run(&search, &journal, progress)?,
    };
    let SearchResult { sets, program, outer, directions, deciding, summary } = found;
    let left_out = match &program {
        Some(program) => leave_each_out_of_search(problem, &sets, program, progress)?,
        None => Vec::new(),
    };
    let points = touching(problem, &directions, &outer)?;
    let (cost, hull_volume) = sums(cases, &outer, &search.weights);
    journal.remove();
    Ok(Found {
        hulls: outer,
        cost,
        lower_bound: None,
        optimality_gap: None,
        paper_cost: None,
        hull_volume,
        search: Some(summary),
        left_out,
        deciding: Deciding::Rows(deciding.into_iter().collect(), points),
    })
}

/// Returns the points that touch the linearised set in directions other than the states, the
/// closest first, each once.
fn touching(
    problem: &Problem,
    directions: &[(Direction, f64)],
    outer: &Hulls,
) -> Result<Vec<Witness>> {
    let cases = problem.cases()?;
    let mut touching: Vec<&(Direction, f64)> =
        directions.iter().filter(|(_, ratio)| *ratio >= 1.0 - TOUCHING).collect();
    touching.sort_by(|a, b| b.1.total_cmp(&a.1));
    let mut seen = HashSet::new();
    touching.retain(|(at, _)| seen.insert((at.case, at.sample, at.run)));
    let witness = |(at, ratio): &(Direction, f64)| {
        let (case, hull) = (&cases[at.case], outer.radii(at.at()));
        let recorded = problem.run(at.run)?;
        let centres = outer.flowpipes()[at.case].sample(at.sample).iter().map(|side| side.mid());
        let deviation: Vec<f64> =
            recorded.state(at.sample).iter().zip(centres).map(|(x, c)| x - c).collect();
        let point = SeparatedPoint {
            suite: case.suite,
            file: &problem.entry(at.run).file,
            sample: at.sample,
            time: case.grid.times()[at.sample],
            hull: &hull,
            deviation: &deviation,
            direction: &at.direction,
            ratio: *ratio,
        };
        Ok(PointWitness::new(problem, &point).into_witness())
    };
    touching.into_iter().filter(|(at, _)| outer.reaches(at.at())).map(witness).collect()
}

/// Returns the weights of the states, s, by the deviations from the nominal motions.
fn case_weights(problem: &Problem, cases: &[Case]) -> Result<Vec<f64>> {
    let deviation = |case: &Case| {
        let nominal = nominal(problem.dynamics().polynomials(), case)?;
        let states = 2 * case.joints();
        let off = |k: usize, i: usize, x: f64| x - nominal[k * states + i];
        Ok(case.measured.map(off, off))
    };
    let weights = &problem.settings().weights;
    let envelopes: Vec<Envelope> = match weights {
        Weights::Spread => cases.iter().map(deviation).collect::<Result<_>>()?,
        Weights::Unit | Weights::Given(_) => Vec::new(),
    };
    Ok(state_weights(weights, &envelopes.iter().collect::<Vec<_>>(), problem.joints()))
}

/// Returns the sums of [`sums`] over the reachable sets of a model that is not linear.
///
/// # Errors
///
/// As [`Problem::cases`].
pub(crate) fn costs(problem: &Problem, hulls: &Hulls) -> Result<(f64, f64)> {
    let cases = problem.cases()?;
    Ok(sums(cases, hulls, &case_weights(problem, cases)?))
}

/// Returns Σ_k Σ_i s_i width_i(t_k) of the reachable sets with the noise set, where cases at one
/// time count by their mean, and Σ_k Δt Π_i width_i(t_k), eq. (2) of the paper. Both are infinite
/// where a set was lost.
fn sums(cases: &[Case], outer: &Hulls, weights: &[f64]) -> (f64, f64) {
    let shares = shares(cases.iter().map(|case| case.grid.times()));
    let (mut cost, mut volume) = (0.0, 0.0);
    for ((case, flowpipe), shares) in cases.iter().zip(outer.flowpipes()).zip(&shares) {
        let times = case.grid.times();
        for (k, share) in shares.iter().enumerate() {
            if k >= flowpipe.len() {
                return (f64::INFINITY, f64::INFINITY);
            }
            let widths = flowpipe.sample(k).iter().map(|hull| hull.width()).enumerate();
            let widths = widths.map(|(i, width)| width + 2.0 * outer.sets.noise_radius(i));
            let weighted = widths.clone().zip(weights).map(|(width, weight)| weight * width);
            cost += share * weighted.sum::<f64>();
            let next = times.get(k + 1).unwrap_or(&times[k]);
            volume += share * widths.product::<f64>() * (next - times[k]);
        }
    }
    (cost, volume)
}
