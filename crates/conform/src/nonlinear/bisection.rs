//! Uncertainty sets by bisection of one radius after the other (end of Sec. IV-C of the paper), a
//! baseline.

use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use super::case::Case;
use super::journal::Journal;
use super::outer::{Effort, check_outer, flowpipes};
use super::search::Search;
use super::{Found, search};
use crate::error::Result;
use crate::{Search as Record, UncertaintySets};

/// A radius is found to this part of where its bisection starts.
const TOLERANCE: f64 = 0.01;

/// Factors on the linearised radii that are tried one after the other to begin with.
const FACTORS: [f64; 6] = [1.0, 1.05, 1.1, 1.25, 1.5, 2.0];

/// How far the bisection has come.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Progress {
    /// The smallest sets so far that enclose every recording; none before one was found.
    sets: UncertaintySets,
    /// Next of [`FACTORS`], while none has enclosed every recording.
    factor: usize,
    enclosed: bool,
    /// The radius in work, of X0, then U, and a radius of it that is too small.
    radius: usize,
    low: f64,
    /// Where its bisection started.
    first: f64,
    /// Sets of reachable sets computed.
    reachable_sets: usize,
}

/// Starts from the sets of the first linearisation, enlarged until they enclose every recording,
/// and makes one radius after the other as small as it can be while the others stay.
///
/// # Errors
///
/// As [`Search::run`].
pub(super) fn run(search: &Search, journal: &Journal, finished: &dyn Fn(&str)) -> Result<Found> {
    let linearised = search.round(&search::Progress::start(search.model.joints()))?.solution.sets;
    let mut progress = journal.load()?.unwrap_or_else(|| Progress::start(&linearised));
    while !progress.enclosed && progress.factor < FACTORS.len() {
        let factor = FACTORS[progress.factor];
        progress.sets = linearised.inflated(factor, 0.0);
        progress.enclosed = encloses(search, &progress.sets)?;
        progress.first = progress.radius_now();
        (progress.factor, progress.reachable_sets) =
            (progress.factor + 1, progress.reachable_sets + 1);
        journal.save(&progress)?;
        let words = if progress.enclosed {
            "enclose every recording"
        } else {
            "do not enclose every recording"
        };
        finished(&format!("{factor} times the linearised radii {words}"));
    }
    while progress.enclosed && progress.radius < progress.count() {
        while !progress.is_narrow() {
            progress.halve(search)?;
            journal.save(&progress)?;
        }
        let (done, count, radius) = (progress.radius + 1, progress.count(), progress.radius_now());
        progress.next();
        journal.save(&progress)?;
        finished(&format!(
            "radius {done} of {count}: {radius:.6}, {} reachable sets",
            progress.reachable_sets
        ));
    }
    progress.found(search)
}

fn encloses(search: &Search, sets: &UncertaintySets) -> Result<bool> {
    let of_case = |case: &Case| -> Result<bool> {
        let flowpipe = flowpipes(search.system, std::slice::from_ref(case), sets, Effort::Quick)?;
        let mut all = true;
        check_outer(case, &flowpipe[0], sets, search.settings.states, |row| {
            all &= row.excess <= 0.0
        });
        Ok(all)
    };
    // The first case that is left out, or fails, ends the others.
    let left_out = search.cases.par_iter().map(of_case).find_any(|all| !matches!(all, Ok(true)));
    left_out.unwrap_or(Ok(true))
}

impl Progress {
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

    /// One bisection.
    fn halve(&mut self, search: &Search) -> Result<()> {
        // None at all is the first guess.
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

    fn found(self, search: &Search) -> Result<Found> {
        let flowpipes = flowpipes(search.system, search.cases, &self.sets, Effort::Whole)?;
        let mut deciding = Vec::new();
        for (index, (case, flowpipe)) in search.cases.iter().zip(&flowpipes).enumerate() {
            check_outer(case, flowpipe, &self.sets, search.settings.states, |row| {
                if row.excess >= -TOLERANCE * row.radius {
                    deciding.push((index, row.sample, row.state, row.side));
                }
            });
        }
        let reachable_sets = self.reachable_sets + 1;
        let record = Record { rounds: 1, reachable_sets, linearised_cost: None, runs_away: None };
        Ok(Found { sets: self.sets, flowpipes, deciding, search: record })
    }
}
