//! Sets, verdicts and reachable sets.

use std::path::{Path, PathBuf};

use pyo3::prelude::*;
use reachtube::abstraction::ExpansionPoint;
use reachtube::arm::{self, ArmSettings, Basis};
use reachtube::conform::{
    Answer, CheckJob, FitSettings, Group, Job, Keep, Opened, Settings, Setup, SuiteReach,
};
use reachtube::finding::FrontEnd;
use reachtube::page::{Assets, LIBRARY_FILE, Sources, page, write_html, write_library};
use reachtube::pipeline::unexplained_by_model;
use reachtube::{Progress, Torque, write};
use serde_json::{Map, Value};

use crate::abstraction::NativeAbstraction;
use crate::arrays::{Output, array};
use crate::failure::{Failure, Result};
use crate::logs_on_disk::LogsOnDisk;
use crate::recordings::{NativeSource, SharedSource};
use crate::robot::NativeRobot;
use crate::watched::watched;

/// Returns settings from the defaults and a JSON object with the settings that differ.
fn settings(text: &str, joints: usize) -> Result<(ArmSettings, Settings)> {
    let mut given: Map<String, Value> = serde_json::from_str(text).map_err(Failure::setting)?;
    let torque = given.remove("torque").unwrap_or_default();
    let torque: Torque = serde_json::from_value(torque)
        .map_err(|error| Failure::Setting(format!("torque: {error}")))?;
    let expansion = take::<Vec<f64>>(&mut given, "expansion")?.unwrap_or_default();
    let max_gap = take::<f64>(&mut given, "max_gap")?;
    let defaults = ArmSettings::new(torque, joints);
    let arm = ArmSettings {
        abstraction: take(&mut given, "abstraction")?.unwrap_or(defaults.abstraction),
        equations: take(&mut given, "equations")?.unwrap_or(defaults.equations),
        expansion_point: ExpansionPoint::from_values(&expansion, joints)?,
        torque,
    };
    let mut all = serde_json::to_value(Settings::default()).map_err(Failure::setting)?;
    for (name, value) in given {
        all[&name] = value;
        // Each by itself, so that an error names the setting.
        let tried = serde_json::from_value::<Settings>(all.clone());
        tried.map_err(|error| Failure::Setting(format!("{name}: {error}")))?;
    }
    let settings: Settings = serde_json::from_value(all).map_err(Failure::setting)?;
    let settings = Settings { gap_limit: max_gap.into(), ..settings };
    settings.validate(joints)?;
    Ok((arm, settings))
}

fn take<T: serde::de::DeserializeOwned>(
    given: &mut Map<String, Value>,
    name: &str,
) -> Result<Option<T>> {
    let Some(value) = given.remove(name) else { return Ok(None) };
    let wrong = |error| Failure::Setting(format!("{name}: {error}"));
    serde_json::from_value(value).map(Some).map_err(wrong)
}

/// Returns what a nominal model is made of.
pub(crate) fn basis(
    robot: Option<PyRef<'_, NativeRobot>>,
    abstraction: Option<PyRef<'_, NativeAbstraction>>,
) -> Result<Basis> {
    match (robot, abstraction) {
        (_, Some(model)) => Ok((*model.model).clone().into()),
        (Some(robot), None) => Ok((*robot.robot).clone().into()),
        (None, None) => Err(Failure::Setting("give a robot".into())),
    }
}

/// Returns the setup of a conformance, whose settings are the defaults but for those given.
pub(crate) fn setup(basis: Basis, settings_text: &str) -> Result<Setup> {
    let (arm, settings) = settings(settings_text, basis.joints())?;
    Ok(basis.setup(arm, settings)?)
}

/// Finds the smallest sets, and returns the model file's text and notes about the recordings.
/// `preparation` is what was done to logs before, as JSON.
#[pyfunction]
#[pyo3(signature = (
    robot, abstraction, source, suites, settings, fit, pull=None, resume=None, preparation=None,
    progress=None
))]
#[allow(clippy::too_many_arguments)]
pub(crate) fn conform(
    py: Python<'_>,
    robot: Option<PyRef<'_, NativeRobot>>,
    abstraction: Option<PyRef<'_, NativeAbstraction>>,
    source: PyRef<'_, NativeSource>,
    suites: Vec<String>,
    settings: String,
    fit: Vec<String>,
    pull: Option<f64>,
    resume: Option<PathBuf>,
    preparation: Option<String>,
    progress: Option<Bound<'_, PyAny>>,
) -> PyResult<(String, Vec<String>)> {
    let basis = basis(robot, abstraction).map_err(|failure| failure.raised(py))?;
    let source = source.source.clone();
    watched(py, progress.as_ref(), move |watch| {
        let job = Job::new(setup(basis, &settings)?, source)
            .suites(suites)
            .fit(fit_settings(&fit, pull)?)
            .resume(resume);
        let mut answer = job.run(watch)?;
        if let Some(preparation) = &preparation {
            let preparation = serde_json::from_str(preparation).map_err(Failure::setting)?;
            answer.model = answer.model.with_preparation(preparation);
        }
        Ok(told(&answer))
    })
}

/// Returns the model file's text, and notes about the recordings.
pub(crate) fn told(answer: &Answer) -> (String, Vec<String>) {
    (answer.model.to_json(), answer.problem.recordings().notes.clone())
}

/// Returns what is to be fitted; nothing without any group.
pub(crate) fn fit_settings(groups: &[String], pull: Option<f64>) -> Result<Option<FitSettings>> {
    let groups = serde_json::to_value(groups).and_then(serde_json::from_value);
    let groups: Vec<Group> = groups.map_err(|error| Failure::Setting(format!("fit: {error}")))?;
    match (groups.is_empty(), pull) {
        (true, Some(_)) => Err(pull_without_fit()),
        (true, None) => Ok(None),
        (false, _) => Ok(Some(FitSettings { groups, pull })),
    }
}

/// Returns the failure about a pull if nothing is fitted.
pub(crate) fn pull_without_fit() -> Failure {
    Failure::Setting("pull is the weight of a fit, and fit names no group".into())
}

/// Returns the JSON schema of model files.
#[pyfunction]
pub(crate) fn model_schema() -> String {
    arm::model_schema().to_string()
}

/// Checks the text of a model file; errors name it `origin`.
#[pyfunction]
pub(crate) fn check_model(py: Python<'_>, text: String, origin: String) -> PyResult<()> {
    watched(py, None, move |_| Ok(arm::parse(&text, Path::new(&origin)).map(|_| ())?))
}

/// Returns the text of a model file whose bounds count the models in the folder of `path` that the
/// same recordings calibrated.
#[pyfunction]
pub(crate) fn among_others(py: Python<'_>, text: String, path: PathBuf) -> PyResult<String> {
    watched(py, None, move |_| Ok(arm::parse(&text, &path)?.0.among_others(&path).to_json()))
}

/// Sets what differs from a model's settings.
pub(crate) fn differing(setup: Setup, mut given: Map<String, Value>) -> Result<Setup> {
    let (notion, until) = (take(&mut given, "notion")?, take(&mut given, "until")?);
    Ok(setup.judged_by(notion, until, take::<f64>(&mut given, "max_gap")?.into()))
}

/// The recordings that a model needs: the recordings, and what differs from the model's settings.
pub(crate) struct Wanted {
    pub model: String,
    pub source: SharedSource,
    pub suites: Vec<String>,
    pub settings: String,
    pub keep: Keep,
}

impl Wanted {
    pub(crate) fn open(self, watch: &dyn Progress) -> Result<Opened> {
        let (model, setup) = arm::parse(&self.model, Path::new("model"))?;
        let mut given: Map<String, Value> =
            serde_json::from_str(&self.settings).map_err(Failure::setting)?;
        let job = CheckJob::new(model, setup, self.source)
            .suites(self.suites)
            .notion(take(&mut given, "notion")?)
            .until(take(&mut given, "until")?)
            .gap_limit(take::<f64>(&mut given, "max_gap")?.into())
            .keep(self.keep);
        Ok(job.open(watch)?)
    }
}

/// Compares recordings with a model's reachable sets, and returns the answer as JSON. Logs that
/// leave them are read again at `paths` and of `runs`, for why.
#[pyfunction]
#[pyo3(signature = (model, source, suites, settings, paths, runs, progress=None))]
#[allow(clippy::too_many_arguments)]
pub(crate) fn check(
    py: Python<'_>,
    model: String,
    source: PyRef<'_, NativeSource>,
    suites: Vec<String>,
    settings: String,
    paths: Vec<PathBuf>,
    runs: Option<PyRef<'_, NativeSource>>,
    progress: Option<Bound<'_, PyAny>>,
) -> PyResult<String> {
    let (source, runs) = (source.source.clone(), runs.map(|runs| runs.source.clone()));
    let wanted = Wanted { model, source, suites, settings, keep: Keep::Needed };
    watched(py, progress.as_ref(), move |watch| {
        let opened = wanted.open(watch)?;
        let mut check = opened.check()?;
        if !check.holds() {
            let logs = LogsOnDisk::new(paths, runs.as_ref())?;
            let causes = unexplained_by_model(&opened.model, &logs.paths);
            check = check.explained_by(causes.map_err(|error| logs.named(error))?);
        }
        Ok(serde_json::to_string(&check).expect("a check has string keys"))
    })
}

/// A reachable set: suite, run, times (K), nominal, lower and upper bounds at the samples (K x 2n
/// each), lower and upper bounds over the steps (K - 1 x 2n each), and why it ended early as JSON.
type NativeReach<'py> =
    (String, Option<String>, Output<'py>, Vec<Output<'py>>, Vec<Output<'py>>, Option<String>);

/// Computes a model's reachable sets along recordings.
#[pyfunction]
#[pyo3(signature = (model, source, suites, settings, progress=None))]
pub(crate) fn reach<'py>(
    py: Python<'py>,
    model: String,
    source: PyRef<'_, NativeSource>,
    suites: Vec<String>,
    settings: String,
    progress: Option<Bound<'_, PyAny>>,
) -> PyResult<Vec<NativeReach<'py>>> {
    let source = source.source.clone();
    let wanted = Wanted { model, source, suites, settings, keep: Keep::Needed };
    let found = watched(py, progress.as_ref(), move |watch| Ok(wanted.open(watch)?.reach()?))?;
    Ok(found.into_iter().map(|reach| arrays_of(py, reach)).collect())
}

fn arrays_of(py: Python<'_>, reach: SuiteReach) -> NativeReach<'_> {
    let SuiteReach { suite, run, times, nominal, lower, upper, tube, dimension, lost } = reach;
    let samples = [times.len(), dimension];
    let steps = [tube.len(), dimension];
    let bounds = || (0..tube.len()).flat_map(|k| tube.bounds(k));
    let low = bounds().map(|bound| bound.lo()).collect();
    let high = bounds().map(|bound| bound.hi()).collect();
    (
        suite,
        run,
        array(py, times, &samples[..1]),
        [nominal, lower, upper].map(|values| array(py, values, &samples)).into(),
        [low, high].map(|values| array(py, values, &steps)).into(),
        lost.map(|lost| serde_json::to_string(&lost).expect("it has string keys")),
    )
}

/// Writes the report page, and the library of its figures beside it if `beside`; returns the
/// page's path.
#[pyfunction]
#[pyo3(signature = (model, source, suites, settings, folder, beside, progress=None))]
#[allow(clippy::too_many_arguments)]
pub(crate) fn report(
    py: Python<'_>,
    model: String,
    source: PyRef<'_, NativeSource>,
    suites: Vec<String>,
    settings: String,
    folder: PathBuf,
    beside: bool,
    progress: Option<Bound<'_, PyAny>>,
) -> PyResult<String> {
    let source = source.source.clone();
    let wanted = Wanted { model, source, suites, settings, keep: Keep::All };
    let (html, library) = watched(py, progress.as_ref(), move |watch| {
        let opened = wanted.open(watch)?;
        let (check, reach) = (opened.check()?, opened.reach()?);
        let Opened { model, problem, .. } = &opened;
        let sources =
            Sources { model, problem, reach: &reach, check: &check, front_end: FrontEnd::Python };
        let (mut html, mut library) = (Vec::new(), Vec::new());
        let assets = if beside { Assets::Beside } else { Assets::Inside };
        let page = page(&sources)?;
        write_html(&page, assets, &mut html)?;
        if beside {
            write_library(&mut library)?;
        }
        Ok((html, library))
    })?;
    // Nothing is written before everything is known.
    let path = folder.join("report.html");
    let save = |path: &Path, content: &[u8]| {
        write::atomically(path, |out| out.write_all(content))
            .map_err(|error| Failure::from(error).raised(py))
    };
    if beside {
        save(&folder.join(LIBRARY_FILE), &library)?;
    }
    save(&path, &html)?;
    Ok(path.display().to_string())
}
