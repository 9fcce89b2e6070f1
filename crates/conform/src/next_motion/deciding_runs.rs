use std::collections::{BTreeMap, BTreeSet};

use serde::{Deserialize, Serialize};

use crate::data::envelope::Envelope;
use crate::data::problem::Problem;
use crate::data::suite::Suite;
use crate::error::Result;
use crate::program::program::{CLOSE, Program};
use crate::tube::deviation::Deviation;
use crate::tube::witness::Witness;

/// Number of runs that are named.
const MOST_NAMED: usize = 10;

/// The runs that decide the sets.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DecidingRuns {
    /// How many there are.
    pub count: usize,
    /// The ten that decide the most rows, the first first.
    pub most: Vec<DecidingRun>,
    /// About what the smallest sets would cost without those ten, by programs over the samples that
    /// stay in memory of each run. `None` for a model that is not linear, for calibrated sets,
    /// where the ten are half of all runs or more, or if a suite has more than 256 runs.
    pub cost_without: Option<f64>,
}

/// A run that decides the sets.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DecidingRun {
    /// Path in the data set.
    pub file: String,
    /// How many of its values touch the reachable set.
    pub values: usize,
}

impl DecidingRuns {
    /// Counts the runs of the values `tight`; `cost` is the cost of the sets where these are the
    /// smallest.
    ///
    /// # Errors
    ///
    /// As [`Problem::deviations`].
    pub(crate) fn new(problem: &Problem, tight: &[Witness], cost: Option<f64>) -> Result<Self> {
        let mut counts: BTreeMap<&str, usize> = BTreeMap::new();
        tight.iter().for_each(|witness| *counts.entry(&witness.run).or_insert(0) += 1);
        let count = counts.len();
        let mut most: Vec<(&str, usize)> = counts.into_iter().collect();
        most.sort_by_key(|(_, values)| std::cmp::Reverse(*values));
        most.truncate(MOST_NAMED);
        let named: BTreeSet<&str> = most.iter().map(|(file, _)| *file).collect();
        let runs = problem.recordings().suites.iter().flat_map(|suite| &suite.runs);
        let is_named = |index: &usize| named.contains(problem.entry(*index).file.as_str());
        let dropped: BTreeSet<usize> = runs.map(|run| run.index).filter(is_named).collect();
        let are_known = problem.recordings().suites.iter().all(Suite::is_small);
        let few = are_known
            && !dropped.is_empty()
            && 2 * dropped.len() < problem.recordings().run_count();
        let cost_without = match cost.filter(|_| few) {
            Some(cost) => cost_without(problem, &dropped)?.map(|part| part * cost),
            None => None,
        };
        let run = |(file, values): (&str, usize)| DecidingRun { file: file.into(), values };
        Ok(Self { count, most: most.into_iter().map(run).collect(), cost_without })
    }
}

/// Returns the part of the cost that is left without the runs `dropped`, by the programs of the
/// samples that were kept of every run.
fn cost_without(problem: &Problem, dropped: &BTreeSet<usize>) -> Result<Option<f64>> {
    if problem.dynamics().linear_system().is_none() {
        return Ok(None);
    }
    let runs = problem.recordings().suites.iter().flat_map(|suite| &suite.runs);
    let stride = runs.map(|run| run.marks.stride).max().unwrap_or(1);
    let program = Program::of_problem(problem)?.with_every(stride);
    let deviations = problem.deviations()?;
    let program_without = |dropped: &BTreeSet<usize>| -> Program {
        let kept: Vec<Deviation> =
            deviations.iter().map(|d| at_marks(problem, d, stride, dropped)).collect();
        program.with_deviations(&kept)
    };
    let (all, without) = (program_without(&BTreeSet::new()), program_without(dropped));
    // A program that the solver gives up on leaves nothing to report.
    let mut rows = all.first_rows();
    let Ok(solution) = all.solve_from(&mut rows) else { return Ok(None) };
    all.keep_close(&mut rows, &solution.sets, CLOSE);
    let all = all.repaired_cost(&solution.sets);
    let Ok(solution) = without.solve_near(&rows) else { return Ok(None) };
    let without = without.repaired_cost(&solution.sets);
    Ok((all > 0.0).then(|| without / all))
}

/// Returns the deviations of a suite at every `stride`-th sample, without some of its runs. Where
/// the runs have inputs of their own, the envelope of all is taken.
fn at_marks(
    problem: &Problem,
    deviation: &Deviation,
    stride: usize,
    dropped: &BTreeSet<usize>,
) -> Deviation {
    let (suite, whole) = (&problem.recordings().suites[deviation.suite], &deviation.envelope);
    let states = whole.dimension();
    let mut envelope = Envelope::new(states);
    if suite.shared.is_some() {
        for run in suite.runs.iter().filter(|run| !dropped.contains(&run.index)) {
            let samples = (0..=run.marks.last(stride)).step_by(stride);
            let of = |k: usize| {
                let state = run.marks.state(k).iter().enumerate();
                state.map(move |(i, value)| value - nominal(suite, whole, k, i))
            };
            let values: Vec<f64> = samples.flat_map(of).collect();
            envelope.include(run.index as u32, &values);
        }
    } else {
        let bounds = |bound: fn(&Envelope, usize, usize) -> f64| -> Vec<f64> {
            let samples = (0..whole.len()).step_by(stride);
            samples.flat_map(|k| (0..states).map(move |i| bound(whole, k, i))).collect()
        };
        envelope.include_bounds(0, &bounds(Envelope::lower), &bounds(Envelope::upper));
    }
    Deviation { suite: deviation.suite, grid: deviation.grid, envelope }
}

/// The nominal motion of a suite, to rounding: what lies between its states and deviations.
fn nominal(suite: &Suite, deviations: &Envelope, k: usize, i: usize) -> f64 {
    suite.envelope.upper(k, i) - deviations.upper(k, i)
}
