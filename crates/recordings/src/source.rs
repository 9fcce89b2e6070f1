use std::collections::BTreeSet;
use std::fmt;
use std::path::PathBuf;

use crate::defect::Defect;
use crate::error::{Error, Result};
use crate::gap_limit::GapLimit;
use crate::index::RunEntry;
use crate::run::Run;

/// A test suite: its name and the indices of its runs, in the order of the source.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SuiteEntry {
    /// The suite's name.
    pub name: String,
    /// The motion that the suite is part of, where the source names it.
    pub motion: Option<String>,
    /// Indices into [`RunSource::runs`].
    pub runs: Vec<usize>,
}

/// How a recording is read.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct ReadOptions {
    /// Number of joints that the recording must have; any number where it is `None`.
    pub joints: Option<usize>,
    /// How long the time between two samples may be.
    pub gap_limit: GapLimit,
    /// Samples later than this many seconds after the first are not used.
    pub until: Option<f64>,
}

/// A source of recordings: a folder with an index ([`DataSet`](crate::DataSet)), or runs in memory
/// ([`MemoryRuns`](crate::MemoryRuns)).
///
/// A source lists its runs at once and reads their samples one by one, when they are asked for.
pub trait RunSource: fmt::Debug + Send + Sync {
    /// Returns the name under which messages speak of the source's list of runs.
    fn index_name(&self) -> PathBuf;

    /// Returns all runs, in the order in which they were recorded.
    fn runs(&self) -> &[RunEntry];

    /// Returns the name under which messages speak of run `index`.
    fn run_name(&self, index: usize) -> PathBuf;

    /// Reads run `index`.
    ///
    /// # Errors
    ///
    /// Every defect of the recording, with line and joint.
    fn read(&self, index: usize, options: &ReadOptions) -> Result<Run, Vec<Defect>>;

    /// Returns a sentence about recordings that lie beside the listed ones and are not used.
    fn unlisted_note(&self) -> Option<String> {
        None
    }

    /// Returns all test suites, in the order in which the source first names them.
    fn suites(&self) -> Vec<SuiteEntry> {
        let mut suites: Vec<SuiteEntry> = Vec::new();
        for (index, run) in self.runs().iter().enumerate() {
            let Some(name) = &run.suite else { continue };
            match suites.iter_mut().find(|suite| suite.name == *name) {
                Some(suite) => {
                    suite.runs.push(index);
                    suite.motion = suite.motion.take().or_else(|| run.motion.clone());
                }
                None => suites.push(SuiteEntry {
                    name: name.clone(),
                    motion: run.motion.clone(),
                    runs: vec![index],
                }),
            }
        }
        suites
    }

    /// Returns the suites named, in that order; all of them when none is named.
    ///
    /// # Errors
    ///
    /// [`Error::UnknownSuite`] when there is no such suite, or none at all, and
    /// [`Error::RepeatedSuite`] when a name is given twice.
    fn select(&self, names: &[String]) -> Result<Vec<SuiteEntry>> {
        let suites = self.suites();
        let unknown = |name: &str| Error::UnknownSuite {
            index: self.index_name(),
            name: name.into(),
            available: suites.iter().map(|suite| suite.name.clone()).collect(),
        };
        if names.is_empty() {
            return if suites.is_empty() { Err(unknown("")) } else { Ok(suites) };
        }
        let distinct: BTreeSet<&String> = names.iter().collect();
        if distinct.len() < names.len() {
            return Err(Error::RepeatedSuite { names: names.to_vec() });
        }
        let find = |name: &String| {
            suites.iter().find(|suite| suite.name == *name).cloned().ok_or_else(|| unknown(name))
        };
        names.iter().map(find).collect()
    }
}
