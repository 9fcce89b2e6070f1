use std::sync::Arc;

use reachtube_reach::TimeGrid;
use serde::{Deserialize, Serialize};

use crate::data::stored::{grid, values};

/// The sample times of a run and the input u along it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RunInput {
    /// The sample times.
    #[serde(with = "grid")]
    pub grid: Arc<TimeGrid>,
    /// The input u, row-major, samples x m.
    #[serde(with = "values")]
    pub inputs: Arc<[f64]>,
}

impl RunInput {
    /// Returns an input in place of one that bytes do not have.
    pub(crate) fn none() -> Self {
        Self { grid: Arc::new(TimeGrid::uniform(1.0, 0)), inputs: Arc::default() }
    }

    /// Returns whether one of two inputs is the beginning of the other. The input of a run's last
    /// sample acts on nothing and is not compared.
    pub(crate) fn shares(&self, other: &Self, dimension: usize) -> bool {
        let (short, long) =
            if self.grid.len() <= other.grid.len() { (self, other) } else { (other, self) };
        let acting = short.grid.len().saturating_sub(1) * dimension;
        short.inputs[..acting] == long.inputs[..acting] && short.grid.is_prefix_of(&long.grid)
    }
}

/// The input that some runs share: the longest one, of which the others' are the beginning. Where
/// several are as long, it is the input of the run of the smallest number, because their last
/// samples may differ.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct SharedInput {
    /// The run whose input it is.
    pub run: u32,
    /// The input.
    pub input: RunInput,
}

impl SharedInput {
    /// Returns the input that both have in common; `None` if neither is the beginning of the
    /// other. The order of merging makes no difference.
    pub(crate) fn merge(self, other: Self, dimension: usize) -> Option<Self> {
        let shares = self.input.shares(&other.input, dimension);
        let key = |of: &Self| (std::cmp::Reverse(of.input.grid.len()), of.run);
        shares.then(|| if key(&self) <= key(&other) { self } else { other })
    }
}
