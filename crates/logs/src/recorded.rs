//! Runs that were cut from logs, as recordings.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use reachtube_files::{hex, write::atomically};
use reachtube_recordings::{
    Defect, Error as RecordingsError, GapLimit, MemoryRuns, ReadOptions, RunSource, column_names,
};
use schemars::JsonSchema;
use serde::Serialize;
use sha2::{Digest, Sha256};

use crate::cut::Cut;
use crate::error::{Error, Result};
use crate::log::Log;

/// Name of the index of a data set.
const INDEX: &str = "runs.csv";

/// Runs that were cut from logs. They have no defect.
#[derive(Debug)]
pub struct Recorded<'a> {
    logs: &'a [Log],
    cuts: &'a [Cut],
    runs: MemoryRuns,
}

/// A recording that was written.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct RecordedRun {
    /// Its file in the folder.
    pub file: String,
    /// The test suite, where it belongs to one.
    pub suite: Option<String>,
    /// The motion that the suite is part of, if it is known.
    pub motion: Option<String>,
    /// The log.
    pub log: String,
    /// Time of the first sample in the log, s, with all digits.
    pub start: String,
    /// Time from the first sample to the last, s.
    pub duration: f64,
    /// Number of samples.
    pub samples: usize,
    /// SHA-256 of the file, in lower-case hexadecimal.
    pub sha256: String,
}

/// Checks the runs that were cut from logs.
///
/// # Errors
///
/// - [`Error::NoRun`] if there is no run.
/// - [`Error::Recordings`] with the defects of all runs: values that are missing or not finite,
///   times that do not increase, and gaps beyond `gap_limit`. Each kind is reported once for a
///   run and a joint, with the number of messages.
pub fn convert<'a>(logs: &'a [Log], cuts: &'a [Cut], gap_limit: GapLimit) -> Result<Recorded<'a>> {
    if cuts.is_empty() {
        return Err(Error::NoRun("the logs have no sample; give others".into()));
    }
    let mut runs = MemoryRuns::default();
    let mut defects: Vec<Defect> = vec![];
    let options = ReadOptions { gap_limit, ..ReadOptions::default() };
    for (number, cut) in cuts.iter().enumerate() {
        let log = &logs[cut.log];
        match log.run(cut.samples.clone()) {
            Ok(run) => {
                let name = file_name(number, log);
                runs.push(&name, cut.suite.as_deref(), cut.motion.as_deref(), run);
                let index = runs.runs().len() - 1;
                let found = runs.read(index, &options).err().unwrap_or_default();
                defects.extend(found.into_iter().map(|defect| in_log(defect, cut, log)));
            }
            Err(found) => defects.extend(found),
        }
    }
    if !defects.is_empty() {
        return Err(RecordingsError::Defects(defects).into());
    }
    Ok(Recorded { logs, cuts, runs })
}

/// Returns a defect of a run, as one of its log.
fn in_log(defect: Defect, cut: &Cut, log: &Log) -> Defect {
    let start = log.time(cut.samples.start);
    Defect {
        problem: format!("run from {start} s: {}", defect.problem),
        remedy: "samples are missing and the input there is unknown: record again, cut the run \
                 elsewhere, or accept it with --max-gap SECONDS"
            .into(),
        file: log.path.clone(),
        ..defect
    }
}

impl Recorded<'_> {
    /// Returns the runs as a source of recordings.
    #[must_use]
    pub fn into_runs(self) -> MemoryRuns {
        self.runs
    }

    /// Returns the paths of the files that [`write`](Self::write) writes into a folder.
    #[must_use]
    pub fn files(&self, folder: &Path) -> Vec<PathBuf> {
        let runs = self.runs.runs().iter().map(|run| folder.join(&run.file));
        runs.chain([folder.join(INDEX)]).collect()
    }

    /// Writes the runs into a folder as CSV files, and then their index `runs.csv`. A number has
    /// the digits that give it back to the last bit; times have the digits of the log.
    ///
    /// # Errors
    ///
    /// [`Error::File`] where a file cannot be written.
    pub fn write(&self, folder: &Path) -> Result<Vec<RecordedRun>> {
        let mut written = vec![];
        for (cut, entry) in self.cuts.iter().zip(self.runs.runs()) {
            let log = &self.logs[cut.log];
            let text = csv_text(log, cut);
            atomically(&folder.join(&entry.file), |out| out.write_all(text.as_bytes()))?;
            let last = cut.samples.end - 1;
            let span = log.samples[last].time - log.samples[cut.samples.start].time;
            written.push(RecordedRun {
                file: entry.file.clone(),
                suite: cut.suite.clone(),
                motion: cut.motion.clone(),
                log: log.path.display().to_string(),
                start: log.time(cut.samples.start),
                duration: span as f64 / 1e9,
                samples: cut.samples.len(),
                sha256: hex(&Sha256::digest(text.as_bytes())),
            });
        }
        let index = index_text(&written);
        atomically(&folder.join(INDEX), |out| out.write_all(&index))?;
        Ok(written)
    }
}

/// Returns the name of a run's file, which has no characters of special meaning.
fn file_name(number: usize, log: &Log) -> String {
    let stem = log.path.file_stem().unwrap_or(log.path.as_os_str()).to_string_lossy();
    let safe = |c: char| if c.is_ascii_alphanumeric() || "-_.".contains(c) { c } else { '_' };
    format!("{:04}_{}.csv", number + 1, stem.chars().map(safe).collect::<String>())
}

fn csv_text(log: &Log, cut: &Cut) -> String {
    let columns = std::iter::once("t".into()).chain(column_names(log.joints.len()));
    let mut text = columns.collect::<Vec<String>>().join(",");
    text.push('\n');
    for index in cut.samples.clone() {
        text += &log.time(index);
        for value in log.row(index) {
            // The shortest digits that give the number back.
            write!(text, ",{value:?}").expect("text can be added to a string");
        }
        text.push('\n');
    }
    text
}

/// Returns the index, in which names are quoted where they need it.
fn index_text(runs: &[RecordedRun]) -> Vec<u8> {
    let mut out = csv::Writer::from_writer(vec![]);
    let write = |out: &mut csv::Writer<Vec<u8>>| -> csv::Result<()> {
        out.write_record(["file", "suite", "motion", "sha256", "log", "start"])?;
        for run in runs {
            let filled = |name: &Option<String>| name.clone().unwrap_or_default();
            out.write_record([
                &run.file,
                &filled(&run.suite),
                &filled(&run.motion),
                &run.sha256,
                &run.log,
                &run.start,
            ])?;
        }
        Ok(())
    };
    write(&mut out).expect("records of equal length fit into memory");
    out.into_inner().expect("a writer into memory has nothing left")
}
