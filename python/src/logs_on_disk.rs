//! Logs as the product reads them: files.

use std::collections::{BTreeMap, BTreeSet};
use std::path::PathBuf;

use reachtube::RunSource;
use reachtube::recordings::{GapLimit, ReadOptions, RunEntry};
use reachtube_files::distinct_names;
use tempfile::TempDir;

use crate::failure::{Failure, Result, without_folder};
use crate::recordings::{SharedSource, csv};

/// Paths of logs, and a temporary folder with the runs that were in memory.
pub(crate) struct LogsOnDisk {
    /// Files and folders.
    pub paths: Vec<PathBuf>,
    folder: Option<TempDir>,
}

impl LogsOnDisk {
    /// Writes runs in memory to a temporary folder, with an index.
    pub(crate) fn new(mut paths: Vec<PathBuf>, runs: Option<&SharedSource>) -> Result<Self> {
        let Some(runs) = runs else { return Ok(Self { paths, folder: None }) };
        let folder = tempfile::tempdir()
            .map_err(|error| Failure::Other(format!("no temporary folder: {error}")))?;
        let stem = |name: &String| name.strip_suffix(".csv").unwrap_or(name).to_string();
        let names = distinct_names(runs.runs().iter().map(|run| stem(&run.file)), &[".csv"]);
        let options =
            ReadOptions { gap_limit: GapLimit::Seconds(f64::INFINITY), ..ReadOptions::default() };
        let orders = orders(runs.runs());
        let mut index = String::from("file,suite,motion,simulated,order\n");
        for (number, name) in names.iter().enumerate() {
            let run = runs.read(number, &options);
            let run = run
                .map_err(|defects| Failure::from(reachtube::recordings::Error::Defects(defects)))?;
            let file = folder.path().join(format!("{name}.csv"));
            let text = csv(&run);
            reachtube::write::atomically(&file, |out| out.write_all(text.as_bytes()))?;
            let entry = &runs.runs()[number];
            let cells = [entry.suite.as_deref(), entry.motion.as_deref()];
            let cells = cells.map(|cell| quoted(cell.unwrap_or_default()));
            let file = quoted(&format!("{name}.csv"));
            let (cells, order) = (cells.join(","), &orders[number]);
            index += &format!("{file},{cells},{},{order}\n", entry.simulated);
        }
        reachtube::write::atomically(&folder.path().join("runs.csv"), |out| {
            out.write_all(index.as_bytes())
        })?;
        paths.push(folder.path().into());
        Ok(Self { paths, folder: Some(folder) })
    }

    /// Returns whether runs were in memory.
    pub(crate) fn has_runs(&self) -> bool {
        self.folder.is_some()
    }

    /// Returns an error in which runs in memory have their names.
    pub(crate) fn named(&self, error: impl Into<Failure>) -> Failure {
        match &self.folder {
            None => error.into(),
            Some(folder) => error.into().of_runs_in(folder.path()),
        }
    }

    /// Returns a sentence in which runs in memory have their names.
    pub(crate) fn renamed(&self, text: &str) -> String {
        match &self.folder {
            None => text.into(),
            Some(folder) => without_folder(text, folder.path()),
        }
    }
}

/// Returns the cell of the column `order` of each run. It is empty for runs without a suite, which
/// are in no order, and for a suite in which two runs have the same, as the runs of two data sets
/// may: the place among the runs counts then.
fn orders(runs: &[RunEntry]) -> Vec<String> {
    let mut known: BTreeMap<&str, BTreeSet<u64>> = BTreeMap::new();
    let mut repeated = BTreeSet::new();
    for run in runs {
        let Some(suite) = run.suite.as_deref() else { continue };
        if !known.entry(suite).or_default().insert(run.order) {
            repeated.insert(suite);
        }
    }
    let is_used = |suite: &&str| !repeated.contains(suite);
    let cell = |run: &RunEntry| run.suite.as_deref().filter(is_used).map(|_| run.order.to_string());
    runs.iter().map(|run| cell(run).unwrap_or_default()).collect()
}

/// Returns a cell of a CSV file.
fn quoted(text: &str) -> String {
    format!("\"{}\"", text.replace('"', "\"\""))
}
