//! Logs that commands read.

use std::path::{Path, PathBuf};

use reachtube::identify::prepare::LogEntry;
use reachtube::recordings::GapLimit;
use reachtube_logs::{Log, LogOptions, convert, whole_logs};
use tempfile::TempDir;

use crate::error::Result;
use crate::output;

/// Reads a log, prints its notes, and warns of what is lost.
pub(crate) fn read_log(path: &Path, options: &LogOptions) -> Result<Log> {
    let log = Log::read(path, options)?;
    output::notes(log.notes());
    output::warnings(&log.losses().iter().map(ToString::to_string).collect::<Vec<_>>());
    if !log.losses().is_empty() {
        output::warn(&format!("{}: {} samples are kept", path.display(), log.len()));
    }
    Ok(log)
}

/// A folder with the logs among some paths as CSV files, which is deleted with this value.
pub(crate) struct LogFiles {
    options: LogOptions,
    folder: TempDir,
    count: usize,
}

impl LogFiles {
    /// Makes an empty folder for logs.
    pub(crate) fn new(options: LogOptions) -> Result<Self> {
        let folder = tempfile::tempdir().map_err(|source| reachtube_files::Error::Write {
            path: std::env::temp_dir(),
            source,
        })?;
        Ok(Self { options, folder, count: 0 })
    }

    /// Replaces the path of a log, whole or an interval of it, by the path of the recording as
    /// CSV. Paths are relative to `folder`, and other paths stay as they are.
    pub(crate) fn convert(&mut self, entry: &mut LogEntry, folder: &Path) -> Result<()> {
        let (LogEntry::Path(path) | LogEntry::Stretch { path, .. }) = entry;
        if is_log(path) {
            *path = self.csv_of(&folder.join(&path))?;
        }
        Ok(())
    }

    fn csv_of(&mut self, path: &Path) -> Result<PathBuf> {
        let logs = [read_log(path, &self.options)?];
        let cuts = whole_logs(&logs);
        // What reads the CSV file has its own limit.
        let recorded = convert(&logs, &cuts, GapLimit::Seconds(f64::INFINITY))?;
        self.count += 1;
        let folder = self.folder.path().join(self.count.to_string());
        let written = recorded.write(&folder)?;
        let mut name = path.file_stem().unwrap_or(path.as_os_str()).to_os_string();
        name.push(".csv");
        let named = folder.join(name);
        let rename = std::fs::rename(folder.join(&written[0].file), &named);
        rename.map_err(|source| reachtube_files::Error::Write { path: named.clone(), source })?;
        Ok(named)
    }
}

/// Returns whether a path names a log, by its ending.
fn is_log(path: &Path) -> bool {
    path.extension().is_some_and(|extension| extension == "mcap" || extension == "db3")
}
