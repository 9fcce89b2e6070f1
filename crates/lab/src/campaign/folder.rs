//! The folder of a campaign: its mark first, then the recordings, and the index last, so that a
//! folder that is not finished cannot be opened. No file is written twice.

use std::path::{Path, PathBuf};

use reachtube_files::hex;
use reachtube_files::write::{atomically, remove_left_over};
use reachtube_robot::Robot;
use serde_json::json;
use sha2::{Digest, Sha256};

use super::job::Job;
use super::options::{CampaignOptions, MARK};
use super::readme::readme;
use crate::error::{Error, Result};
use crate::virtual_robot::VirtualRobot;

/// The index of the data set.
const INDEX: &str = "runs.csv";

const INDEX_HEADER: &str =
    "file,kind,suite,motion,use,repeat,rows,duration_s,temperature,sha256,simulated\n";

/// Advice where a recording of the campaign cannot be read back.
const REMEDY: &str = "delete it, and start the campaign again";

/// A folder that belongs to one campaign.
pub(super) struct Folder<'a> {
    root: &'a Path,
}

impl<'a> Folder<'a> {
    /// Opens the folder of a campaign: a new one, or one in which the same campaign was stopped.
    pub(super) fn open(
        root: &'a Path,
        robot: &VirtualRobot,
        options: &CampaignOptions,
    ) -> Result<Self> {
        let mark = mark(robot.nominal(), options);
        let (folder, path) = (Self { root }, root.join(MARK));
        folder.remove_left_over();
        if path.exists() {
            let found = reachtube_files::read(&path, REMEDY)?;
            if found != mark.as_bytes() {
                return Err(Error::OtherCampaign { folder: root.into() });
            }
        } else if !entries(root).is_empty() {
            return Err(Error::ForeignFolder { folder: root.into() });
        }
        folder.write_new(MARK, &mark)?;
        folder.write_new("README.md", &readme(robot, options))?;
        folder.write_new("truth.toml", &robot.truth().description().to_toml())?;
        Ok(folder)
    }

    /// Returns whether a job was done before the campaign was stopped.
    pub(super) fn has(&self, job: &Job) -> bool {
        job.files.iter().all(|file| self.root.join(file).exists())
    }

    pub(super) fn read(&self, file: &str) -> Result<String> {
        let bytes = reachtube_files::read(&self.root.join(file), REMEDY)?;
        Ok(String::from_utf8_lossy(&bytes).into_owned())
    }

    pub(super) fn write_new(&self, file: &str, text: &str) -> Result<()> {
        let path = self.root.join(file);
        if !path.exists() {
            atomically(&path, |out| out.write_all(text.as_bytes()))?;
        }
        Ok(())
    }

    pub(super) fn finish(&self, lines: &[String]) -> Result<()> {
        self.write_new(INDEX, &(INDEX_HEADER.to_string() + &lines.concat()))
    }

    /// Removes temporary files of a campaign that was stopped while it wrote.
    fn remove_left_over(&self) {
        let folders = entries(self.root).into_iter().filter(|path| path.is_dir());
        let below = folders.flat_map(|folder| {
            let deeper = entries(&folder).into_iter().filter(|path| path.is_dir());
            deeper.chain([folder]).collect::<Vec<_>>()
        });
        below.chain([self.root.to_path_buf()]).for_each(|folder| remove_left_over(&folder));
    }
}

pub(super) fn index_line(job: &Job, index: usize, text: &str) -> String {
    let (file, kind, repeat) = (&job.files[index], job.kind, job.first + index);
    let [suite, motion, use_for] = match job.as_suite() {
        Some((runs, of)) => {
            [&*runs.name, &*of.motion, if of.is_held_out { "check" } else { "training" }]
        }
        None => [""; 3],
    };
    let rows = text.lines().count() - 1;
    let fields = |line: Option<&str>| -> Vec<f64> {
        line.unwrap_or_default().split(',').map(|x| x.parse().unwrap_or(f64::NAN)).collect()
    };
    let duration = fields(text.lines().last())[0];
    let first = fields(text.lines().nth(1));
    let temperatures = &first[1 + 3 * (first.len() / 4)..];
    let temperature = temperatures.iter().sum::<f64>() / temperatures.len() as f64;
    let hash = hex(&Sha256::digest(text));
    format!(
        "{file},{kind},{suite},{motion},{use_for},{repeat},{rows},{duration:.3},\
         {temperature:.2},{hash},true\n"
    )
}

/// Returns what marks a campaign: its options, its robot and the version of the program, which all
/// decide what is recorded.
fn mark(robot: &Robot, options: &CampaignOptions) -> String {
    let robot = hex(&Sha256::digest(robot.description().to_toml()));
    let value = json!({
        "campaign": "recordings of a virtual robot",
        "version": env!("CARGO_PKG_VERSION"),
        "robot_sha256": robot,
        "options": options,
    });
    serde_json::to_string_pretty(&value).expect("options have string keys") + "\n"
}

fn entries(folder: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).into_iter().flatten();
    entries.flatten().map(|entry| entry.path()).collect()
}
