//! Identification of a robot.

use std::path::PathBuf;
use std::sync::Arc;

use pyo3::prelude::*;
use reachtube::identify::IdentifySettings;
use reachtube::identify::prepare::LogEntry;
use reachtube::page::identified_html;
use reachtube::{Robot, Run};
use serde_json::{Map, Value};

use crate::failure::{Failure, Result};
use crate::recordings::{NativeRun, csv};
use crate::robot::NativeRobot;
use crate::watched::watched;

/// The parts of an identification that Python keeps: what `reachtube identify --json` prints, the
/// robot file with standard errors, and the report page.
type Identified = (String, String, String);

/// Recordings of one use: paths, and runs in memory with their places in the order of recording.
type Recorded<'py> = (Vec<PathBuf>, Vec<(PyRef<'py, NativeRun>, Option<u64>)>);

/// Writes runs in memory as CSV files, whose numbers are read back to the last bit.
fn entries(
    paths: Vec<PathBuf>,
    runs: &[(Arc<Run>, Option<u64>)],
    folder: &std::path::Path,
    name: &str,
) -> Result<Vec<LogEntry>> {
    let mut entries: Vec<LogEntry> = paths.into_iter().map(LogEntry::Path).collect();
    for (number, (run, order)) in runs.iter().enumerate() {
        let path = folder.join(format!("{name}_{}.csv", number + 1));
        let text = csv(run);
        reachtube::write::atomically(&path, |out| out.write_all(text.as_bytes()))?;
        entries.push(LogEntry::Stretch {
            path,
            from: 0.0,
            until: None,
            order: *order,
            compensated: false,
        });
    }
    Ok(entries)
}

/// Returns the settings of a JSON object, over the settings that `basis` has as TOML.
fn settings(basis: Option<&str>, given: &str) -> Result<IdentifySettings> {
    let basis = basis.map_or(Ok(IdentifySettings::default()), |text| {
        IdentifySettings::from_toml(text, "settings")
    })?;
    let mut all = serde_json::to_value(basis).map_err(Failure::setting)?;
    let given: Map<String, Value> = serde_json::from_str(given).map_err(Failure::setting)?;
    for (section, values) in given {
        let Value::Object(values) = values else { continue };
        for (name, value) in values {
            all[&section][&name] = value;
            let tried = serde_json::from_value::<IdentifySettings>(all.clone());
            tried.map_err(|error| Failure::Setting(format!("{name}: {error}")))?;
        }
    }
    serde_json::from_value(all).map_err(Failure::setting)
}

/// Identifies a robot from recordings at rest, of slow motions, of exciting motions, and of motions
/// that validate it; returns the texts of the result.
#[pyfunction]
#[pyo3(signature = (robot, recorded, toml, given, folder, progress=None))]
pub(crate) fn identify(
    py: Python<'_>,
    robot: PyRef<'_, NativeRobot>,
    recorded: [Recorded<'_>; 4],
    toml: Option<String>,
    given: String,
    folder: PathBuf,
    progress: Option<Bound<'_, PyAny>>,
) -> PyResult<Identified> {
    let robot: Arc<Robot> = Arc::clone(&robot.robot);
    let recorded = recorded.map(|(paths, runs)| {
        let runs = runs.iter().map(|(run, order)| (Arc::clone(&run.run), *order));
        (paths, runs.collect::<Vec<_>>())
    });
    watched(py, progress.as_ref(), move |watch| {
        let mut settings = settings(toml.as_deref(), &given)?;
        let files = tempfile::tempdir()
            .map_err(|error| Failure::Other(format!("no temporary folder: {error}")))?;
        let IdentifySettings { rest, one_joint, excitation, validate, .. } = &mut settings;
        let uses = [
            (rest, "rest"),
            (one_joint, "one_joint"),
            (excitation, "excitation"),
            (validate, "validate"),
        ];
        for ((wanted, name), (paths, runs)) in uses.into_iter().zip(recorded) {
            if !paths.is_empty() || !runs.is_empty() {
                *wanted = entries(paths, &runs, files.path(), name)?;
            }
        }
        let step = |done, total| watch.count(done, total);
        let found = reachtube::identify::identify(&robot, &settings, &folder, &step)
            .map_err(|error| Failure::from(error).of_runs_in(files.path()))?;
        let summary = serde_json::to_string(&found.summary()).map_err(Failure::setting)?;
        let page = identified_html(&found).map_err(|error| Failure::Other(error.to_string()))?;
        Ok((summary, found.robot_toml(), page))
    })
}
