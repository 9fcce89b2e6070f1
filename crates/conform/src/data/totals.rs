use std::collections::BTreeMap;

use reachtube_scalar::ExactSum;
use serde::{Deserialize, Serialize};

use crate::data::stored::sums;
use crate::data::summary::RunSummary;

/// Number of runs of a suite whose notes are given in full.
pub(crate) const MOST_NOTED: usize = 20;

/// Totals of all runs of a suite. Its size does not grow with the runs, and the order in which they
/// are taken makes no difference.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct Totals {
    /// Number of runs.
    pub(crate) count: usize,
    /// The run that comes first in the source.
    pub(crate) first: usize,
    /// Number of samples of the shortest and the longest run.
    pub(crate) samples: [usize; 2],
    /// The first and the last place in the order of the suite.
    pub(crate) places: [u64; 2],
    /// The sums of the first states, 2n.
    #[serde(with = "sums")]
    pub(crate) starts: Vec<ExactSum>,
    /// The lowest and the highest of the first states, 2n.
    pub(crate) start_bounds: Vec<[f64; 2]>,
    /// The sums of the temperatures, n, over the runs that have them; empty if none has.
    #[serde(with = "sums")]
    pub(crate) temperatures: Vec<ExactSum>,
    /// The notes about the runs that come first in the source.
    pub(crate) notes: BTreeMap<usize, Vec<String>>,
    /// Number of runs that have notes.
    pub(crate) noted: usize,
}

impl Totals {
    pub(crate) fn of(run: &RunSummary) -> Self {
        let sum = |value: &f64| [*value].into_iter().collect();
        let temperatures = run.condition.temperatures.iter().flatten();
        let notes = (!run.notes.is_empty()).then(|| (run.index, run.notes.clone()));
        Self {
            count: 1,
            first: run.index,
            samples: [run.samples; 2],
            places: [run.condition.place; 2],
            starts: run.start.iter().map(sum).collect(),
            start_bounds: run.start.iter().map(|value| [*value; 2]).collect(),
            temperatures: temperatures.map(sum).collect(),
            noted: usize::from(notes.is_some()),
            notes: notes.into_iter().collect(),
        }
    }

    pub(crate) fn of_all<'a>(runs: impl IntoIterator<Item = &'a RunSummary>) -> Option<Self> {
        runs.into_iter().map(Self::of).reduce(|mut all, run| {
            all.merge(run);
            all
        })
    }

    pub(crate) fn merge(&mut self, other: Self) {
        self.count += other.count;
        self.first = self.first.min(other.first);
        merge_range(&mut self.samples, other.samples);
        merge_range(&mut self.places, other.places);
        merge_sums(&mut self.starts, &other.starts);
        for (own, [low, high]) in self.start_bounds.iter_mut().zip(other.start_bounds) {
            // By the order of all bits, so that among 0 and -0 it is always the same one.
            own[0] = if low.total_cmp(&own[0]).is_lt() { low } else { own[0] };
            own[1] = if high.total_cmp(&own[1]).is_gt() { high } else { own[1] };
        }
        merge_sums(&mut self.temperatures, &other.temperatures);
        self.noted += other.noted;
        self.notes.extend(other.notes);
        while self.notes.len() > MOST_NOTED {
            self.notes.pop_last();
        }
    }

    /// Returns whether its parts fit together and are about states of `dimension` entries.
    pub(crate) fn is_valid_for(&self, dimension: usize) -> bool {
        [self.starts.len(), self.start_bounds.len()] == [dimension; 2]
            && [0, dimension / 2].contains(&self.temperatures.len())
            && self.noted >= self.notes.len()
    }

    /// Returns the mean of the first states, 2n, rounded to nearest.
    pub(crate) fn mean_start(&self) -> Vec<f64> {
        self.starts.iter().map(ExactSum::mean).collect()
    }

    pub(crate) fn with_temperature(&self) -> usize {
        self.temperatures.first().map_or(0, |sum| sum.count() as usize)
    }

    pub(crate) fn run_notes(&self) -> impl Iterator<Item = String> {
        let more = self.noted - self.notes.len();
        let more = (more > 0).then(|| format!("{more} more recordings have such notes"));
        self.notes.values().flatten().cloned().chain(more)
    }
}

fn merge_range<T: Ord + Copy>(own: &mut [T; 2], other: [T; 2]) {
    *own = [own[0].min(other[0]), own[1].max(other[1])];
}

fn merge_sums(own: &mut Vec<ExactSum>, other: &[ExactSum]) {
    if own.is_empty() {
        own.extend_from_slice(other);
    } else {
        own.iter_mut().zip(other).for_each(|(own, other)| own.merge(other));
    }
}
