//! A summary of logs, with what was understood of each.

use std::path::{Path, PathBuf};
use std::sync::Mutex;

use serde::Serialize;

use crate::defect::Defect;
use crate::error::Result;
use crate::index::RunEntry;
use crate::inspect::{Inspection, inspect_source};
use crate::logged::{LoggedOptions, Understood, csv_files, group_files, is_recording, read_logged};
use crate::reading::read_csv;
use crate::run::Run;
use crate::source::{ReadOptions, RunSource};

/// A summary of logs.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct LogInspection {
    /// The summary of the recordings.
    #[serde(flatten)]
    pub inspection: Inspection,
    /// What was understood of each log that can be used; recordings in the format of
    /// `docs/recordings.md` are not among them.
    pub logs: Vec<Understood>,
}

/// Reads a log, or all logs of a folder that has no index, and summarises them.
///
/// # Errors
///
/// [`Error::File`](crate::Error::File) for a path that cannot be read. Defects of a log are in
/// [`Inspection::refused`].
pub fn inspect_logs(path: &Path, options: &LoggedOptions) -> Result<LogInspection> {
    let groups = group_files(csv_files(path)?);
    let runs = LoggedRuns::new(path, groups, options);
    let mut inspection = inspect_source(&runs, path.display().to_string(), options.gap_limit);
    let found = runs.found.into_inner().unwrap_or_default();
    inspection.notes.extend(found.iter().flatten().flat_map(|(_, notes)| notes.clone()));
    let logs = found.into_iter().flatten().map(|(understood, _)| understood).collect();
    Ok(LogInspection { inspection, logs })
}

/// What was understood of a log, and the notes about it.
type Found = (Understood, Vec<String>);

/// Logs as a source of recordings.
#[derive(Debug)]
struct LoggedRuns<'a> {
    path: PathBuf,
    entries: Vec<RunEntry>,
    groups: Vec<Vec<PathBuf>>,
    options: LoggedOptions<'a>,
    /// What was understood of each that was read, and its notes.
    found: Mutex<Vec<Option<Found>>>,
}

impl<'a> LoggedRuns<'a> {
    fn new(path: &Path, groups: Vec<Vec<PathBuf>>, options: &LoggedOptions<'a>) -> Self {
        let entry = |(line, files): (u64, &Vec<PathBuf>)| {
            let inside = files[0].strip_prefix(path).ok().filter(|file| file.file_name().is_some());
            RunEntry {
                file: inside.unwrap_or(&files[0]).display().to_string(),
                suite: None,
                motion: None,
                kind: Some("logs".into()),
                temperature: None,
                sha256: None,
                simulated: false,
                noise: None,
                order: line,
                line,
            }
        };
        let entries = (1..).zip(&groups).map(entry).collect();
        let found = Mutex::new(vec![None; groups.len()]);
        Self { path: path.into(), entries, groups, options: *options, found }
    }
}

impl RunSource for LoggedRuns<'_> {
    fn index_name(&self) -> PathBuf {
        self.path.clone()
    }

    fn runs(&self) -> &[RunEntry] {
        &self.entries
    }

    fn run_name(&self, index: usize) -> PathBuf {
        self.groups[index][0].clone()
    }

    fn read(&self, index: usize, options: &ReadOptions) -> Result<Run, Vec<Defect>> {
        let files = &self.groups[index];
        if let [file] = &files[..]
            && is_recording(file)
        {
            return read_csv(file, options);
        }
        let options =
            LoggedOptions { gap_limit: options.gap_limit, until: options.until, ..self.options };
        let logged = read_logged(files, &options)?;
        if let Ok(mut found) = self.found.lock() {
            found[index] = Some((logged.understood, logged.notes));
        }
        Ok(logged.run)
    }
}
