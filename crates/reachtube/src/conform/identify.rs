//! The whole of a conformance: from recordings to sets that have been proved to enclose them.

use reachtube_reach::{LinearSystem, ReachSets};
use reachtube_robot::Robot;
use serde::{Deserialize, Serialize};

use super::deviation::{Deviation, Grids, suite_deviations};
use super::program::{Block, Program, Solution, TIGHT};
use super::recordings::{Progress, Recordings};
use super::verify::{Row, check_rows};
use super::{Settings, Trust, UncertaintySets, Weights};
use crate::data::DataSet;
use crate::error::Result;

/// Inflations tried after the first repair, each twice the one before.
const REPAIRS: i32 = 60;

/// The result of [`conform`].
#[derive(Debug)]
pub struct Conformance {
    /// Model 1.
    pub system: LinearSystem,
    /// X0, U, V.
    pub sets: UncertaintySets,
    /// Cost of the sets: Σ_k Σ_i s_i 2 (R_k r)_i.
    pub cost: f64,
    /// What the solver says no sets can cost less than.
    pub lower_bound: f64,
    /// The paper's sum, eq. (21), which adds E where it should add |E|.
    pub paper_cost: f64,
    /// Σ_k Δt Π_i 2 (R_k r)_i, eq. (2).
    pub hull_volume: f64,
    /// What was proved.
    pub proof: Proof,
    /// What may be expected of motions that were not recorded.
    pub trust: Trust,
    /// Rows of the program, rows handed to the solver, and rounds.
    pub program: Solution,
    /// The rows that touch the reachable set, the closest first.
    pub tight: Vec<TightRow>,
    /// The recordings as read.
    pub recordings: Recordings,
    /// The grids of the recordings.
    pub grids: Grids,
}

/// What was proved about the recordings, and how.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Proof {
    /// Whether every row was proved to hold.
    pub verified: bool,
    /// The claim in words.
    pub claim: String,
    /// Rows checked: suite x sample x state x side.
    pub rows: usize,
    /// Rows that were proved.
    pub proved: usize,
    /// Recordings behind the rows.
    pub runs: usize,
    /// The largest excess of a row, rad or rad/s: not above 0 when all rows hold.
    pub largest_excess: f64,
}

/// A row in which a run touches the reachable set.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TightRow {
    /// Index of the suite in the recordings.
    pub suite: usize,
    /// The row.
    pub row: Row,
}

/// Identifies the smallest uncertainty sets for which model 1 of `robot` is reachset conformant with the suites `names` of `data` (all suites when none is named), repairs the
/// solver's answer, and proves the result with directed rounding.
///
/// # Guarantee
///
/// When `proof.verified`, for every run, sample and state of the notion used, the recorded value lies in the interval hull of the reachable set of the model at that sample.
/// The reachable set is taken from inside and the deviation from outside, with directed rounding. Nothing is said between samples.
///
/// # Errors
///
/// Defects of the recordings, settings that do not fit, a program that the solver gives up on. A model that could not be proved conformant is no error.
pub fn conform(
    robot: &Robot,
    data: &DataSet,
    names: &[String],
    settings: &Settings,
    progress: Progress,
) -> Result<Conformance> {
    settings.validate(robot.joint_count())?;
    let system = settings.linear_system(robot)?;
    let recordings = Recordings::read(data, names, robot, settings, progress)?;
    let grids = Grids::new(&recordings, &system, settings.disturbance)?;
    let deviations = recordings
        .suites
        .iter()
        .map(|suite| suite_deviations(data, robot, settings, &grids, suite))
        .collect::<Result<Vec<_>>>()?;
    let all: Vec<Deviation> = deviations.iter().flatten().cloned().collect();
    let weights = weights(settings, &all, robot.joint_count());
    let blocks = Block::of_grids(grids.as_slice(), &all, robot.joint_count());
    let program = Program::new(settings, &weights, blocks);
    let solution = program.solve()?;
    let (sets, checked) = repair(&program, &solution.sets, &grids, settings, &deviations);
    let (paper_cost, hull_volume) = program.paper_sums(&sets);
    Ok(Conformance {
        cost: program.cost(&sets),
        lower_bound: solution.lower_bound,
        paper_cost,
        hull_volume,
        proof: checked.proof(settings, recordings.run_count()),
        trust: trust(&recordings, &checked.tight),
        tight: checked.tight,
        program: solution,
        system,
        sets,
        recordings,
        grids,
    })
}

fn weights(settings: &Settings, deviations: &[Deviation], joints: usize) -> Vec<f64> {
    match &settings.weights {
        Weights::Unit => vec![1.0; 2 * joints],
        Weights::Given(weights) => weights.clone(),
        Weights::Spread => (0..2 * joints).map(|i| 1.0 / largest_deviation(deviations, i)).collect(),
    }
}

/// The largest |d| of state `i`; 1 where there is none.
fn largest_deviation(deviations: &[Deviation], i: usize) -> f64 {
    let of = |deviation: &Deviation| {
        let envelope = &deviation.envelope;
        (0..envelope.len()).map(|k| envelope.upper(k, i).max(-envelope.lower(k, i))).fold(0.0, f64::max)
    };
    let largest = deviations.iter().map(of).fold(0.0, f64::max);
    if largest > 0.0 { largest } else { 1.0 }
}

/// Makes the solver's answer true (correction H of the method): the radii are scaled by the worst ratio, then checked with directed rounding, and inflated by a growing
/// last bit until the check passes.
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

/// What the check of all rows came to.
#[derive(Debug, Clone)]
struct Checked {
    rows: usize,
    failed: usize,
    largest_excess: f64,
    tight: Vec<TightRow>,
}

fn check_all(
    sets: &UncertaintySets,
    grids: &Grids,
    settings: &Settings,
    deviations: &[Vec<Deviation>],
) -> Checked {
    let reach: Vec<ReachSets> = grids
        .as_slice()
        .iter()
        .map(|grid| ReachSets::new(&grid.propagation, &grid.gains, &sets.initial_set, &sets.input_set))
        .collect();
    let mut checked = Checked { rows: 0, failed: 0, largest_excess: f64::NEG_INFINITY, tight: Vec::new() };
    for (suite, deviations) in deviations.iter().enumerate() {
        for deviation in deviations {
            let grid = &grids.as_slice()[deviation.grid];
            check_rows(grid, &reach[deviation.grid], sets, settings.states, deviation, |row| {
                checked.take(suite, row);
            });
        }
    }
    checked.tight.sort_by(|a, b| b.row.excess.total_cmp(&a.row.excess));
    checked
}

impl Checked {
    fn take(&mut self, suite: usize, row: Row) {
        self.rows += 1;
        // A NaN would be no proof.
        let proved = row.excess <= 0.0;
        self.failed += usize::from(!proved);
        self.largest_excess = self.largest_excess.max(row.excess);
        if row.excess >= -TIGHT * row.radius {
            self.tight.push(TightRow { suite, row });
        }
    }

    fn proof(&self, settings: &Settings, runs: usize) -> Proof {
        let states = match settings.states {
            super::States::All => "position and velocity",
            super::States::Positions => "position",
        };
        Proof {
            verified: self.failed == 0 && self.rows > 0,
            claim: format!(
                "for each of the {runs} recordings, at each of its samples, the recorded {states} of every joint lies in the interval hull of the model's \
                 reachable set; checked with directed rounding, at samples"
            ),
            rows: self.rows,
            proved: self.rows - self.failed,
            runs,
            largest_excess: self.largest_excess,
        }
    }
}

/// Motions that touch the reachable set, among all motions: the rows of support are among the tight ones.
fn trust(recordings: &Recordings, tight: &[TightRow]) -> Trust {
    let motion_of =
        |suite: &super::Suite| suite.entry.motion.clone().unwrap_or_else(|| suite.entry.name.clone());
    let known = recordings.suites.iter().all(|suite| suite.entry.motion.is_some());
    let all: std::collections::BTreeSet<String> = recordings.suites.iter().map(motion_of).collect();
    let deciding: std::collections::BTreeSet<String> =
        tight.iter().map(|tight| motion_of(&recordings.suites[tight.suite])).collect();
    Trust::of_fit(all.len(), deciding.len(), known)
}
