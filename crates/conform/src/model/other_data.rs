//! How recordings differ from the recordings that a model was made from.

use std::collections::{BTreeMap, BTreeSet};

use crate::data::problem::Problem;
use crate::model::file::Model;
use crate::model::records::{DataRecord, RunRecord, SuiteRecord};

/// What differs between the recordings of a check and the model's, if they are meant to be the
/// same: they share a recording, or a suite of one name has recordings of the same names.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct OtherData {
    /// Recordings of the model that the check does not have.
    pub missing: Vec<String>,
    /// Recordings whose content is not the model's.
    pub replaced: Vec<Replaced>,
    /// The missing and replaced ones that decide the sets.
    pub deciding: Vec<String>,
    /// Number of recordings that the model does not list, in suites that it has.
    pub added: usize,
    /// Whether a recording is the model's to the last bit.
    pub shares_any: bool,
    /// Whether all recordings of a suite start where the model's do, to the last bit, although none
    /// is the model's: they are the model's, cut or edited.
    pub starts_alike: bool,
}

/// A recording whose content differs from the model's record of it.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Replaced {
    /// Path in the data set.
    pub file: String,
    /// Number of samples used: the model's, and at hand.
    pub samples: [usize; 2],
}

impl Model {
    /// Compares the recordings of a problem with the recordings that the model lists, in the suites
    /// that both have. Returns `None` if nothing differs, if they are other recordings altogether,
    /// or if either side does not list them.
    pub(crate) fn other_data(&self, problem: &Problem, data: &DataRecord) -> Option<OtherData> {
        if !self.data.are_listed() || !data.are_listed() {
            return None;
        }
        let (own, others) = (self.data.runs(), data.runs());
        let known: BTreeSet<&str> = own.iter().map(|run| run.sha256.as_str()).collect();
        let at_hand: BTreeSet<&str> = others.iter().map(|run| run.sha256.as_str()).collect();
        let by_file: BTreeMap<&str, &RunRecord> =
            others.iter().map(|run| (run.file.as_str(), *run)).collect();
        let shares_any = !known.is_disjoint(&at_hand);
        let names: BTreeSet<&str> = data.suites.iter().map(|suite| suite.name.as_str()).collect();
        let files = problem.files();
        let is_lost = |suite: &SuiteRecord| {
            shares_any && suite.runs.iter().all(|run| !files.contains(run.file.as_str()))
        };
        let asked: Vec<&SuiteRecord> = (self.data.suites.iter())
            .filter(|suite| names.contains(suite.name.as_str()) || is_lost(suite))
            .collect();
        let (mut missing, mut replaced) = (Vec::new(), Vec::new());
        for run in asked.iter().flat_map(|suite| &suite.runs) {
            match by_file.get(run.file.as_str()) {
                _ if at_hand.contains(run.sha256.as_str()) => {}
                Some(other) => replaced.push(Replaced {
                    file: run.file.clone(),
                    samples: [run.samples, other.samples],
                }),
                None => missing.push(run.file.clone()),
            }
        }
        let is_meant = shares_any || !replaced.is_empty();
        if !is_meant || missing.is_empty() && replaced.is_empty() {
            return None;
        }
        let listed: BTreeSet<&str> = own.iter().map(|run| run.file.as_str()).collect();
        let is_new = |run: &&RunRecord| {
            !known.contains(run.sha256.as_str()) && !listed.contains(run.file.as_str())
        };
        let own_names: BTreeSet<&str> = asked.iter().map(|suite| suite.name.as_str()).collect();
        let of_suites = data.suites.iter().filter(|suite| own_names.contains(suite.name.as_str()));
        let added = of_suites.flat_map(|suite| &suite.runs).filter(is_new).count();
        let named = missing.iter().chain(replaced.iter().map(|run| &run.file));
        let decides = |file: &&String| self.tight.iter().any(|place| place.run == **file);
        let deciding = named.filter(decides).cloned().collect();
        let starts_alike = !shares_any && self.starts_alike(problem);
        Some(OtherData { missing, replaced, deciding, added, shares_any, starts_alike })
    }

    /// Returns whether the recordings of some suite start where the model's do, to the last bit.
    fn starts_alike(&self, problem: &Problem) -> bool {
        let starts: BTreeMap<&str, &[f64]> = (self.data.suites.iter())
            .filter_map(|suite| Some((suite.name.as_str(), suite.nominal_start.as_deref()?)))
            .collect();
        problem.recordings().suites.iter().any(|suite| {
            let own = starts.get(suite.entry.name.as_str());
            own.is_some_and(|start| **start == suite.totals.mean_start())
        })
    }
}

impl DataRecord {
    fn runs(&self) -> Vec<&RunRecord> {
        self.suites.iter().flat_map(|suite| &suite.runs).collect()
    }
}

impl Problem {
    fn files(&self) -> BTreeSet<&str> {
        self.read.origin.entries().map(|entry| entry.file.as_str()).collect()
    }
}
