use reachtube_scalar::ExactSum;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::claim::notion::claim;
use crate::claim::verdict::Verdict;
use crate::data::condition::Condition;
use crate::data::problem::Problem;
use crate::data::setup::Setup;
use crate::error::Result;
use crate::search::smallest_sets::smallest_sets_alone;
use crate::sets::UncertaintySets;

/// The smallest sets of a model whose friction depends on the run, that hold for every run: the
/// nominal motion is taken in one condition in the middle.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct AnyRun {
    /// The condition that the nominal motion is computed for.
    pub condition: Condition,
    /// X0, U and V.
    pub sets: UncertaintySets,
    /// The cost of the sets.
    pub cost: f64,
    /// Whether the sets were proved to enclose the recordings.
    pub verified: bool,
}

impl AnyRun {
    /// Finds the sets for a linear model; `None` if friction does not depend on the run.
    pub(crate) fn new(problem: &Problem) -> Result<Option<Self>> {
        let setup = problem.setup();
        if !setup.differs_by_run() || setup.dynamics.linear_system().is_none() {
            return Ok(None);
        }
        let condition = middle(problem);
        let blind =
            problem.with_setup(Setup { condition: Some(condition.clone()), ..setup.clone() });
        let found = smallest_sets_alone(&blind, &*claim(&blind)?)?;
        let verdict = Verdict::new(&blind, &found.tube)?;
        let (sets, cost) = (found.tube.sets, found.costs.cost);
        Ok(Some(Self { condition, sets, cost, verified: verdict.conformant }))
    }
}

/// The condition in the middle of the recorded ones: the geometric mean of the first and the last
/// place, and the mean of the temperatures.
fn middle(problem: &Problem) -> Condition {
    let mut totals = problem.recordings().suites.iter().map(|suite| &suite.totals);
    let Some(mut all) = totals.next().cloned() else { return Condition::first() };
    totals.cloned().for_each(|other| all.merge(other));
    let [first, last] = all.places;
    let place = ((first as f64 * last as f64).sqrt().round() as u64).max(1);
    let means = || all.temperatures.iter().map(ExactSum::mean).collect();
    let temperatures = (all.with_temperature() > 0).then(means);
    Condition { place, temperatures }
}
