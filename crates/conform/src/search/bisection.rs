//! Uncertainty sets by bisection of one radius after the other (end of Sec. IV-C of the paper), a
//! baseline.

use reachtube_files::Journal;
use serde::{Deserialize, Serialize};

use crate::claim::claim::Claim;
use crate::claim::look::Look;
use crate::data::problem::Problem;
use crate::error::Result;
use crate::progress::Progress;
use crate::search::found::{Deciding, Found, SearchSummary};
use crate::search::prove::encloses;
use crate::sets::UncertaintySets;
use crate::tube::flowpipes::Effort;
use crate::tube::plant::Plant;
use crate::tube::polynomial::Polynomial;
use crate::tube::state::SearchState;

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
    /// Number of times that the reachable sets of all cases were computed.
    reachable_sets: usize,
}

/// Whether reachable sets hold the recordings.
struct Trial<'a> {
    problem: &'a Problem,
    claim: &'a dyn Claim,
}

/// Enlarges the sets of the first linearisation until they hold every recording, then makes one
/// radius after the other as small as it can be while the others stay.
pub(super) fn bisect(
    problem: &Problem,
    claim: &dyn Claim,
    journal: &Journal,
    progress: &dyn Progress,
) -> Result<Found> {
    let (trial, plant) = (Trial { problem, claim }, Polynomial::new(problem));
    let first = plant.round(&mut SearchState::start(problem.shape()), None)?;
    let linearised = first.program.solve()?.sets;
    let mut state = journal.load()?.unwrap_or_else(|| BisectionState::start(&linearised));
    while !state.enclosed && state.factor < FACTORS.len() {
        progress.go_on()?;
        let factor = FACTORS[state.factor];
        state.sets = linearised.inflated(factor, 0.0);
        problem.limits().shrink(&mut state.sets.initial_set);
        state.enclosed = trial.holds(&state.sets)?;
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
            state.halve(&trial)?;
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
    let tube = claim.judge(&plant, &state.sets, &Look::proof())?;
    let costs = plant.costs(&tube)?;
    let reachable_sets = state.reachable_sets + 1;
    let search = SearchSummary { rounds: 1, reachable_sets, ..SearchSummary::default() };
    Ok(Found { search: Some(search), ..Found::new(tube, costs, Deciding::Touching(TOLERANCE)) })
}

impl Trial<'_> {
    fn holds(&self, sets: &UncertaintySets) -> Result<bool> {
        let plant = Polynomial { problem: self.problem, effort: Effort::Quick };
        let tube = self.claim.judge(&plant, sets, &Look::proof())?;
        let are_points_proved = tube.judged.as_ref().is_none_or(|judged| judged.left.is_empty());
        Ok(are_points_proved && encloses(self.problem, &tube)?)
    }
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

    fn halve(&mut self, trial: &Trial) -> Result<()> {
        // The first guess is no uncertainty at all.
        let guess = if self.low == 0.0 && self.radius_now() == self.first {
            0.0
        } else {
            0.5 * (self.low + self.radius_now())
        };
        let sets = self.with_radius(guess);
        self.reachable_sets += 1;
        if trial.holds(&sets)? {
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
}
