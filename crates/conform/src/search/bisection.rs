//! Uncertainty sets by bisection of one radius after the other (end of Sec. IV-C of the paper), a
//! baseline.

use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use crate::data::case::Case;
use crate::error::Result;
use crate::flowpipes::{Effort, Enclosed, enclosed};
use crate::found::SearchSummary;
use crate::progress::Progress;
use crate::rows::Edge;
use crate::search::journal::Journal;
use crate::search::state::SearchState;
use crate::search::successive::{SearchResult, SuccessiveLinearisation};
use crate::sets::UncertaintySets;

/// Part of its first value to which a radius is found.
const TOLERANCE: f64 = 0.01;

/// Factors on the linearised radii that are tried first, one after the other.
const FACTORS: [f64; 6] = [1.0, 1.05, 1.1, 1.25, 1.5, 2.0];

/// The state of the bisection.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct BisectionState {
    /// The smallest sets so far that enclose every recording, or the candidate before one was
    /// found.
    sets: UncertaintySets,
    /// Index of the next of [`FACTORS`], while none has enclosed every recording.
    factor: usize,
    enclosed: bool,
    /// Index of the radius that is bisected: first the radii of X0, then of U.
    radius: usize,
    /// A value of it that is too small.
    low: f64,
    /// The value at which its bisection started.
    first: f64,
    /// How often the reachable sets of all cases were computed.
    reachable_sets: usize,
}

/// Enlarges the sets of the first linearisation until they enclose every recording, then makes one
/// radius after the other as small as it can be while the others stay.
///
/// # Errors
///
/// As [`SuccessiveLinearisation::run`].
pub(super) fn run<'a>(
    search: &'a SuccessiveLinearisation,
    journal: &Journal,
    progress: &dyn Progress,
) -> Result<SearchResult<'a>> {
    let linearised = search.round(&mut SearchState::start(search.problem.joints()))?.solution.sets;
    let mut state = journal.load()?.unwrap_or_else(|| BisectionState::start(&linearised));
    while !state.enclosed && state.factor < FACTORS.len() {
        progress.go_on()?;
        let factor = FACTORS[state.factor];
        state.sets = linearised.inflated(factor, 0.0);
        search.problem.limits().shrink(&mut state.sets.initial_set);
        state.enclosed = encloses(search, &state.sets)?;
        state.first = state.radius_now();
        (state.factor, state.reachable_sets) = (state.factor + 1, state.reachable_sets + 1);
        journal.save(&state)?;
        let words = if state.enclosed {
            "enclose every recording"
        } else {
            "do not enclose every recording"
        };
        progress.finished(&format!("{factor} times the linearised radii {words}"));
    }
    while state.enclosed && state.radius < state.count() {
        while !state.is_narrow() {
            progress.go_on()?;
            state.halve(search)?;
            journal.save(&state)?;
        }
        let (done, count, radius) = (state.radius + 1, state.count(), state.radius_now());
        state.next();
        journal.save(&state)?;
        progress.finished(&format!(
            "radius {done} of {count}: {radius:.6}, {} reachable sets",
            state.reachable_sets
        ));
    }
    state.result(search)
}

/// Returns whether the reachable sets under `sets` enclose every recording.
fn encloses(search: &SuccessiveLinearisation, sets: &UncertaintySets) -> Result<bool> {
    let of_case =
        |case: &Case| Ok(enclosed(search.problem, case, sets, Effort::Quick)? == Enclosed::Yes);
    // The first case that is not enclosed, or fails, ends the others.
    let outside = search.cases.par_iter().map(of_case).find_any(|all| !matches!(all, Ok(true)));
    outside.unwrap_or(Ok(true))
}

impl BisectionState {
    fn start(linearised: &UncertaintySets) -> Self {
        let sets = linearised.clone();
        Self {
            sets,
            factor: 0,
            enclosed: false,
            radius: 0,
            low: 0.0,
            first: 0.0,
            reachable_sets: 0,
        }
    }

    fn count(&self) -> usize {
        self.sets.initial_set.dimension() + self.sets.input_set.dimension()
    }

    fn radius_now(&self) -> f64 {
        let (x, u) = (&self.sets.initial_set.radius, &self.sets.input_set.radius);
        x.iter().chain(u).nth(self.radius).copied().unwrap_or(0.0)
    }

    fn with_radius(&self, value: f64) -> UncertaintySets {
        let mut sets = self.sets.clone();
        let (x, u) = (&mut sets.initial_set.radius, &mut sets.input_set.radius);
        if let Some(radius) = x.iter_mut().chain(u).nth(self.radius) {
            *radius = value;
        }
        sets
    }

    fn is_narrow(&self) -> bool {
        self.radius_now() - self.low <= TOLERANCE * self.first
    }

    /// Bisects once.
    fn halve(&mut self, search: &SuccessiveLinearisation) -> Result<()> {
        // The first guess is no uncertainty at all.
        let guess = if self.low == 0.0 && self.radius_now() == self.first {
            0.0
        } else {
            0.5 * (self.low + self.radius_now())
        };
        let sets = self.with_radius(guess);
        self.reachable_sets += 1;
        if encloses(search, &sets)? {
            self.sets = sets;
        } else {
            self.low = guess.max(TOLERANCE * 0.5 * self.first);
        }
        Ok(())
    }

    fn next(&mut self) {
        self.radius += 1;
        self.low = 0.0;
        self.first = self.radius_now();
    }

    fn result<'a>(self, search: &'a SuccessiveLinearisation) -> Result<SearchResult<'a>> {
        let outer = search.outer_sets(&self.sets, &[])?;
        let mut deciding = Vec::new();
        outer.for_each_row(search.problem, |_, case, row| {
            let touches = |edge: &&Edge| edge.excess >= -TOLERANCE * row.radius;
            let sides = row.edges.iter().filter(touches).map(|edge| edge.side);
            let case = case.expect("these hulls belong to cases");
            deciding.extend(sides.map(|side| (case, row.sample, row.state, side)));
        })?;
        let reachable_sets = self.reachable_sets + 1;
        let summary =
            SearchSummary { rounds: 1, reachable_sets, linearised_cost: None, runs_away: None };
        let (sets, directions) = (self.sets, Vec::new());
        Ok(SearchResult { sets, program: None, outer, directions, deciding, summary })
    }
}
