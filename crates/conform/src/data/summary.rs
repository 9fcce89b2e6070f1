use std::collections::HashSet;
use std::sync::Arc;

use reachtube_reach::TimeGrid;
use reachtube_recordings::{Run, RunEntry, noise_deviations, run_notes};
use serde::{Deserialize, Serialize};

use crate::data::condition::Condition;
use crate::data::marks::Marks;
use crate::data::stored::condition;

/// Number of runs of a suite whose marks are kept and which its statistics are of: that many are
/// drawn from a larger suite.
pub(crate) const SAMPLE: usize = 256;

/// Summary of a run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RunSummary {
    /// Index in the source.
    #[serde(skip)]
    pub index: usize,
    /// Number of samples.
    pub samples: usize,
    /// Time from the first to the last sample, s.
    pub duration: f64,
    /// The run's grid, or a longer one of the suite that it is the beginning of: runs of one rate
    /// share one.
    #[serde(skip, default = "no_grid")]
    pub grid: Arc<TimeGrid>,
    /// The first state, 2n.
    pub start: Vec<f64>,
    /// What the samples up to the first one tell of it, 2n; empty if there are none.
    pub(crate) told_start: Vec<f64>,
    /// Some of its states; none if the run is not drawn from a suite of more than 256.
    pub(crate) marks: Marks,
    /// The conditions that friction may depend on.
    #[serde(with = "condition")]
    pub condition: Condition,
    /// SHA-256 of the recording.
    pub sha256: String,
    /// SHA-256 of the log that it was cut from, if it was cut from one.
    #[serde(skip)]
    pub origin: Option<String>,
    /// Whether the robot rests in that log.
    #[serde(skip)]
    pub at_rest: bool,
    /// Whether its motion is one of the parts of a single motion.
    #[serde(skip)]
    pub is_part: bool,
    /// The standard deviation of the noise in each state, 2n, as
    /// [`noise_deviations`](reachtube_recordings::noise_deviations) estimates it, and at least what
    /// was measured before a filter.
    pub noise: Option<Vec<f64>>,
    /// Notes about the run for the user.
    pub notes: Vec<String>,
}

impl RunSummary {
    /// Sums up run `index` of a source, whose entry there is `entry`.
    pub(crate) fn new(index: usize, entry: &RunEntry, run: &Run, grid: Arc<TimeGrid>) -> Self {
        let end = run.len().saturating_sub(1);
        Self {
            index,
            samples: run.len(),
            duration: grid.times().get(end).copied().unwrap_or(0.0),
            grid,
            start: run.state(0).to_vec(),
            told_start: run.before.get(..run.dimension()).unwrap_or_default().to_vec(),
            marks: Marks::new(run),
            condition: Condition::of(entry.order, run),
            sha256: run.sha256.clone(),
            origin: entry.origin.clone(),
            at_rest: entry.at_rest,
            is_part: entry.is_part,
            noise: noise(entry, run),
            notes: run_notes(entry, run),
        }
    }
}

impl RunSummary {
    /// Returns whether it, or the log that it was cut from, is among some SHA-256.
    pub(crate) fn is_among(&self, digests: &HashSet<&str>) -> bool {
        let own = std::iter::once(&self.sha256).chain(&self.origin);
        own.into_iter().any(|sha256| digests.contains(sha256.as_str()))
    }

    /// Returns whether its parts are about states of `dimension` entries.
    pub(crate) fn is_valid_for(&self, dimension: usize) -> bool {
        let temperatures = self.condition.temperatures.as_ref();
        self.start.len() == dimension
            && (self.told_start.is_empty() || self.told_start.len() == dimension)
            && self.marks.is_valid_for(dimension)
            && self.noise.as_ref().is_none_or(|noise| noise.len() == dimension)
            && temperatures.is_none_or(|all| 2 * all.len() == dimension)
    }
}

/// Returns the noise that a recording shows, and at least the noise that its entry knows.
fn noise(entry: &RunEntry, run: &Run) -> Option<Vec<f64>> {
    let shown = noise_deviations(run);
    let known = entry.noise.as_ref().filter(|known| known.len() == run.dimension());
    match (known, shown) {
        (Some(known), Some(shown)) => {
            Some(known.iter().zip(shown).map(|(known, shown)| known.max(shown)).collect())
        }
        (known, shown) => known.cloned().or(shown),
    }
}

/// Returns a grid in place of one that bytes do not have.
fn no_grid() -> Arc<TimeGrid> {
    Arc::new(TimeGrid::uniform(1.0, 0))
}

/// Returns the 256 runs with the lowest SHA-256, or all of fewer, in the order of their indices. A
/// sample of the samples of parts is the sample of the whole, and copies of a run are drawn with
/// it.
pub(crate) fn sampled<'a>(
    runs: impl IntoIterator<Item = &'a RunSummary>,
) -> impl Iterator<Item = &'a RunSummary> {
    let mut sample: Vec<&RunSummary> = runs.into_iter().collect();
    if sample.len() > SAMPLE {
        sample.sort_unstable_by_key(|run| (&run.sha256, run.index));
        sample.truncate(SAMPLE);
        sample.sort_unstable_by_key(|run| run.index);
    }
    sample.into_iter()
}
