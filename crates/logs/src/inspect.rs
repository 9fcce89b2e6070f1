//! A summary of logs, with what was understood of each.

use std::path::{Path, PathBuf};
use std::sync::Mutex;

use reachtube_recordings::{
    Defect, Inspection, LogSettings, LoggedOptions, MemoryRuns, ReadOptions, Run, RunEntry,
    RunSource, Understood, check_limits, inspect_source, read_logged,
};
use schemars::JsonSchema;
use serde::Serialize;

use crate::cut::Cutting;
use crate::error::Result;
use crate::found::LogFiles;
use crate::log::{Log, LogOptions};

/// A summary of logs.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct LogInspection {
    /// The summary of the recordings.
    #[serde(flatten)]
    pub inspection: Inspection,
    /// The interpretation of each usable log; recordings in the format of `docs/recordings.md` are
    /// not among them.
    pub logs: Vec<Understood>,
}

/// Reads a log, or all logs of a folder that has no index, and summarises them. `settings` are
/// about logs in MCAP and rosbag2.
///
/// # Errors
///
/// Paths and logs that cannot be read. Defects of recordings are in [`Inspection::refused`].
pub fn inspect_logs(
    path: &Path,
    options: &LoggedOptions,
    settings: &LogSettings,
) -> Result<LogInspection> {
    let runs = LoggedRuns::new(path, options, settings)?;
    let mut inspection = inspect_source(&runs, path.display().to_string(), options.gap_limit);
    let found = runs.found.into_inner().unwrap_or_default();
    inspection.notes.extend(found.iter().flatten().flat_map(|(_, notes)| notes.clone()));
    let logs = found.into_iter().flatten().filter_map(|(understood, _)| understood).collect();
    Ok(LogInspection { inspection, logs })
}

/// The interpretation of a log, and the notes about it.
type Found = (Option<Understood>, Vec<String>);

/// Logs as a source of recordings.
#[derive(Debug)]
struct LoggedRuns<'a> {
    path: PathBuf,
    entries: Vec<RunEntry>,
    contents: Vec<Content>,
    /// The recordings of logs in MCAP and rosbag2.
    in_memory: MemoryRuns,
    options: LoggedOptions<'a>,
    /// The interpretation of each log, and its notes.
    found: Mutex<Vec<Option<Found>>>,
}

/// Where a recording is.
#[derive(Debug)]
enum Content {
    Csv(Vec<PathBuf>),
    /// A log, with the number of the recording in memory, or its defects.
    Container(PathBuf, Result<usize, Vec<Defect>>),
}

impl Content {
    fn path(&self) -> &Path {
        match self {
            Self::Csv(files) => &files[0],
            Self::Container(path, _) => path,
        }
    }
}

impl<'a> LoggedRuns<'a> {
    fn new(path: &Path, options: &LoggedOptions<'a>, settings: &LogSettings) -> Result<Self> {
        let mut runs = Self {
            path: path.into(),
            entries: vec![],
            contents: vec![],
            in_memory: MemoryRuns::default(),
            options: *options,
            found: Mutex::default(),
        };
        let mut all = vec![];
        for files in LogFiles::find(path)? {
            match files {
                LogFiles::Csv(files) => {
                    all.push(None);
                    runs.contents.push(Content::Csv(files));
                }
                LogFiles::Container(log) => runs.add(&log, settings, &mut all)?,
            }
        }
        runs.entries = (1..).zip(&runs.contents).map(|(line, of)| entry(path, line, of)).collect();
        runs.found = Mutex::new(all);
        Ok(runs)
    }

    /// Reads a log in MCAP or rosbag2, and adds its recordings.
    fn add(
        &mut self,
        path: &Path,
        settings: &LogSettings,
        all: &mut Vec<Option<Found>>,
    ) -> Result<()> {
        let joints = self.options.robot.map_or_else(
            || settings.joints.clone(),
            |robot| robot.iter().map(|axis| axis.name.clone()).collect(),
        );
        let logs = [Log::read(path, &LogOptions::new(settings, &joints)?)?];
        let cutting = settings.marker.as_ref().map_or(Cutting::Whole, |_| Cutting::Marked);
        let cuts = cutting.runs(&logs)?;
        for (number, cut) in cuts.iter().enumerate() {
            let mut found = None;
            let read = logs[0].run(cut.samples.clone()).map(|run| {
                found = Some((Some(logs[0].understood(&run)), vec![]));
                let count = self.in_memory.runs().len();
                self.in_memory.push(&path.display().to_string(), None, None, run);
                count
            });
            if let (0, Some((_, notes))) = (number, &mut found) {
                *notes = logs[0].notes().to_vec();
            }
            self.contents.push(Content::Container(path.into(), read));
            all.push(found);
        }
        Ok(())
    }
}

/// Returns the entry of a recording; `line` is its number, from 1.
fn entry(path: &Path, line: u64, content: &Content) -> RunEntry {
    let file = content.path();
    let inside = file.strip_prefix(path).ok().filter(|file| file.file_name().is_some());
    RunEntry {
        file: inside.unwrap_or(file).display().to_string(),
        kind: Some("logs".into()),
        order: line,
        line,
        ..RunEntry::default()
    }
}

impl LoggedRuns<'_> {
    /// Returns the run unless its numbers cannot be in the units of the robot, if one is named.
    fn checked(&self, file: &Path, run: Run) -> Result<Run, Vec<Defect>> {
        let robot = self.options.robot.filter(|robot| robot.len() == run.joints);
        match robot.map(|robot| check_limits(file, &run, robot)) {
            Some(defects) if !defects.is_empty() => Err(defects),
            _ => Ok(run),
        }
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
        self.contents[index].path().into()
    }

    fn read(&self, index: usize, options: &ReadOptions) -> Result<Run, Vec<Defect>> {
        let files = match &self.contents[index] {
            Content::Csv(files) => files,
            Content::Container(_, Ok(number)) => return self.in_memory.read(*number, options),
            Content::Container(_, Err(defects)) => return Err(defects.clone()),
        };
        let options =
            LoggedOptions { gap_limit: options.gap_limit, until: options.until, ..self.options };
        let logged = read_logged(files, &options)?;
        if let Ok(mut found) = self.found.lock() {
            found[index] = Some((logged.understood, logged.notes));
        }
        self.checked(&files[0], logged.run)
    }
}

impl Log {
    /// Returns what was understood of the log for a run that was cut from it.
    fn understood(&self, run: &Run) -> Understood {
        let topics = self.topics().join(" and ");
        let named = |what: &str| {
            self.joints.iter().map(|joint| format!("{topics}/{joint}/{what}")).collect()
        };
        Understood {
            files: vec![self.path.display().to_string()],
            separator: "messages",
            samples: run.len(),
            duration: run.duration(),
            joints: self.joints.clone(),
            time: self.time_name().into(),
            q: named("position"),
            qd: named("velocity"),
            tau: named("effort"),
            torque: "measured",
            time_unit: "ns",
            angle_units: ["rad", "rad"],
            unused: self.unused.clone(),
            ..Understood::default()
        }
    }
}
