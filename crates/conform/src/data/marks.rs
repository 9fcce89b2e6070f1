use reachtube_recordings::Run;
use serde::{Deserialize, Serialize};

/// Number of states that are kept of a run at most.
const MOST_MARKS: usize = 64;

/// Some states of a run, at the multiples of a power of two of samples. They stay in memory for
/// some runs of every suite, so that runs can be compared without reading them again.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct Marks {
    /// Samples from one to the next, a power of two.
    pub stride: usize,
    /// The states, row-major, marks x 2n.
    states: Vec<f64>,
    dimension: usize,
}

impl Marks {
    pub(super) fn new(run: &Run) -> Self {
        let stride = run.len().div_ceil(MOST_MARKS).next_power_of_two();
        let dimension = run.dimension();
        let mut states = Vec::with_capacity(run.len().div_ceil(stride) * dimension);
        (0..run.len()).step_by(stride).for_each(|k| states.extend_from_slice(run.state(k)));
        Self { stride, states, dimension }
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.states.is_empty()
    }

    pub(crate) fn clear(&mut self) {
        self.states = Vec::new();
    }

    /// Returns whether its parts have states of `dimension` entries.
    pub(crate) fn is_valid_for(&self, dimension: usize) -> bool {
        self.dimension == dimension
            && self.stride.is_power_of_two()
            && self.states.len().is_multiple_of(dimension)
    }

    /// Returns the last sample that is a multiple of `stride`, which is one of this run's or a
    /// greater power of two.
    pub(crate) fn last(&self, stride: usize) -> usize {
        let marks = self.states.len() / self.dimension;
        marks.saturating_sub(1) * self.stride / stride * stride
    }

    /// Returns the state at sample `k`, a multiple of the stride up to the last one, 2n.
    pub(crate) fn state(&self, k: usize) -> &[f64] {
        let start = k / self.stride * self.dimension;
        &self.states[start..start + self.dimension]
    }
}
