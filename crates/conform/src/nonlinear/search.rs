//! Uncertainty sets of a model that is not linear, by successive linearisation (correction K of the
//! method).
//!
//! Each round linearises the model along every nominal, about the centres found so far, and solves
//! one linear program over all cases. What the model itself does beyond its linearisation is found
//! by simulating the extremal motions, and moves the rows of the next round. When the sets have
//! settled, the reachable sets are enclosed; a row that they leave out is asked for with a margin,
//! and so on until every recording is enclosed.

use std::collections::HashMap;
use std::ops::Range;

use rayon::prelude::*;
use reachtube_reach::{Flowpipe, Hyperrectangle, PolynomialSystem};
use serde::{Deserialize, Serialize};

use super::case::Case;
use super::extremal::Correction;
use super::journal::Journal;
use super::outer::{Effort, check_outer, flowpipes};
use super::sensitivity::Sensitivity;
use super::{Found, runs_away};
use crate::error::Result;
use crate::program::{Block, Program, Solution};
use crate::{Search as Record, Settings, Side, UncertaintySets};
use reachtube_abstraction::PolynomialModel;

/// Rounds of linearisation after which the sets are taken as they are; twice as many with margins
/// at most.
const ROUNDS: usize = 20;

/// The sets have settled when no radius or centre changes by more than this part of the largest.
const SETTLED: f64 = 1e-5;

/// Or when the cost of the linearised sets changes by less than this part: where the program has
/// several answers, the sets may wander among them.
const SAME_COST: f64 = 1e-6;

/// The change of a round is this part of the one before at most, or centres get less freedom.
const SHRINKS: f64 = 0.8;

/// Rows that are not enclosed are asked for with this much more than what is missing.
const MARGIN: f64 = 1.1;

/// What is searched for, and over what.
#[derive(Debug)]
pub(super) struct Search<'a> {
    pub model: &'a PolynomialModel,
    pub system: &'a PolynomialSystem,
    pub cases: &'a [Case],
    pub settings: &'a Settings,
    /// s, 2n.
    pub weights: Vec<f64>,
}

/// How far the search has come: all that the next round depends on.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Progress {
    /// Rounds done.
    pub rounds: usize,
    /// How often the reachable sets were computed.
    pub reachable_sets: usize,
    /// The cost of the linearised sets after the last round.
    pub cost: f64,
    /// How far that round's program was from the sets before it.
    pub change: f64,
    /// How far centres may move in the next round, in parts of the largest centre or radius of
    /// their kind.
    pub freedom: f64,
    /// The sets after them.
    pub sets: UncertaintySets,
    /// By how much more than the recordings ask for the rows that were not enclosed must be
    /// reached.
    pub margins: Vec<Margin>,
}

/// A row that must be reached with a margin.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Margin {
    case: usize,
    sample: usize,
    state: usize,
    side: Side,
    /// rad or rad/s.
    margin: f64,
}

/// One linearisation, and what its program gave.
pub(super) struct Round<'a> {
    /// A block is a case.
    program: Program<'a>,
    pub solution: Solution,
    /// Where an extremal motion under the sets of the round before ran away: case and time, s.
    pub runs_away: Option<(usize, f64)>,
}

impl Progress {
    /// Before the first round: no uncertainty.
    pub fn start(joints: usize) -> Self {
        let (initial_set, input_set) =
            (Hyperrectangle::zero(2 * joints), Hyperrectangle::zero(joints));
        let sets = UncertaintySets { initial_set, input_set, noise_set: None };
        Self {
            rounds: 0,
            reachable_sets: 0,
            cost: 0.0,
            change: f64::MAX,
            freedom: f64::MAX,
            sets,
            margins: Vec::new(),
        }
    }

    /// Takes the answer of a program; whether the sets have settled. Where answers jump back and
    /// forth, as those that are worth the same may do, centres get less freedom.
    fn take(&mut self, round: &Round) -> bool {
        let (change, cost) =
            (change(&self.sets, &round.solution.sets), round.program.cost(&round.solution.sets));
        if change > SHRINKS * self.change {
            self.freedom = 0.5 * self.freedom.min(change);
        }
        let is_settled = change <= SETTLED || (cost - self.cost).abs() <= SAME_COST * cost;
        self.sets = round.solution.sets.clone();
        (self.change, self.cost, self.rounds) = (change, cost, self.rounds + 1);
        is_settled
    }

    /// Where the centres of X0 and U may be in the next round; empty for anywhere.
    fn centers(&self) -> Vec<[f64; 2]> {
        if self.freedom == f64::MAX {
            return Vec::new();
        }
        let n = self.sets.input_set.dimension();
        let around = |set: &Hyperrectangle, kind: Range<usize>| {
            let reach = self.freedom * largest(set, kind.clone());
            set.center[kind].iter().map(|c| [c - reach, c + reach]).collect::<Vec<_>>()
        };
        let (x, u) = (&self.sets.initial_set, &self.sets.input_set);
        [around(x, 0..n), around(x, n..2 * n), around(u, 0..n)].concat()
    }

    /// Margins of one row add up.
    fn add(&mut self, missing: Vec<Margin>) {
        self.change = f64::MAX;
        let places = self.margins.iter().enumerate().map(|(at, margin)| (margin.row(), at));
        let known: HashMap<_, usize> = places.collect();
        for new in missing {
            match known.get(&new.row()) {
                Some(&at) => self.margins[at].margin += new.margin,
                None => self.margins.push(new),
            }
        }
    }
}

impl Margin {
    fn row(&self) -> (usize, usize, usize, Side) {
        (self.case, self.sample, self.state, self.side)
    }
}

impl Search<'_> {
    /// Runs rounds until every row is enclosed, or no more can be done; `finished` is told what
    /// each came to.
    ///
    /// # Errors
    ///
    /// Where the model cannot be followed along a case, a program is not solved, or the journal
    /// cannot be written.
    pub fn run(&self, journal: &Journal, finished: &dyn Fn(&str)) -> Result<Found> {
        let mut progress: Progress =
            journal.load()?.unwrap_or_else(|| Progress::start(self.model.joints()));
        loop {
            let round = self.round(&progress)?;
            let is_settled = progress.take(&round);
            journal.save(&progress)?;
            let Progress { rounds, cost, change, .. } = &progress;
            finished(&format!(
                "round {rounds}: the linearised sets cost {cost:.4}, radii and centres changed by {change:.1e}"
            ));
            if !is_settled && progress.rounds < ROUNDS {
                continue;
            }
            progress.reachable_sets += 1;
            let flowpipes = flowpipes(self.system, self.cases, &progress.sets, Effort::Whole)?;
            let missing = self.missing(&flowpipes, &progress.sets);
            let is_lost = missing.iter().any(|margin| margin.margin.is_infinite());
            if missing.is_empty() || is_lost || progress.rounds >= 2 * ROUNDS {
                return Ok(self.found(&progress, round, flowpipes));
            }
            finished(&format!(
                "{} rows are not enclosed and are asked for with a margin",
                missing.len()
            ));
            progress.add(missing);
            journal.save(&progress)?;
        }
    }

    fn found(&self, progress: &Progress, round: Round, flowpipes: Vec<Flowpipe>) -> Found {
        let sets = progress.sets.clone();
        let runs_away = round.runs_away.map(|(case, time)| (self.cases[case].name.clone(), time));
        let (rounds, reachable_sets) = (progress.rounds, progress.reachable_sets);
        let linearised_cost = Some(round.program.cost(&sets));
        let search = Record { rounds, reachable_sets, linearised_cost, runs_away };
        Found { deciding: round.program.tight(&sets), sets, flowpipes, search }
    }

    /// Linearises, and solves the program.
    ///
    /// # Errors
    ///
    /// As [`run`](Self::run).
    pub fn round(&self, progress: &Progress) -> Result<Round<'_>> {
        let sets = &progress.sets;
        let sensitivities = self.sensitivities(sets)?;
        let corrections = self.corrections(progress, &sensitivities);
        let ran_away = corrections.iter().enumerate();
        let runs_away =
            ran_away.filter_map(|(case, c)| c.runs_away.map(|time| (case, time))).next();
        let parts = self.cases.iter().zip(sensitivities).zip(&corrections);
        let mut blocks: Vec<Block> = parts
            .map(|((case, sensitivity), correction)| block(case, sensitivity, correction, sets))
            .collect();
        for margin in &progress.margins {
            let envelope = &mut blocks[margin.case].envelope;
            envelope.widen(margin.sample, margin.state, margin.side, margin.margin);
        }
        let program =
            Program::new(self.settings, &self.weights, blocks).with_centers(progress.centers());
        let solution = program.solve()?;
        Ok(Round { program, solution, runs_away })
    }

    fn sensitivities(&self, sets: &UncertaintySets) -> Result<Vec<Sensitivity>> {
        let of = |case: &Case| {
            Sensitivity::new(self.model, case, sets, self.settings.disturbance)
                .map_err(|time| runs_away(case, time))
        };
        self.cases.par_iter().map(of).collect()
    }

    /// None in the first round, which has no sets yet.
    fn corrections(&self, progress: &Progress, sensitivities: &[Sensitivity]) -> Vec<Correction> {
        let of = |(case, sensitivity): (&Case, &Sensitivity)| match progress.rounds {
            0 => Correction::none(case.grid.len(), 2 * case.joints()),
            _ => Correction::new(self.model, case, &progress.sets, sensitivity),
        };
        self.cases.par_iter().zip(sensitivities).map(of).collect()
    }

    /// The rows that the reachable sets leave out, with what they miss and a little more.
    fn missing(&self, flowpipes: &[Flowpipe], sets: &UncertaintySets) -> Vec<Margin> {
        let mut missing = Vec::new();
        for (index, (case, flowpipe)) in self.cases.iter().zip(flowpipes).enumerate() {
            check_outer(case, flowpipe, sets, self.settings.states, |row| {
                if row.excess > 0.0 {
                    let (sample, state, side) = (row.sample, row.state, row.side);
                    missing.push(Margin {
                        case: index,
                        sample,
                        state,
                        side,
                        margin: MARGIN * row.excess,
                    });
                }
            });
        }
        missing
    }
}

/// The rows of one case. With x̂ the motion from the centres c of the sets of the round before, the
/// new ones must satisfy x̂ + E (c' - c) + R r' + further >= x_m, and the like below.
fn block(
    case: &Case,
    sensitivity: Sensitivity,
    correction: &Correction,
    sets: &UncertaintySets,
) -> Block {
    let (n, states) = (case.joints(), 2 * case.joints());
    let center: Vec<f64> =
        sets.initial_set.center.iter().chain(&sets.input_set.center).copied().collect();
    let from_nominal = |k: usize, i: usize, x: f64| {
        let (row, _) = sensitivity.row(n, k, i);
        let moved: f64 = row.iter().zip(&center).map(|(e, c)| e * c).sum();
        x - sensitivity.nominal[k * states + i] + moved
    };
    let envelope = case.measured.map(
        |k, i, upper| from_nominal(k, i, upper) - correction.at(k, i, Side::Upper),
        |k, i, lower| from_nominal(k, i, lower) + correction.at(k, i, Side::Lower),
    );
    Block { times: case.grid.times().to_vec(), coefficients: sensitivity.coefficients, envelope }
}

/// The largest change of a centre or radius, in parts of the largest of its kind: positions,
/// velocities, inputs.
fn change(old: &UncertaintySets, new: &UncertaintySets) -> f64 {
    let n = new.input_set.dimension();
    let of_kind = |old: &Hyperrectangle, new: &Hyperrectangle, kind: Range<usize>| {
        let pairs = |x: &[f64], y: &[f64]| -> f64 {
            kind.clone().map(|i| (x[i] - y[i]).abs()).fold(0.0, f64::max)
        };
        let change = pairs(&old.center, &new.center).max(pairs(&old.radius, &new.radius));
        if change == 0.0 { 0.0 } else { change / largest(new, kind) }
    };
    let (x, u) = ((&old.initial_set, &new.initial_set), (&old.input_set, &new.input_set));
    [of_kind(x.0, x.1, 0..n), of_kind(x.0, x.1, n..2 * n), of_kind(u.0, u.1, 0..n)]
        .into_iter()
        .fold(0.0, f64::max)
}

/// The largest magnitude of a centre or radius.
fn largest(set: &Hyperrectangle, kind: Range<usize>) -> f64 {
    set.center[kind.clone()].iter().chain(&set.radius[kind]).fold(0.0, |max, x| max.max(x.abs()))
}
