//! Where the recordings of a problem come from.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::Arc;

use reachtube_recordings::{Run, RunEntry, RunSource};

use crate::data::problem::{Problem, read_options};
use crate::error::{Error, Result};

/// Where recordings come from.
#[derive(Debug, Clone)]
pub(crate) enum Origin {
    /// A source, from which they can be read again.
    Source(Arc<dyn RunSource>),
    /// A fold, with the entries that it has kept.
    Fold(Arc<BTreeMap<usize, RunEntry>>),
}

impl Origin {
    /// Returns the entry of run `index`.
    pub(crate) fn entry(&self, index: usize) -> &RunEntry {
        match self {
            Self::Source(source) => &source.runs()[index],
            Self::Fold(entries) => &entries[&index],
        }
    }

    /// Returns the name of run `index` for messages.
    pub(crate) fn run_name(&self, index: usize) -> PathBuf {
        match self {
            Self::Source(source) => source.run_name(index),
            Self::Fold(entries) => PathBuf::from(&entries[&index].file),
        }
    }
}

impl Problem {
    /// Returns the source's entry of run `index`.
    ///
    /// # Panics
    ///
    /// Where the source has no run `index`, or the fold that the problem was made of has not kept
    /// its entry; it keeps those of the runs in [`Suite::runs`](crate::Suite::runs) and of the runs
    /// that have a bound of an envelope.
    #[must_use]
    pub fn entry(&self, index: usize) -> &RunEntry {
        self.read.origin.entry(index)
    }

    /// Returns the samples of run `index`: those in memory, or read once more where they were not
    /// kept.
    ///
    /// # Errors
    ///
    /// Defects, [`Error::Changed`] when the recording is not the one that was read first, or
    /// [`Error::Fold`] when the problem was made of a fold that has not kept them.
    pub fn run(&self, index: usize) -> Result<Cow<'_, Run>> {
        if let Some(run) = self.read.kept.get(&index) {
            return Ok(Cow::Borrowed(run));
        }
        let Origin::Source(source) = &self.read.origin else {
            return Err(Error::Fold(format!(
                "it has not kept the samples of run {index}, and this step needs them; read the \
                 recordings on one machine for it"
            )));
        };
        let run = source
            .read(index, &read_options(self.setup()))
            .map_err(reachtube_recordings::Error::Defects)?;
        let summaries = self.read.recordings.suites.iter().flat_map(|suite| &suite.runs);
        let read_first = summaries.into_iter().find(|summary| summary.index == index);
        if read_first.is_some_and(|summary| summary.sha256 != run.sha256) {
            return Err(Error::Changed { path: source.run_name(index) });
        }
        Ok(Cow::Owned(run))
    }
}
