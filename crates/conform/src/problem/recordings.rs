use reachtube_recordings::{Defect, RunSource, SuiteEntry, copies_note};

use crate::error::Result;
use crate::problem::suite::{Suite, SuiteReader};
use crate::progress::Progress;
use crate::settings::NominalStart;

/// The suites of a source, read once, checked and folded.
#[derive(Debug)]
pub struct Recordings {
    /// The suites, in the order asked for.
    pub suites: Vec<Suite>,
    /// What a user should know about the data, in words.
    pub notes: Vec<String>,
}

impl Recordings {
    /// Reads the suites named.
    ///
    /// # Errors
    ///
    /// Every defect of every run, or an unknown suite.
    pub(super) fn read(
        reader: &SuiteReader,
        names: &[String],
        progress: &dyn Progress,
    ) -> Result<Self> {
        let source = reader.source;
        let entries = source.select(names)?;
        let total = entries.iter().map(|entry| entry.runs.len()).sum();
        let mut notes = index_notes(source, &entries);
        let (mut suites, mut defects, mut done) = (Vec::new(), Vec::<Defect>::new(), 0);
        for entry in entries {
            progress.go_on()?;
            let counted = |within: usize| progress.recordings_read(done + within, total);
            match reader.read(&entry, &counted) {
                Ok(suite) => {
                    notes.extend(suite_notes(&suite, reader));
                    suites.push(suite);
                }
                Err(found) => defects.extend(found),
            }
            done += entry.runs.len();
        }
        let runs = suites.iter().flat_map(|suite| &suite.runs);
        notes.extend(copies_note(source, runs.map(|run| (run.index, run.sha256.as_str()))));
        if defects.is_empty() {
            Ok(Self { suites, notes })
        } else {
            Err(reachtube_recordings::Error::Defects(defects).into())
        }
    }

    /// Returns the number of runs.
    #[must_use]
    pub fn run_count(&self) -> usize {
        self.suites.iter().map(|suite| suite.runs.len()).sum()
    }
}

fn index_notes(source: &dyn RunSource, chosen: &[SuiteEntry]) -> Vec<String> {
    let (used, all) = (chosen.iter().map(|entry| entry.runs.len()).sum::<usize>(), source.runs());
    let mut notes = Vec::new();
    if used < all.len() {
        let without = all.iter().filter(|run| run.suite.is_none()).count();
        notes.push(format!(
            "{used} of the {} runs in {} are used: {} belong to suites that were not asked for, \
             {without} to no suite",
            all.len(),
            source.index_name().display(),
            all.len() - used - without,
        ));
    }
    notes.extend(source.notes());
    notes
}

fn suite_notes(suite: &Suite, reader: &SuiteReader) -> Vec<String> {
    let SuiteReader { nominal, nominal_starts, .. } = reader;
    let mut notes: Vec<String> = suite.runs.iter().flat_map(|run| run.notes.clone()).collect();
    let lengths = suite.runs.iter().map(|run| run.samples);
    let (shortest, longest) = (lengths.clone().min().unwrap_or(0), lengths.max().unwrap_or(0));
    let name = &suite.entry.name;
    if shortest < longest {
        notes.push(format!(
            "suite {name}: its runs have {shortest} to {longest} samples; each run counts up to \
             its own end"
        ));
    }
    if suite.shared.is_none() && suite.runs.len() > 1 && *nominal == NominalStart::Mean {
        notes.push(format!(
            "suite {name}: its runs differ in input or sample times, so each run has its own \
             nominal solution"
        ));
    }
    let is_known = nominal_starts.is_empty() || nominal_starts.contains_key(name);
    if *nominal == NominalStart::Mean && !is_known {
        notes.push(format!(
            "suite {name}: the model has no nominal initial state for it, so its nominal solution \
             starts at the mean of the first states of its {} recordings; the verdict on one of \
             them depends on the others",
            suite.runs.len()
        ));
    }
    notes
}
