//! Records of a model file about its recordings.

use std::collections::BTreeSet;

use reachtube_recordings::{RowSketch, Run};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

use crate::data::problem::Problem;
use crate::data::recordings::Recordings;
use crate::data::suite::Suite;
use crate::data::summary::RunSummary;

/// Records of logs that share samples have kept at least this many of them.
const FEWEST: usize = 3;

/// The recordings that a model encloses.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DataRecord {
    /// SHA-256 over the lines `sha256  file` of all runs, as in the output of sha256sum, in this
    /// order; over the line `root` and a line `run_count  name` for each suite where they are not
    /// listed.
    pub sha256: String,
    /// The root of the Merkle tree over the manifest's entries, where the runs are not listed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub root: Option<String>,
    /// Number of recordings of the manifest that were left out because they have defects.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub skipped: usize,
    /// Whether recordings are simulated, and not measured.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub simulated: bool,
    /// The suites.
    pub suites: Vec<SuiteRecord>,
}

/// A test suite in a model file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SuiteRecord {
    /// Its name.
    pub name: String,
    /// The motion it is part of, where the index says so.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub motion: Option<String>,
    /// The initial state of its nominal motions, 2n, rad and rad/s; `None` if each run
    /// starts at its own first state.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub nominal_start: Option<Vec<f64>>,
    /// Its runs, where they are listed.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub runs: Vec<RunRecord>,
    /// Number of its runs, where they are not listed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub run_count: Option<usize>,
}

/// A run in a model file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RunRecord {
    /// Path in the data set.
    pub file: String,
    /// SHA-256 of the file.
    pub sha256: String,
    /// SHA-256 of the log that it was cut from, if it was cut from one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub origin: Option<String>,
    /// Number of samples used.
    pub samples: usize,
    /// Time from the first to the last of them, s.
    pub duration: f64,
}

/// A log that a model was made of, or that was held out from it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LogRecord {
    /// Its SHA-256.
    pub sha256: String,
    /// Whether it was held out from every choice.
    pub held_out: bool,
    /// Some of its samples.
    pub rows: RowSketch,
}

impl LogRecord {
    /// Makes the record of a log.
    #[must_use]
    pub fn of(run: &Run, held_out: bool) -> Self {
        Self { sha256: run.sha256.clone(), held_out, rows: RowSketch::of(run) }
    }

    /// Returns whether both records are of one log, or of logs that share samples, as far as the
    /// samples that both have kept show it.
    pub(super) fn shares_samples(&self, other: &Self) -> bool {
        let is_kept = |key: &&u32| other.rows.keys.contains(key);
        self.sha256 == other.sha256 || self.rows.keys.iter().filter(is_kept).count() >= FEWEST
    }
}

impl SuiteRecord {
    /// Returns the motion that it is part of; its own name where the index says none.
    pub(crate) fn motion(&self) -> &str {
        self.motion.as_ref().unwrap_or(&self.name)
    }

    pub(crate) fn count(&self) -> usize {
        self.run_count.unwrap_or(self.runs.len())
    }

    /// Returns whether the nominal initial state is one of `parts` parts, and the runs are either
    /// listed or counted.
    pub(super) fn fits(&self, parts: usize) -> bool {
        let fits = |start: &Vec<f64>| {
            start.len() == 2 * parts && start.iter().all(|value| value.is_finite())
        };
        let counted = self.runs.is_empty() == self.run_count.is_some();
        counted && self.nominal_start.as_ref().is_none_or(fits)
    }
}

impl DataRecord {
    pub(super) fn new(problem: &Problem) -> Self {
        let run = |run: &RunSummary| RunRecord {
            file: problem.entry(run.index).file.clone(),
            sha256: run.sha256.clone(),
            origin: run.origin.clone(),
            samples: run.samples,
            duration: run.duration,
        };
        let has_start = !problem.settings().nominal.is_of_run();
        let Recordings { suites, root, are_listed, skipped, .. } = problem.recordings();
        let suite = |suite: &Suite| SuiteRecord {
            name: suite.entry.name.clone(),
            motion: suite.entry.motion.clone(),
            nominal_start: has_start.then(|| suite.nominal_start.clone()),
            runs: suite.runs.iter().filter(|_| *are_listed).map(run).collect(),
            run_count: (!are_listed).then(|| suite.run_count()),
        };
        let suites = suites.iter().map(suite).collect();
        let root = (!are_listed).then(|| root.clone());
        let simulated = problem.is_simulated();
        let record = Self { sha256: String::new(), root, skipped: *skipped, simulated, suites };
        Self { sha256: record.digest(), ..record }
    }

    pub(crate) fn are_listed(&self) -> bool {
        self.root.is_none()
    }

    /// Returns the number of runs.
    #[must_use]
    pub fn run_count(&self) -> usize {
        self.suites.iter().map(SuiteRecord::count).sum()
    }

    /// Returns the duration of the longest run, s, where runs are listed.
    pub(crate) fn longest(&self) -> Option<f64> {
        let runs = self.suites.iter().flat_map(|suite| &suite.runs);
        runs.map(|run| run.duration).reduce(f64::max)
    }

    /// Returns the number of distinct motions; a suite without a motion counts as one.
    pub(crate) fn motions(&self) -> usize {
        self.suites.iter().map(SuiteRecord::motion).collect::<BTreeSet<&str>>().len()
    }

    /// Returns the SHA-256 that the record must have.
    pub(super) fn digest(&self) -> String {
        let mut digest = Sha256::new();
        if let Some(root) = &self.root {
            digest.update(format!("{root}\n"));
            let line = |suite: &SuiteRecord| format!("{}  {}\n", suite.count(), suite.name);
            self.suites.iter().for_each(|suite| digest.update(line(suite)));
        }
        for run in self.suites.iter().flat_map(|suite| &suite.runs) {
            digest.update(format!("{}  {}\n", run.sha256, run.file));
        }
        reachtube_files::hex(&digest.finalize())
    }
}

pub(super) fn is_zero(count: &usize) -> bool {
    *count == 0
}
