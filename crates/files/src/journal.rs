use std::path::Path;

use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

use crate::error::{Error, Result};
use crate::overwrite::TOOL;
use crate::read::read_text;
use crate::{json, write};

/// The name and the version of the file's format.
const FORMAT: &str = "reachtube-progress";
const VERSION: u32 = 4;

/// What a long job has finished, in a file, so that a job that was stopped continues there.
///
/// # Examples
///
/// ```
/// use reachtube_files::Journal;
///
/// let folder = tempfile::tempdir().unwrap();
/// let path = folder.path().join("progress.json");
/// let journal = Journal::new(Some(&path), "digest of the job".into());
/// assert_eq!(journal.load::<Vec<u32>>()?, None);
/// journal.save(&[1, 2])?;
/// assert_eq!(journal.load()?, Some(vec![1, 2]));
/// assert!(Journal::new(Some(&path), "another".into()).load::<Vec<u32>>().is_err());
/// journal.remove();
/// # Ok::<(), reachtube_files::Error>(())
/// ```
#[derive(Debug)]
pub struct Journal<'a> {
    path: Option<&'a Path>,
    /// SHA-256 of everything that decides the result.
    job: String,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct File<T> {
    format: String,
    version: u32,
    tool: String,
    job: String,
    progress: T,
}

impl<'a> Journal<'a> {
    /// Opens the journal of a job, whose digest is `job`, at `path`. Without a path, nothing is
    /// kept.
    #[must_use]
    pub fn new(path: Option<&'a Path>, job: String) -> Self {
        Self { path, job }
    }

    /// Returns what is finished, where the file exists.
    ///
    /// # Errors
    ///
    /// A file that cannot be read or written, or belongs to another job.
    pub fn load<T: DeserializeOwned>(&self) -> Result<Option<T>> {
        let Some(path) = self.path else { return Ok(None) };
        write::try_at(path)?;
        if !path.exists() {
            return Ok(None);
        }
        let text = read_text(path, "give the file of this job, or a new one")?;
        let wrong = |problem: String| Error::Progress { path: path.into(), problem };
        let value: serde_json::Value =
            serde_json::from_str(&text).map_err(|error| wrong(format!("not JSON: {error}")))?;
        let own = [("format", FORMAT), ("tool", TOOL), ("job", &self.job)];
        if value["version"] != VERSION || own.iter().any(|(key, own)| value[key] != *own) {
            let what =
                "it holds the progress of another job, whose robot, settings or recordings differ";
            return Err(wrong(what.into()));
        }
        let file: File<T> =
            serde_json::from_value(value).map_err(|error| wrong(error.to_string()))?;
        Ok(Some(file.progress))
    }

    /// Writes what is finished, whole or not at all.
    ///
    /// # Errors
    ///
    /// Where it cannot be written; the file is as it was.
    pub fn save(&self, progress: &impl Serialize) -> Result<()> {
        let Some(path) = self.path else { return Ok(()) };
        let text = json::to_lines(&File {
            format: FORMAT.into(),
            version: VERSION,
            tool: TOOL.into(),
            job: self.job.clone(),
            progress,
        });
        write::atomically(path, |out| out.write_all(text.as_bytes()))
    }

    /// Removes the file: the job is done.
    pub fn remove(&self) {
        if let Some(path) = self.path {
            let _ = std::fs::remove_file(path);
        }
    }
}
