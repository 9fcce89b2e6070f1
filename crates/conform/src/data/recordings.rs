use std::collections::HashSet;

use reachtube_recordings::{Defect, RunSource, SuiteEntry};

use crate::data::suite::{Suite, SuiteReader};
use crate::data::tree::{Leaf, Tree};
use crate::error::Result;
use crate::progress::Progress;

/// A model file lists each recording of a source of fewer recordings.
const LISTED_BELOW: usize = 10_000;

/// The suites of a source, read once, checked and folded.
#[derive(Debug)]
pub struct Recordings {
    /// The suites, in the requested order.
    pub suites: Vec<Suite>,
    /// Notes about the data for the user.
    pub notes: Vec<String>,
    /// The root of the Merkle tree over the recordings' entries, in lower-case hexadecimal.
    pub root: String,
    /// Whether a model file lists each recording: of a source of fewer than 10,000, and of a fold
    /// of fewer than 1000.
    pub(crate) are_listed: bool,
    /// What a fold has found that was made to check a model: the digest of the model's recordings,
    /// and how many recordings are among them.
    pub(crate) compared: Option<(String, u64)>,
    /// Number of recordings that were skipped because they have defects: only a fold skips any.
    pub skipped: usize,
}

impl Recordings {
    pub(super) fn read(
        reader: &SuiteReader,
        names: &[String],
        progress: &dyn Progress,
    ) -> Result<Self> {
        let source = reader.source;
        let entries = source.select(names)?;
        let total = entries.iter().map(|entry| entry.runs.len()).sum();
        let notes = index_notes(source, &entries);
        let (mut suites, mut defects, mut done) = (Vec::new(), Vec::<Defect>::new(), 0);
        for entry in entries {
            progress.go_on()?;
            let counted = |within: usize| progress.recordings_read(done + within, total);
            match reader.read(&entry, &counted) {
                Ok(suite) => suites.push(suite),
                Err(found) => defects.extend(found),
            }
            done += entry.runs.len();
        }
        if defects.is_empty() {
            let root = root(source, &suites);
            let are_listed = total < LISTED_BELOW;
            Ok(Self { suites, notes, root, are_listed, compared: None, skipped: 0 })
        } else {
            Err(reachtube_recordings::Error::Defects(defects).into())
        }
    }

    /// Returns the names of the suites with a recording whose SHA-256 is among `digests`, or may be
    /// since not every recording was kept.
    pub(crate) fn suites_among(&self, digests: &[String]) -> Vec<&str> {
        let digests: HashSet<&str> = digests.iter().map(String::as_str).collect();
        let is_among = |suite: &&Suite| {
            let is_unknown = !digests.is_empty() && suite.every_run().is_err();
            is_unknown || suite.runs.iter().any(|run| run.is_among(&digests))
        };
        self.suites.iter().filter(is_among).map(|suite| suite.entry.name.as_str()).collect()
    }

    /// Returns what all recordings are parts of, if they are: one log, or one motion.
    pub(crate) fn are_parts_of(&self) -> Option<&'static str> {
        let mut runs = self.suites.iter().flat_map(|suite| &suite.runs);
        let first = runs.clone().next()?;
        match first.origin.is_some() && runs.clone().all(|run| run.origin == first.origin) {
            true => Some("one log"),
            false => runs.all(|run| run.is_part).then_some("one motion"),
        }
    }

    /// Returns the number of runs.
    #[must_use]
    pub fn run_count(&self) -> usize {
        self.suites.iter().map(Suite::run_count).sum()
    }
}

fn index_notes(source: &dyn RunSource, chosen: &[SuiteEntry]) -> Vec<String> {
    let (used, all) = (chosen.iter().map(|entry| entry.runs.len()).sum::<usize>(), source.runs());
    let mut notes = Vec::new();
    if used < all.len() {
        let without = all.iter().filter(|run| run.suite.is_none()).count();
        notes.push(format!(
            "{used} of the {} runs in {} are used: {} belong to suites that were not selected, \
             {without} to no suite",
            all.len(),
            source.index_name().display(),
            all.len() - used - without,
        ));
    }
    notes.extend(source.notes());
    notes
}

/// Returns the root of the Merkle tree over the entries of the runs of `suites`.
fn root(source: &dyn RunSource, suites: &[Suite]) -> String {
    let mut tree = Tree::default();
    for suite in suites {
        for run in &suite.runs {
            let (file, suite) = (source.runs()[run.index].file.as_str(), &*suite.entry.name);
            let place = u32::try_from(run.index).expect("an envelope numbers runs with 32 bits");
            let is_new = tree.insert(place, Leaf { file, suite, sha256: &run.sha256 });
            debug_assert!(is_new, "a run belongs to one suite");
        }
    }
    tree.root()
}
