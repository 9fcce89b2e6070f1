//! Uncertainty sets of a model that is not linear, by successive linearisation (docs/method.md,
//! correction K).
//!
//! Each round linearises the model along every nominal motion, about the centres found so far, and
//! solves one linear program over all cases. Worst-case motions, simulated with the model itself,
//! show where it reaches further than its linearisation, and move the rows of the next round. When
//! the sets have settled, their reachable sets are enclosed. Rows outside the enclosure are asked
//! for with a margin, until every recording is enclosed.

use rayon::prelude::*;

use crate::claim::claim::Claim;
use crate::claim::look::Look;
use crate::data::case::Case;
use crate::data::problem::Problem;
use crate::data::side::Side;
use crate::error::Result;
use crate::found::SearchSummary;
use crate::hulls::Hulls;
use crate::linear::block::Block;
use crate::linear::cut::Cut;
use crate::linear::program::{Program, RowIndex, Solution};
use crate::nominal::simulate::runs_away;
use crate::progress::Progress;
use crate::search::direction::Direction;
use crate::search::directions;
use crate::search::journal::Journal;
use crate::search::sensitivity::Sensitivity;
use crate::search::state::{Margin, SearchState};
use crate::search::worst_case::Correction;
use crate::sets::UncertaintySets;
use crate::tube::polynomial::Polynomial;

/// Rounds of linearisation after which the sets are taken as they are; with margins at most twice
/// as many.
const ROUNDS: usize = 20;

/// Rounds at most where recorded points must lie in the set itself.
const ROUNDS_OF_POINTS: usize = 100;

/// Factor on what is missing with which rows outside the enclosure are asked for.
const MARGIN: f64 = 1.1;

/// A search for the smallest sets of a problem.
pub(super) struct SuccessiveLinearisation<'a> {
    pub problem: &'a Problem,
    pub cases: &'a [Case],
    /// What is asked beyond the rows.
    pub claim: &'a dyn Claim,
    /// The weights of the states in the cost, s, 2n.
    pub weights: Vec<f64>,
}

/// The sets that a search found.
pub(super) struct SearchResult<'a> {
    pub sets: UncertaintySets,
    /// The last program, with one block per case; `None` for a bisection.
    pub program: Option<Program<'a>>,
    pub outer: Hulls,
    /// The directions, other than the states, in which recorded points decide the sets, and how
    /// close the points are to what the linearised set reaches.
    pub directions: Vec<(Direction, f64)>,
    /// The rows that decide the sets: case, sample, state, side.
    pub deciding: Vec<RowIndex>,
    pub summary: SearchSummary,
}

/// One linearisation and the answer of its program.
pub(super) struct Round<'a> {
    /// The program, with one block per case.
    program: Program<'a>,
    pub solution: Solution,
    /// Where a worst-case motion under the sets of the round before ran away: case and time, s.
    pub runs_away: Option<(usize, f64)>,
}

impl SuccessiveLinearisation<'_> {
    /// Runs rounds until every row is enclosed, or no more can be done.
    ///
    /// # Errors
    ///
    /// When the model cannot be followed along a case, a program is not solved, or the journal
    /// cannot be written.
    pub(super) fn run(
        &self,
        journal: &Journal,
        progress: &dyn Progress,
    ) -> Result<SearchResult<'_>> {
        let mut state =
            journal.load()?.unwrap_or_else(|| SearchState::start(self.problem.joints()));
        loop {
            progress.go_on()?;
            // Linearise, solve, and take the answer.
            let round = self.round(&mut state)?;
            let found = &round.solution.sets;
            let is_settled = state.take(found, round.program.cost(found));
            journal.save(&state)?;
            let SearchState { rounds, cost, change, .. } = &state;
            progress.finished(&format!(
                "round {rounds}: the linearised sets cost {cost:.4}; radii and centres changed by \
                 {change:.1e}"
            ));
            if !is_settled && state.rounds < ROUNDS {
                continue;
            }
            // Enclose the reachable sets, and ask for what is outside with a margin.
            state.reachable_sets += 1;
            let outer = self.outer_sets(&state.sets, &state.directions)?;
            let missing = self.missing(&outer)?;
            let is_lost = missing.iter().any(|margin| margin.margin.is_infinite());
            let rounds = if state.directions.is_empty() { 2 * ROUNDS } else { ROUNDS_OF_POINTS };
            if is_lost || state.rounds >= rounds {
                return Ok(self.result(&state, round, outer));
            }
            let known = state.directions.len();
            let judged = outer.judged.clone().unwrap_or_default();
            let outside = judged.furthest.iter();
            let outside = outside.map(|((at, _), point)| (*at, point.direction.clone()));
            let along = self.claim.furthest(&outside.collect::<Vec<_>>())?;
            directions::take(&mut state.directions, &judged, along);
            let has_new_directions = state.directions.len() > known;
            if missing.is_empty() && !has_new_directions {
                return Ok(self.result(&state, round, outer));
            }
            if !missing.is_empty() {
                progress.finished(&format!(
                    "{} bounds are not enclosed; the next round asks for them with a margin",
                    missing.len()
                ));
            }
            if has_new_directions {
                let points = judged.unproved_count();
                progress.finished(&format!(
                    "recorded points that are not proved to lie in the set: {points}; new \
                     directions in the next round: {}",
                    state.directions.len() - known
                ));
            }
            state.add(missing);
            journal.save(&state)?;
        }
    }

    /// Computes the outer set of each case under `sets`, and how far they reach in some
    /// directions.
    ///
    /// # Guarantee
    ///
    /// As [`Claim::judge`].
    ///
    /// # Errors
    ///
    /// As [`Claim::judge`].
    pub(super) fn outer_sets(
        &self,
        sets: &UncertaintySets,
        directions: &[Direction],
    ) -> Result<Hulls> {
        let look = Look::Proof { at: None, asked: directions::asked(directions) };
        self.claim.judge(&Polynomial(self.problem), sets, &look)
    }

    fn result<'s>(
        &'s self,
        state: &SearchState,
        round: Round<'s>,
        outer: Hulls,
    ) -> SearchResult<'s> {
        let sets = state.sets.clone();
        let summary = SearchSummary {
            rounds: state.rounds,
            reachable_sets: state.reachable_sets,
            linearised_cost: Some(round.program.cost(&sets)),
            runs_away: round.runs_away.map(|(case, time)| (self.cases[case].name.clone(), time)),
        };
        let ratio = |cut: &Cut| {
            let (from_centre, reach) = round.program.reach(cut, &sets);
            from_centre / reach
        };
        let ratios = round.program.cuts.iter().map(ratio);
        SearchResult {
            deciding: round.program.tight(&sets),
            directions: state.directions.iter().cloned().zip(ratios).collect(),
            sets,
            outer,
            summary,
            program: Some(round.program),
        }
    }

    /// Linearises the model along every case, and solves the program.
    ///
    /// # Errors
    ///
    /// As [`run`](Self::run).
    pub(super) fn round(&self, state: &mut SearchState) -> Result<Round<'_>> {
        let sets = &state.sets;
        let sensitivities = self.sensitivities(sets, &state.directions)?;
        let corrections = self.corrections(state, &sensitivities);
        let ran_away = corrections.iter().enumerate();
        let runs_away =
            ran_away.filter_map(|(case, c)| c.runs_away.map(|time| (case, time))).next();
        let mut cuts = Vec::with_capacity(state.directions.len());
        let mut used = vec![0; self.cases.len()];
        for direction in &mut state.directions {
            let (sensitivity, at) = (&sensitivities[direction.case], &mut used[direction.case]);
            cuts.push(direction.cut(&sensitivity.directions[*at], sensitivity, sets));
            *at += 1;
        }
        let parts = self.cases.iter().zip(sensitivities).zip(&corrections);
        let mut blocks: Vec<Block> = parts
            .map(|((case, sensitivity), correction)| block(case, sensitivity, correction, sets))
            .collect();
        for margin in &state.margins {
            let envelope = &mut blocks[margin.case].envelope;
            envelope.widen(margin.sample, margin.state, margin.side, margin.margin);
        }
        let mut program = Program::new(self.problem.settings(), &self.weights, blocks)
            .with_centre_bounds(state.centre_bounds())
            .with_limits(self.problem.limits());
        program.cuts = cuts;
        let solution = program.solve()?;
        Ok(Round { program, solution, runs_away })
    }

    fn sensitivities(
        &self,
        sets: &UncertaintySets,
        directions: &[Direction],
    ) -> Result<Vec<Sensitivity>> {
        let (model, disturbance) =
            (self.problem.dynamics().polynomials(), self.problem.settings().disturbance);
        let of = |(index, case): (usize, &Case)| {
            let mine = directions.iter().filter(|known| known.case == index);
            let asked: Vec<&Direction> = mine.collect();
            Sensitivity::new(model, case, sets, disturbance, &asked)
                .map_err(|time| runs_away(case, time))
        };
        self.cases.par_iter().enumerate().map(of).collect()
    }

    /// Corrects the linearisation by worst-case motions; not in the first round, which has no sets
    /// yet.
    fn corrections(&self, state: &SearchState, sensitivities: &[Sensitivity]) -> Vec<Correction> {
        let model = self.problem.dynamics().polynomials();
        let of = |(case, sensitivity): (&Case, &Sensitivity)| match state.rounds {
            0 => Correction::none(case.grid.len(), 2 * case.joints()),
            _ => Correction::new(model, case, &state.sets, sensitivity),
        };
        self.cases.par_iter().zip(sensitivities).map(of).collect()
    }

    /// Returns the rows outside the reachable sets, each with what it misses and a little more.
    fn missing(&self, outer: &Hulls) -> Result<Vec<Margin>> {
        let mut missing = Vec::new();
        outer.for_each_row(self.problem, |_, case, row| {
            for edge in row.edges.iter().filter(|edge| edge.excess > 0.0) {
                missing.push(Margin {
                    case: case.expect("these hulls belong to cases"),
                    sample: row.sample,
                    state: row.state,
                    side: edge.side,
                    margin: MARGIN * edge.excess,
                });
            }
        })?;
        Ok(missing)
    }
}

/// Makes the rows of one case. With x̂ the motion from the centres c of the round before, the new
/// centres c' and radii r' must satisfy x̂ + E (c' - c) + R r' + correction >= x_m, and likewise
/// below.
fn block(
    case: &Case,
    sensitivity: Sensitivity,
    correction: &Correction,
    sets: &UncertaintySets,
) -> Block {
    let (n, states) = (case.joints(), 2 * case.joints());
    let centre: Vec<f64> =
        sets.initial_set.centre.iter().chain(&sets.input_set.centre).copied().collect();
    let from_nominal = |k: usize, i: usize, x: f64| {
        let (row, _) = sensitivity.row(n, k, i);
        let moved: f64 = row.iter().zip(&centre).map(|(e, c)| e * c).sum();
        x - sensitivity.nominal[k * states + i] + moved
    };
    let envelope = case.measured.map(
        |k, i, upper| from_nominal(k, i, upper) - correction.at(k, i, Side::Upper),
        |k, i, lower| from_nominal(k, i, lower) + correction.at(k, i, Side::Lower),
    );
    let coefficients = sensitivity.coefficients.into();
    Block { times: case.grid.times().to_vec(), coefficients, envelope }
}
