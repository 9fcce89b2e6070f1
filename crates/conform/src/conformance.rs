//! The whole of a conformance: from recordings to sets that have been proved to enclose them.

use std::path::Path;

use reachtube_reach::{LinearSystem, ReachSets};
use reachtube_robot::Robot;
use serde::{Deserialize, Serialize};

use super::deviation::{Deviation, Grids, suite_deviations};
use super::program::{Block, Program};
use super::proof::{Checked, Enclosure, Proof, TightRow};
use super::recordings::{Progress, Recordings};
use super::verify::check_rows;
use super::{
    Case, Dynamics, Envelope, Explanation, Settings, Trust, UncertaintySets, Weights, explain,
    nonlinear, within_box,
};
use crate::error::Result;
use reachtube_recordings::DataSet;

/// Inflations tried after the first repair, each twice the one before.
const REPAIRS: i32 = 60;

/// The result of [`conform`].
#[derive(Debug)]
pub struct Conformance {
    /// The model.
    pub dynamics: Dynamics,
    /// X0, U, V.
    pub sets: UncertaintySets,
    /// Cost of the sets: Σ_k Σ_i s_i width_i(t_k) of the reachable set and the noise, at each
    /// distinct sample time; suites whose sets differ count by their mean. Infinite where a set was
    /// lost.
    pub cost: f64,
    /// What the solver says no sets can cost less than, for a linear model.
    pub lower_bound: Option<f64>,
    /// The paper's sum, eq. (21), which adds E where it should add |E|, for a linear model.
    pub paper_cost: Option<f64>,
    /// Σ_k Δt Π_i width_i(t_k), eq. (2).
    pub hull_volume: f64,
    /// What was proved.
    pub proof: Proof,
    /// What may be expected of motions that were not recorded.
    pub trust: Trust,
    /// How the sets of a model that is not linear were found.
    pub search: Option<Search>,
    /// The rows that touch the reachable set, the closest first; that of the linearisation where
    /// the model is not linear.
    pub tight: Vec<TightRow>,
    /// How close a motion of the model comes to each run, where that was asked for.
    pub explanations: Vec<Explanation>,
    /// The recordings as read.
    pub recordings: Recordings,
}

/// How the sets of a model that is not linear were found.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Search {
    /// Linearisations, each with its program.
    pub rounds: usize,
    /// How often the reachable sets of all suites were computed.
    pub reachable_sets: usize,
    /// The cost of the linearised sets, Σ_k Σ_i s_i 2 (R_k r)_i, which the programs minimise.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub linearised_cost: Option<f64>,
    /// The case and the time (s) at which a simulated motion under the last sets but one left every
    /// bound.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub runs_away: Option<(String, f64)>,
}

/// What a long job tells while it runs, and where it keeps what is finished.
#[derive(Clone, Copy)]
pub struct Watch<'a> {
    /// Of recordings that are read.
    pub reading: Progress<'a>,
    /// Of rounds or bisections that are finished, in words.
    pub finished: &'a (dyn Fn(&str) + Sync),
    /// A file that holds what is finished, to go on from: read where it is there, written after
    /// each round, removed at the end.
    pub resume: Option<&'a Path>,
}

impl Watch<'_> {
    /// Nobody watches.
    pub const SILENT: Watch<'static> =
        Watch { reading: &|_, _| {}, finished: &|_| {}, resume: None };
}

/// Identifies the smallest uncertainty sets for which the model of `robot` that `settings` ask for
/// is reachset conformant with the suites `names` of `data` (all suites when none is named), and
/// proves the result with directed rounding. A linear model's sets are those of one linear program;
/// for others see [`Method`](super::Method).
///
/// # Guarantee
///
/// When `proof.verified`, for every run, sample and state of the notion used, the recorded value
/// lies in the interval hull of the reachable set of the model at that sample: for a linear model
/// of the set itself, taken from inside, with the deviation taken from outside; for another of the
/// computed outer enclosure. Directed rounding. Nothing is said between samples.
///
/// # Errors
///
/// Defects of the recordings, settings that do not fit, a model that runs away without any
/// disturbance, a program that the solver gives up on, a `resume` file of another job or that
/// cannot be written. A model that could not be proved conformant is no error.
pub fn conform(
    robot: &Robot,
    data: &DataSet,
    names: &[String],
    settings: &Settings,
    watch: &Watch,
) -> Result<Conformance> {
    settings.validate(robot.joint_count())?;
    conform_dynamics(robot, data, names, settings, Dynamics::new(robot, settings)?, watch)
}

/// As [`conform`], with a model that is at hand. A linear one that is given as a polynomial goes
/// the way of those that are not linear.
///
/// # Errors
///
/// As [`conform`].
pub fn conform_dynamics(
    robot: &Robot,
    data: &DataSet,
    names: &[String],
    settings: &Settings,
    dynamics: Dynamics,
    watch: &Watch,
) -> Result<Conformance> {
    let mut recordings = Recordings::read(data, names, robot, settings, watch.reading)?;
    within_box::check_starts(data, settings, &recordings)?;
    recordings.notes.extend(within_box::notes(settings, &recordings));
    let mut found = match dynamics {
        Dynamics::Linear(system) => linear(robot, data, settings, system, recordings)?,
        Dynamics::Polynomial(model) => {
            nonlinear::conform(robot, data, settings, *model, recordings, watch)?
        }
    };
    if settings.explain.is_some() {
        let Conformance { dynamics, recordings, sets, .. } = &found;
        let model = dynamics.polynomials(robot, settings)?;
        let cases = Case::all(data, robot, settings, recordings)?;
        found.explanations = explain(data, robot, settings, &model, &cases, recordings, sets)?;
    }
    Ok(found)
}

fn linear(
    robot: &Robot,
    data: &DataSet,
    settings: &Settings,
    system: LinearSystem,
    recordings: Recordings,
) -> Result<Conformance> {
    let grids = Grids::new(&recordings, &system, settings.disturbance)?;
    let deviations = recordings
        .suites
        .iter()
        .map(|suite| suite_deviations(data, robot, settings, &grids, suite))
        .collect::<Result<Vec<_>>>()?;
    let all: Vec<Deviation> = deviations.iter().flatten().cloned().collect();
    let envelopes: Vec<&Envelope> = all.iter().map(|deviation| &deviation.envelope).collect();
    let weights = weights(settings, &envelopes, robot.joint_count());
    let blocks = Block::of_grids(grids.as_slice(), &all, robot.joint_count());
    let program = Program::new(settings, &weights, blocks);
    let solution = program.solve()?;
    let (sets, checked) = repair(&program, &solution.sets, &grids, settings, &deviations);
    let (paper_cost, hull_volume) = program.paper_sums(&sets);
    Ok(Conformance {
        cost: program.cost(&sets),
        lower_bound: Some(solution.lower_bound),
        paper_cost: Some(paper_cost),
        hull_volume,
        proof: checked.proof(settings, recordings.run_count(), Enclosure::Inner, Vec::new()),
        trust: trust(&recordings, &checked.tight),
        search: None,
        tight: checked.tight,
        explanations: Vec::new(),
        dynamics: Dynamics::Linear(system),
        sets,
        recordings,
    })
}

/// s, 2n, for these deviations.
pub(super) fn weights(settings: &Settings, deviations: &[&Envelope], joints: usize) -> Vec<f64> {
    match &settings.weights {
        Weights::Unit => vec![1.0; 2 * joints],
        Weights::Given(weights) => weights.clone(),
        Weights::Spread => {
            (0..2 * joints).map(|i| 1.0 / largest_deviation(deviations, i)).collect()
        }
    }
}

/// The largest |d| of state `i`; 1 where there is none.
fn largest_deviation(deviations: &[&Envelope], i: usize) -> f64 {
    let of = |envelope: &&Envelope| {
        (0..envelope.len())
            .map(|k| envelope.upper(k, i).max(-envelope.lower(k, i)))
            .fold(0.0, f64::max)
    };
    let largest = deviations.iter().map(of).fold(0.0, f64::max);
    if largest > 0.0 { largest } else { 1.0 }
}

/// Makes the solver's answer true (correction H of the method): the radii are scaled by the worst
/// ratio, then checked with directed rounding, and inflated by a growing last bit until the check
/// passes.
fn repair(
    program: &Program,
    found: &UncertaintySets,
    grids: &Grids,
    settings: &Settings,
    deviations: &[Vec<Deviation>],
) -> (UncertaintySets, Checked) {
    let scaled = found.inflated(program.worst_ratio(found), 0.0);
    let mut sets = scaled.clone();
    let mut checked = check_all(&sets, grids, settings, deviations);
    for attempt in 0..REPAIRS {
        if checked.failed == 0 {
            break;
        }
        let bit = f64::EPSILON * 2f64.powi(attempt);
        sets = scaled.inflated(1.0 + bit, bit * program.scale());
        checked = check_all(&sets, grids, settings, deviations);
    }
    (sets, checked)
}

fn check_all(
    sets: &UncertaintySets,
    grids: &Grids,
    settings: &Settings,
    deviations: &[Vec<Deviation>],
) -> Checked {
    let reach: Vec<ReachSets> = grids.as_slice().iter().map(|grid| grid.reach(sets)).collect();
    let mut checked = Checked::new();
    for (suite, deviations) in deviations.iter().enumerate() {
        for deviation in deviations {
            let grid = &grids.as_slice()[deviation.grid];
            check_rows(grid, &reach[deviation.grid], sets, settings.states, deviation, |row| {
                checked.take_tight(suite, row);
            });
        }
    }
    checked.sort();
    checked
}

/// Motions that touch the reachable set, among all motions: the rows of support are among the tight
/// ones.
pub(super) fn trust(recordings: &Recordings, tight: &[TightRow]) -> Trust {
    let motion_of = |suite: &super::Suite| {
        suite.entry.motion.clone().unwrap_or_else(|| suite.entry.name.clone())
    };
    let known = recordings.suites.iter().all(|suite| suite.entry.motion.is_some());
    let all: std::collections::BTreeSet<String> = recordings.suites.iter().map(motion_of).collect();
    let deciding: std::collections::BTreeSet<String> =
        tight.iter().map(|tight| motion_of(&recordings.suites[tight.suite])).collect();
    Trust::of_fit(all.len(), deciding.len(), known)
}
