//! From logs to a model.

use std::path::PathBuf;
use std::sync::Arc;

use pyo3::prelude::*;
use reachtube::conform::Model;
use reachtube::finding::FrontEnd;
use reachtube::page::{Assets, built_pages, page_files};
use reachtube::pipeline::{Built, Choice, Choices, Cut, build};
use reachtube::{Progress, Robot};
use serde_json::{Map, Value, json};

use crate::abstraction::NativeAbstraction;
use crate::conformance::{basis, pull_without_fit};
use crate::failure::{Failure, Result};
use crate::findings::list;
use crate::logs_on_disk::LogsOnDisk;
use crate::recordings::NativeSource;
use crate::robot::NativeRobot;
use crate::watched::watched;

/// Makes a model of logs. `given` are choices as JSON, which come before the choices of the file
/// `settings`. Returns what Python keeps of the model as JSON, and notes about the logs.
#[pyfunction]
#[pyo3(signature = (robot, paths, runs, settings, given, progress=None))]
pub(crate) fn model(
    py: Python<'_>,
    robot: PyRef<'_, NativeRobot>,
    paths: Vec<PathBuf>,
    runs: Option<PyRef<'_, NativeSource>>,
    settings: Option<PathBuf>,
    given: String,
    progress: Option<Bound<'_, PyAny>>,
) -> PyResult<(String, Vec<String>)> {
    let robot = Arc::clone(&robot.robot);
    let runs = runs.map(|runs| runs.source.clone());
    watched(py, progress.as_ref(), move |watch| {
        let given = choices_of(&given)?;
        let of_file = settings.as_deref().map(Choices::load).transpose()?.unwrap_or_default();
        // The robot is here already; the file of choices may name another.
        let of_file = Choices { robot: None, lock: Vec::new(), ..of_file };
        let gives_pull = given.pull.is_some();
        let mut choices = of_file.replaced_by(given);
        if gives_pull && choices.fit.as_ref().is_none_or(Vec::is_empty) {
            return Err(pull_without_fit());
        }
        if !paths.is_empty() || runs.is_some() {
            choices.data.clear();
        }
        let named = std::mem::take(&mut choices.data).into_iter().chain(paths);
        let logs = LogsOnDisk::new(named.collect(), runs.as_ref())?;
        choices.data.clone_from(&logs.paths);
        let mut built = made(&robot, &choices, watch).map_err(|failure| logs.named(failure))?;
        if logs.has_runs() {
            // The folder is gone when the choices are read.
            built.choices.data.clear();
        }
        for finding in &mut built.findings {
            finding.text = logs.renamed(&finding.text);
        }
        let notes = built.notes.iter().map(|note| logs.renamed(note)).collect();
        Ok((kept(&built)?, notes))
    })
}

/// Reads choices that a caller gives, each by itself, so that an error names it.
fn choices_of(text: &str) -> Result<Choices> {
    let given: Map<String, Value> = serde_json::from_str(text).map_err(Failure::setting)?;
    given.into_iter().try_fold(Choices::default(), |choices, (key, value)| {
        let one = serde_json::from_value(json!({ &key: value }));
        let wrong = |error| Failure::Setting(format!("{}: {error}", key.replace('-', "_")));
        Ok(choices.replaced_by(one.map_err(wrong)?))
    })
}

fn made(robot: &Robot, choices: &Choices, watch: &dyn Progress) -> Result<Built> {
    let missing = |what: &str| Failure::Setting(format!("{what}, or in the file of settings"));
    let torque = choices.torque.ok_or_else(|| {
        missing("torque is not given; say \"motor\", \"link\" or \"compensated\"")
    })?;
    if choices.data.is_empty() {
        return Err(missing("no recordings are given; name them in data"));
    }
    let mut say = |choice: &Choice| {
        watch.finished(&format!("{}: {} ({})", choice.key, choice.value, choice.reason));
    };
    Ok(build(robot, torque, choices, None, &mut say, watch)?)
}

/// Returns what Python keeps of a model: the answer, its summary, and the files that `save` writes.
fn kept(built: &Built) -> Result<String> {
    let front_end = FrontEnd::Python;
    let mut answer = built.to_json();
    answer["findings"] =
        serde_json::from_str(&list(&built.all_findings())).map_err(Failure::setting)?;
    let mut files: Vec<(String, String)> =
        built.files().map(|(name, text)| (name.to_string(), text)).into();
    for (folder, page) in built_pages(built)? {
        for file in page_files(&page, Assets::Inside)? {
            let content = String::from_utf8_lossy(&file.content).into_owned();
            files.push((format!("{folder}/{}", file.path.display()), content));
        }
    }
    let verdict = built.verdict();
    let summary = built.summary(front_end).to_string();
    let kept = json!({ "answer": answer, "verdict": verdict, "summary": summary, "files": files });
    Ok(kept.to_string())
}

/// Reads logs and does to them what was done to the recordings of a model, whose text is `model`.
#[pyfunction]
#[pyo3(signature = (model, paths, runs))]
pub(crate) fn prepared(
    py: Python<'_>,
    model: String,
    paths: Vec<PathBuf>,
    runs: Option<PyRef<'_, NativeSource>>,
) -> PyResult<NativeSource> {
    let runs = runs.map(|runs| runs.source.clone());
    let windows = watched(py, None, move |_| {
        let model: Model =
            serde_json::from_str(&model).map_err(|error| Failure::ModelFile(error.to_string()))?;
        let preparation = model.preparation.as_ref();
        let preparation = preparation
            .ok_or_else(|| Failure::ModelFile("the model takes recordings as they are".into()))?;
        let logs = LogsOnDisk::new(paths, runs.as_ref())?;
        let windows = reachtube::pipeline::prepared(&model, preparation, &logs.paths);
        windows.map_err(|error| logs.named(error))
    })?;
    Ok(NativeSource::in_memory(windows))
}

/// Cuts logs into windows for a conformance. Returns them, what was done to the logs as JSON, and
/// notes.
#[pyfunction]
#[pyo3(signature = (robot, abstraction, torque, horizon, calibrate, paths, runs))]
#[allow(clippy::too_many_arguments)]
pub(crate) fn cut(
    py: Python<'_>,
    robot: Option<PyRef<'_, NativeRobot>>,
    abstraction: Option<PyRef<'_, NativeAbstraction>>,
    torque: String,
    horizon: f64,
    calibrate: Vec<String>,
    paths: Vec<PathBuf>,
    runs: Option<PyRef<'_, NativeSource>>,
) -> PyResult<(NativeSource, String, Vec<String>)> {
    let basis = basis(robot, abstraction).map_err(|failure| failure.raised(py))?;
    let runs = runs.map(|runs| runs.source.clone());
    let (cut, notes) = watched(py, None, move |_| {
        let torque = serde_json::from_value(json!(torque))
            .map_err(|error| Failure::Setting(format!("torque: {error}")))?;
        let logs = LogsOnDisk::new(paths, runs.as_ref())?;
        let robot = basis.robot()?.into_owned();
        let cut = Cut::new(&robot, torque, horizon, &calibrate, &logs.paths)
            .map_err(|error| logs.named(error))?;
        let notes: Vec<String> = cut.notes.iter().map(|note| logs.renamed(note)).collect();
        Ok((cut, notes))
    })?;
    let preparation = json!(cut.preparation).to_string();
    Ok((NativeSource::in_memory(cut.windows), preparation, notes))
}
