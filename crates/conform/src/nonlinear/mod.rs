//! Conformance of models that are not linear.

mod bisection;
mod case;
mod explain;
mod extremal;
mod journal;
mod outer;
mod search;
mod sensitivity;

pub use case::Case;
pub use explain::{Explanation, explain};
pub(crate) use outer::{Effort, check_outer, flowpipes, lost};
use reachtube_reach::Flowpipe;
use reachtube_robot::Robot;
pub(crate) use sensitivity::nominal;

use self::journal::Journal;
use self::outer::sums;
use super::conformance::{trust, weights};
use super::proof::{Checked, Enclosure, TightRow};
use super::{
    Conformance, Dynamics, Envelope, Method, Recordings, Search, Settings, UncertaintySets, Watch,
};
use crate::error::{Error, Result};
use reachtube_abstraction::PolynomialModel;
use reachtube_recordings::DataSet;

/// Sets that were found, and their reachable sets.
struct Found {
    sets: UncertaintySets,
    flowpipes: Vec<Flowpipe>,
    /// The rows that decide the sets: case, sample, state, side.
    deciding: Vec<super::program::Place>,
    search: Search,
}

/// As [`conform`](super::conform), for a model that is not linear, or by bisection.
pub(super) fn conform(
    robot: &Robot,
    data: &DataSet,
    settings: &Settings,
    model: PolynomialModel,
    recordings: Recordings,
    watch: &Watch,
) -> Result<Conformance> {
    let system = model.polynomial_system()?;
    let cases = Case::all(data, robot, settings, &recordings)?;
    let weights = case_weights(&model, settings, &cases)?;
    let journal = Journal::new(watch.resume, robot, settings, &recordings);
    let search =
        search::Search { model: &model, system: &system, cases: &cases, settings, weights };
    let found = match settings.method {
        Method::Program => search.run(&journal, watch.finished)?,
        Method::Bisection => bisection::run(&search, &journal, watch.finished)?,
    };
    let (cost, hull_volume) = sums(&cases, &found.flowpipes, &found.sets, &search.weights);
    let checked = check(&cases, &found, settings);
    let lost =
        cases.iter().zip(&found.flowpipes).filter_map(|(case, flowpipe)| lost(case, flowpipe));
    let proof = checked.proof(settings, recordings.run_count(), Enclosure::Outer, lost.collect());
    journal.remove();
    Ok(Conformance {
        dynamics: Dynamics::Polynomial(Box::new(model)),
        cost,
        lower_bound: None,
        paper_cost: None,
        hull_volume,
        proof,
        trust: trust(&recordings, &checked.tight),
        search: Some(found.search),
        tight: checked.tight,
        explanations: Vec::new(),
        sets: found.sets,
        recordings,
    })
}

/// s, by the deviations from the nominal motions.
fn case_weights(model: &PolynomialModel, settings: &Settings, cases: &[Case]) -> Result<Vec<f64>> {
    let deviation = |case: &Case| {
        let (nominal, states) = (nominal(model, case)?, 2 * case.joints());
        let off = |k: usize, i: usize, x: f64| x - nominal[k * states + i];
        Ok(case.measured.map(off, off))
    };
    let envelopes: Vec<Envelope> = match settings.weights {
        super::Weights::Spread => cases.iter().map(deviation).collect::<Result<_>>()?,
        _ => Vec::new(),
    };
    Ok(weights(settings, &envelopes.iter().collect::<Vec<_>>(), model.joints()))
}

/// Every row; those that decide are kept.
fn check(cases: &[Case], found: &Found, settings: &Settings) -> Checked {
    let deciding: std::collections::HashSet<_> = found.deciding.iter().copied().collect();
    let mut checked = Checked::new();
    for (index, (case, flowpipe)) in cases.iter().zip(&found.flowpipes).enumerate() {
        check_outer(case, flowpipe, &found.sets, settings.states, |row| {
            checked.take(&row);
            if deciding.contains(&(index, row.sample, row.state, row.side))
                && row.excess.is_finite()
            {
                checked.tight.push(TightRow { suite: case.suite, row });
            }
        });
    }
    checked.sort();
    checked
}

fn runs_away(case: &Case, time: f64) -> Error {
    Error::RunsAway { case: case.name.clone(), time }
}
