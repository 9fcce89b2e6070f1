//! A search over many recordings: those near the boundary of the sets steer it.
//!
//! Derivatives cost most, and few recordings decide the sets. A search therefore moves the
//! parameters for a few recordings, and the sets of all decide whether it went well. Recordings
//! that leave the sets, or come closest to their boundary, are added.

use rayon::prelude::*;

use crate::data::side::Side;
use crate::error::Result;
use crate::fit::evaluation::{FitModel, FitTask, Smallest};
use crate::fit::group::Group;
use crate::fit::search::{FoundNumbers, Search, SearchEffort};
use crate::program::dot::dot;
use crate::program::program::RowIndex;

/// Recordings that are searched with all at once.
const MOST_AT_ONCE: usize = 16;

/// Recordings that are added in a round, the closest to the boundary first.
const CLOSEST: usize = 12;

/// Recordings of the first round beside the closest, evenly among all.
const SPREAD: usize = 8;

/// Rounds at most.
const ROUNDS: usize = 5;

/// What is searched for.
#[derive(Debug, Clone)]
pub(crate) struct Wanted {
    /// The motion that is not looked at.
    pub left_out: Option<usize>,
    /// Cost of a number's distance from 0.
    pub pull: f64,
    /// Groups whose numbers stay as they are.
    pub held: Vec<Group>,
    pub effort: SearchEffort,
}

impl FitTask<'_> {
    /// Searches the parameters for which the sets of all motions but one cost least, from `start`.
    ///
    /// # Errors
    ///
    /// As [`Search::run`].
    pub(crate) fn search(&self, wanted: &Wanted, start: &[f64]) -> Result<FoundNumbers> {
        let all = self.tracks(wanted.left_out);
        let Wanted { pull, held, effort, .. } = wanted;
        let on = |tracks: &[usize], numbers: &[f64]| {
            let (tracks, held) = (tracks.to_vec(), held.clone());
            Search { fit: self, tracks, pull: *pull, held, effort: *effort }.run(numbers)
        };
        if all.len() <= MOST_AT_ONCE {
            return on(&all, start);
        }
        let mut rows = Vec::new();
        let mut whole = |numbers: &[f64]| self.whole(numbers, &all, *pull, &mut rows);
        let mut best = whole(start)?;
        let mut found = FoundNumbers { numbers: start.to_vec(), steps: 0, value: best.value };
        let mut chosen: Vec<usize> = (0..SPREAD).map(|i| all[i * all.len() / SPREAD]).collect();
        self.add_closest(&best, &all, &mut chosen);
        for _ in 0..ROUNDS {
            let next = on(&chosen, &found.numbers)?;
            let Ok(at) = whole(&next.numbers) else { break };
            let gained = best.value - at.value;
            let is_new = self.add_closest(&at, &all, &mut chosen);
            if gained > 0.0 {
                let steps = found.steps + next.steps;
                found = FoundNumbers { numbers: next.numbers, steps, value: at.value };
                best = at;
            }
            if !is_new || (gained >= 0.0 && gained < effort.settled * best.smallest.cost) {
                break;
            }
        }
        Ok(found)
    }

    /// Returns the smallest sets of the recordings `all` at `numbers`.
    fn whole(
        &self,
        numbers: &[f64],
        all: &[usize],
        pull: f64,
        rows: &mut Vec<RowIndex>,
    ) -> Result<Whole> {
        let model = self.model(numbers, all, None)?;
        let smallest = self.smallest_from(&model, all, rows)?;
        let value = smallest.cost + pull * numbers.iter().map(|x| x.abs()).sum::<f64>();
        Ok(Whole { model, smallest, value })
    }

    /// Adds the recordings closest to the boundary of the sets to `chosen`. Returns whether one of
    /// them is new.
    fn add_closest(&self, at: &Whole, all: &[usize], chosen: &mut Vec<usize>) -> bool {
        let mut closest: Vec<(f64, usize)> =
            all.par_iter().map(|&t| (self.closeness(at, t), t)).collect();
        closest.sort_by(|a, b| b.0.total_cmp(&a.0));
        let before = chosen.len();
        for (_, t) in closest.into_iter().take(CLOSEST) {
            if !chosen.contains(&t) {
                chosen.push(t);
            }
        }
        chosen.sort_unstable();
        chosen.len() > before
    }

    /// Returns the largest excess of a recording's rows beyond the sets' reach, in parts of the
    /// radius there.
    fn closeness(&self, at: &Whole, track: usize) -> f64 {
        let (n, sets) = (self.joints(), &at.smallest.sets);
        let join = |of: [&Vec<f64>; 2]| -> Vec<f64> { of.into_iter().flatten().copied().collect() };
        let centre = join([&sets.initial_set.centre, &sets.input_set.centre]);
        let radius = join([&sets.initial_set.radius, &sets.input_set.radius]);
        let coefficients = &at.model.coefficients[self.data.tracks[track].grid];
        let states = self.settings.states.rows(2 * n);
        let samples = at.model.motions[track].len() / (2 * n);
        let mut closest = f64::NEG_INFINITY;
        for (k, i) in (0..samples).flat_map(|k| (0..states).map(move |i| (k, i))) {
            let (of_centre, of_radius) =
                coefficients[(k * 2 * n + i) * 6 * n..][..6 * n].split_at(3 * n);
            let reach = dot(of_radius, &radius) + sets.noise_radius(i);
            for side in Side::BOTH {
                let deviation = self.deviation(&at.model, (track, k, i, side))
                    - side.sign() * dot(of_centre, &centre);
                closest = closest.max((deviation - reach) / reach.max(f64::MIN_POSITIVE));
            }
        }
        closest
    }
}

/// The sets of all recordings at one choice of the parameters.
struct Whole {
    model: FitModel,
    smallest: Smallest,
    /// The cost with the pull.
    value: f64,
}
