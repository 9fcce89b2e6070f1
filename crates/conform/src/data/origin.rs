//! The origin of the recordings of a problem.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::Arc;

use reachtube_recordings::{RunEntry, RunSource};

/// The origin of recordings.
#[derive(Debug, Clone)]
pub(crate) enum Origin {
    /// A source, from which they can be read again.
    Source(Arc<dyn RunSource>),
    /// A fold, with the entries that it has kept.
    Fold(Arc<BTreeMap<usize, RunEntry>>),
}

impl Origin {
    pub(crate) fn entry(&self, index: usize) -> &RunEntry {
        match self {
            Self::Source(source) => &source.runs()[index],
            Self::Fold(entries) => &entries[&index],
        }
    }

    pub(crate) fn is_simulated(&self) -> bool {
        match self {
            Self::Source(source) => source.runs().iter().any(|run| run.simulated),
            Self::Fold(_) => false,
        }
    }

    /// Returns all entries of a source, or the entries that a fold has kept.
    pub(crate) fn entries(&self) -> Box<dyn Iterator<Item = &RunEntry> + '_> {
        match self {
            Self::Source(source) => Box::new(source.runs().iter()),
            Self::Fold(entries) => Box::new(entries.values()),
        }
    }

    pub(crate) fn run_name(&self, index: usize) -> PathBuf {
        match self {
            Self::Source(source) => source.run_name(index),
            Self::Fold(entries) => PathBuf::from(&entries[&index].file),
        }
    }
}
