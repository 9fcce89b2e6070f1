use std::path::Path;

use reachtube_reach::Flowpipe;

use crate::envelope::Envelope;
use crate::error::Result;
use crate::found::{Deciding, Found};
use crate::hulls::{HullKind, Hulls};
use crate::linear::costs::shares;
use crate::problem::case::Case;
use crate::problem::problem::Problem;
use crate::progress::Progress;
use crate::search::bisection;
use crate::search::journal::Journal;
use crate::search::sensitivity::nominal;
use crate::search::successive::{SearchResult, SuccessiveLinearisation};
use crate::sets::UncertaintySets;
use crate::settings::{Method, Weights};
use crate::weights::state_weights;

/// Finds the smallest sets of a model that is not linear by the method of the settings. What is
/// finished is kept in the file `resume` and removed at the end.
///
/// # Errors
///
/// When the model cannot be followed along a case, a program is not solved, or the journal cannot
/// be read or written.
pub(crate) fn smallest_sets(
    problem: &Problem,
    progress: &dyn Progress,
    resume: Option<&Path>,
) -> Result<Found> {
    let cases = problem.cases()?;
    let weights = case_weights(problem, cases)?;
    let journal = Journal::new(resume, problem);
    let search = SuccessiveLinearisation { problem, cases, weights };
    let SearchResult { sets, flowpipes, deciding, summary } = match problem.settings().method {
        Method::Program => search.run(&journal, progress)?,
        Method::Bisection => bisection::run(&search, &journal, progress)?,
    };
    let (cost, hull_volume) = sums(cases, &flowpipes, &sets, &search.weights);
    journal.remove();
    Ok(Found {
        hulls: Hulls { sets, kind: HullKind::Outer(flowpipes) },
        cost,
        lower_bound: None,
        optimality_gap: None,
        paper_cost: None,
        hull_volume,
        search: Some(summary),
        deciding: Deciding::Rows(deciding.into_iter().collect()),
    })
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

/// Returns the sums of [`sums`] over the reachable sets of a model that is not linear; of any
/// other, nothing.
///
/// # Errors
///
/// As [`Problem::cases`].
pub(crate) fn costs(problem: &Problem, hulls: &Hulls) -> Result<(f64, f64)> {
    let cases = problem.cases()?;
    match &hulls.kind {
        HullKind::Linear(_) => Ok((0.0, 0.0)),
        HullKind::Outer(flowpipes) => {
            Ok(sums(cases, flowpipes, &hulls.sets, &case_weights(problem, cases)?))
        }
    }
}

/// Returns Σ_k Σ_i s_i width_i(t_k) of the reachable sets with the noise set, where cases at one
/// time count by their mean, and Σ_k Δt Π_i width_i(t_k), eq. (2) of the paper. Both are infinite
/// where a set was lost.
fn sums(
    cases: &[Case],
    flowpipes: &[Flowpipe],
    sets: &UncertaintySets,
    weights: &[f64],
) -> (f64, f64) {
    let shares = shares(cases.iter().map(|case| case.grid.times()));
    let (mut cost, mut volume) = (0.0, 0.0);
    for ((case, flowpipe), shares) in cases.iter().zip(flowpipes).zip(&shares) {
        let times = case.grid.times();
        for (k, share) in shares.iter().enumerate() {
            if k >= flowpipe.len() {
                return (f64::INFINITY, f64::INFINITY);
            }
            let widths = flowpipe.sample(k).iter().map(|hull| hull.width()).enumerate();
            let widths = widths.map(|(i, width)| width + 2.0 * sets.noise_radius(i));
            let weighted = widths.clone().zip(weights).map(|(width, weight)| weight * width);
            cost += share * weighted.sum::<f64>();
            let next = times.get(k + 1).unwrap_or(&times[k]);
            volume += share * widths.product::<f64>() * (next - times[k]);
        }
    }
    (cost, volume)
}
