//! Stops, and whether links stay clear of obstacles.

use std::path::{Path, PathBuf};

use pyo3::prelude::*;
use reachtube::arm::{self, OfArm, beyond_proof_of_stops};
use reachtube::conform::{Keep, Opened};
use reachtube::page::{StopPage, stop_html, verify_files};
use reachtube::pipeline::ScenarioJob;
use reachtube::recordings::RunSource;
use reachtube::robot::JointKind;
use reachtube::verify::{Brakes, Category, Scenario, StopQuestion, stop_study};
use serde_json::{Value, json};

use crate::conformance::Wanted;
use crate::failure::{Failure, Result};
use crate::findings::list;
use crate::recordings::NativeSource;
use crate::watched::watched;

/// Encloses stops from recorded motions. `brakes` is the text of a TOML file, which errors name
/// `origin`, or JSON if there is none. Returns JSON: the answer, the findings, a summary, and the
/// page if the table is made.
#[pyfunction]
#[pyo3(signature = (
    model, source, suites, settings, brakes, origin, question, recorded=None, progress=None
))]
#[allow(clippy::too_many_arguments)]
pub(crate) fn stop(
    py: Python<'_>,
    model: String,
    source: PyRef<'_, NativeSource>,
    suites: Vec<String>,
    settings: String,
    brakes: String,
    origin: Option<String>,
    question: (u8, usize, bool),
    recorded: Option<PyRef<'_, NativeSource>>,
    progress: Option<Bound<'_, PyAny>>,
) -> PyResult<String> {
    let wanted =
        Wanted { model, source: source.source.clone(), suites, settings, keep: Keep::Needed };
    let recorded = recorded.map(|recorded| recorded.source.clone());
    watched(py, progress.as_ref(), move |watch| {
        let Opened { model, problem, tube } = wanted.open(watch)?;
        let (text, origin) = as_toml(brakes, origin, "brakes")?;
        let brakes = Brakes::from_toml(&text, &origin, problem.robot())?;
        let (category, every, table) = question;
        let input_set = |rates: &[f64]| problem.input_set_at(&tube.sets, rates);
        let category = Category::numbered(category, &brakes, &origin, &input_set)?;
        let recorded = recorded.as_ref().map(|source| source as &dyn RunSource);
        let question =
            StopQuestion { brakes: &brakes, category: &category, every, table, recorded };
        let study = stop_study(&problem, &tube.sets, &question)?;
        let robot = problem.robot();
        let warnings = &beyond_proof_of_stops(&model, &problem);
        let mut files = Vec::new();
        if table {
            let (model, brakes, study) = (&model, &brakes, &study);
            let page = StopPage { robot, model, brakes, study, warnings };
            files.push((reachtube::page::STOP_PAGE_FILE.to_string(), stop_html(&page)?));
        }
        let unit = JointKind::column(&robot.kinds(), JointKind::position_unit).any();
        let findings = [&study.findings[..], warnings].concat();
        Ok(kept(json!(study), &list(&findings), &study.text(&unit), &files))
    })
}

/// Decides whether links stay clear of the obstacles of a scenario: the text of a TOML file, which
/// errors name `origin`, or JSON if there is none. Paths are relative to `folder`. Returns JSON as
/// [`stop`] does, with the pictures and the closest motions as files. A model and recordings in
/// memory replace the files that the scenario names.
#[pyfunction]
#[pyo3(signature = (scenario, origin, folder, in_memory=None, progress=None))]
pub(crate) fn verify(
    py: Python<'_>,
    scenario: String,
    origin: Option<String>,
    folder: PathBuf,
    in_memory: Option<(String, PyRef<'_, NativeSource>)>,
    progress: Option<Bound<'_, PyAny>>,
) -> PyResult<String> {
    let in_memory = in_memory.map(|(model, source)| (model, source.source.clone()));
    watched(py, progress.as_ref(), move |watch| {
        let (text, origin) = as_toml(scenario, origin, "scenario")?;
        let scenario = Scenario::parse(text, &origin, &folder)?;
        let verified = match in_memory {
            None => ScenarioJob::new(scenario)?.run(watch)?,
            Some((model, source)) => {
                let (model, setup) = arm::parse(&model, Path::new("model"))?;
                ScenarioJob::with_model(scenario, model, setup)?.run_over(source, watch)?
            }
        };
        let findings = list(&verified.findings());
        let (text, mut files) = (verified.report().to_string(), verify_files(&verified));
        files.pop(); // The page.
        Ok(kept(verified.to_json(), &findings, &text, &files))
    })
}

/// Returns the text of a TOML file and its name; without a name, the text is JSON and is converted.
fn as_toml(text: String, origin: Option<String>, what: &str) -> Result<(String, String)> {
    if let Some(origin) = origin {
        return Ok((text, origin));
    }
    let value: Value = serde_json::from_str(&text).map_err(Failure::setting)?;
    let wrong = |error| Failure::Setting(format!("{what}: {error}; omit keys that are None"));
    let text = toml::to_string(&value).map_err(wrong)?;
    Ok((text, what.into()))
}

/// Returns what Python keeps of an answer.
fn kept(answer: Value, findings: &str, summary: &str, files: &[(String, String)]) -> String {
    let findings: Value = serde_json::from_str(findings).expect("a list of findings is JSON");
    let kept =
        json!({ "answer": answer, "findings": findings, "summary": summary, "files": files });
    kept.to_string()
}
