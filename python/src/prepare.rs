//! Recordings filtered and cut into windows.

use std::path::PathBuf;
use std::sync::Arc;

use pyo3::prelude::*;
use reachtube::Robot;
use reachtube::identify::prepare::{
    LogEntry, PrepareSettings, RawLog, check_window, cut_off, noise_left, prepare as prepared,
    read, windows,
};
use reachtube::recordings::{MemoryRuns, any_simulated};
use serde_json::{Map, Value, json};

use crate::failure::{Failure, Result};
use crate::logs_on_disk::LogsOnDisk;
use crate::recordings::NativeSource;
use crate::robot::NativeRobot;
use crate::watched::watched;

/// Options for cutting logs.
#[derive(Debug, Clone, Copy)]
struct Cutting {
    window: Option<f64>,
    repeats: bool,
    compensate: bool,
}

/// Filters logs and cuts them into windows; returns the windows, the cut-off frequency, Hz, and
/// what was changed.
#[pyfunction]
#[pyo3(signature = (robot, paths, runs, settings, cutting))]
pub(crate) fn prepare(
    py: Python<'_>,
    robot: PyRef<'_, NativeRobot>,
    paths: Vec<PathBuf>,
    runs: Option<PyRef<'_, NativeSource>>,
    settings: String,
    cutting: (Option<f64>, bool, bool),
) -> PyResult<(NativeSource, f64, Vec<String>)> {
    let robot = Arc::clone(&robot.robot);
    let runs = runs.map(|runs| runs.source.clone());
    let (window, repeats, compensate) = cutting;
    let cutting = Cutting { window, repeats, compensate };
    let (windows, cut_off, changes) = watched(py, None, move |_| {
        let settings = settings_of(&settings)?;
        let logs = LogsOnDisk::new(paths, runs.as_ref())?;
        let (windows, cut_off, changes) =
            cut(&robot, &logs, &settings, cutting).map_err(|failure| logs.named(failure))?;
        let changes = changes.iter().map(|change| logs.renamed(change)).collect();
        Ok((windows, cut_off, changes))
    })?;
    Ok((NativeSource::in_memory(windows), cut_off, changes))
}

/// Reads settings that a caller gives. Each is tried by itself first, so that an error names it.
fn settings_of(text: &str) -> Result<PrepareSettings> {
    let given: Map<String, Value> = serde_json::from_str(text).map_err(Failure::setting)?;
    for (name, value) in &given {
        let one = serde_json::from_value::<PrepareSettings>(json!({ name: value }));
        one.map_err(|error| Failure::json(name, &error))?;
    }
    serde_json::from_value(Value::Object(given)).map_err(Failure::setting)
}

fn cut(
    robot: &Robot,
    logs: &LogsOnDisk,
    settings: &PrepareSettings,
    cutting: Cutting,
) -> Result<(MemoryRuns, f64, Vec<String>)> {
    let Cutting { window, repeats, compensate } = cutting;
    if compensate {
        // A robot without masses has no gravity that could be subtracted.
        robot.check_physical()?;
    }
    let entries: Vec<LogEntry> = logs.paths.iter().cloned().map(LogEntry::from).collect();
    let raw = read(&entries, std::path::Path::new(""), robot, settings)?;
    window.map_or(Ok(()), |window| check_window(window, &raw))?;
    let cut_off = cut_off(&raw.iter().collect::<Vec<&RawLog>>(), settings)?;
    let prepared = prepared(&raw, settings, cut_off, compensate.then_some(robot))?;
    let mut cut = windows(&prepared.logs, window, repeats);
    cut.simulated = any_simulated(raw.iter().map(|log| &*log.file));
    cut.noise = noise_left(&raw.iter().collect::<Vec<&RawLog>>(), Some(cut_off));
    let origin = |log: &RawLog| (log.name.clone(), log.run.sha256.clone());
    cut.origins = raw.iter().map(origin).collect();
    let runs = cut.runs();
    if cut.windows.is_empty() {
        let what = match window {
            Some(window) => format!("no recording is as long as the window of {window} s"),
            None => "no recording has two samples or more".into(),
        };
        return Err(Failure::Other(what));
    }
    let notes: Vec<String> =
        raw.iter().flat_map(|log| [&log.notes[..], &log.moved].concat()).collect();
    Ok((runs, cut_off, [notes, prepared.changes, cut.changes].concat()))
}
