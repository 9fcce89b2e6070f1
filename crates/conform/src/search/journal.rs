//! The journal of a long search: what is finished, in a file, to resume from.

use std::path::Path;

use reachtube_files::{TOOL, json, write};
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

use crate::data::problem::Problem;
use crate::error::{Error, Result};

/// The name of the file's format.
const FORMAT: &str = "reachtube-progress";
const VERSION: u32 = 3;

/// Where a search keeps what is finished, if it does.
#[derive(Debug)]
pub(super) struct Journal<'a> {
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
    /// Opens the journal of a problem at `path`, or none.
    pub(super) fn new(path: Option<&'a Path>, problem: &Problem) -> Self {
        let mut digest = Sha256::new();
        let (settings, drive) = (problem.settings(), problem.setup().drive.identity());
        let decides = serde_json::to_string(&(TOOL, settings, drive));
        digest.update(decides.expect("settings have only finite numbers and string keys"));
        digest.update(&problem.recordings().root);
        for suite in &problem.recordings().suites {
            digest.update(&suite.entry.name);
        }
        Self { path, job: reachtube_files::hex(&digest.finalize()) }
    }

    /// Returns what is finished, where the file exists.
    ///
    /// # Errors
    ///
    /// A file that cannot be read or written, or belongs to another job.
    pub(super) fn load<T: DeserializeOwned>(&self) -> Result<Option<T>> {
        let Some(path) = self.path else { return Ok(None) };
        write::try_at(path)?;
        if !path.exists() {
            return Ok(None);
        }
        let remedy = "give the file of this job, or a new one";
        let text = reachtube_files::read_text(path, remedy)?;
        let wrong = |problem: String| Error::ModelFile { path: path.into(), problem };
        let value: serde_json::Value = serde_json::from_str(&text)
            .map_err(|error| wrong(format!("not JSON: {error}; {remedy}")))?;
        let is_ours = value["format"] == FORMAT
            && value["version"] == VERSION
            && value["job"] == self.job.as_str();
        if !is_ours {
            let what =
                "it holds the progress of another job, whose robot, settings or recordings differ";
            return Err(wrong(format!("{what}; {remedy}")));
        }
        let file: File<T> =
            serde_json::from_value(value).map_err(|error| wrong(format!("{error}; {remedy}")))?;
        Ok(Some(file.progress))
    }

    /// Writes what is finished, whole or not at all.
    ///
    /// # Errors
    ///
    /// Where it cannot be written; the file is as it was.
    pub(super) fn save(&self, progress: &impl Serialize) -> Result<()> {
        let Some(path) = self.path else { return Ok(()) };
        let text = json::to_lines(&File {
            format: FORMAT.into(),
            version: VERSION,
            tool: TOOL.into(),
            job: self.job.clone(),
            progress,
        });
        write::atomically(path, |out| out.write_all(text.as_bytes()))?;
        Ok(())
    }

    /// Removes the file: the job is done.
    pub(super) fn remove(&self) {
        if let Some(path) = self.path {
            let _ = std::fs::remove_file(path);
        }
    }
}
