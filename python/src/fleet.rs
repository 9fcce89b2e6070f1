//! Recordings of a fleet, folded in parts.

use std::path::Path;
use std::sync::{Arc, Mutex, MutexGuard};

use pyo3::prelude::*;
use pyo3::pybacked::PyBackedBytes;
use reachtube::arm;
use reachtube::conform::fleet::{Fold, OnDefect};
use reachtube::conform::{self as product, Answer, Model, Problem, Setup, Tube};
use reachtube::recordings::{Defect, DefectKind};
use serde_json::{Map, Value};

use crate::abstraction::NativeAbstraction;
use crate::conformance::{basis, differing, fit_settings, setup, told};
use crate::failure::{Failure, Result};
use crate::manifest::{Entry, entry, read_csv, read_run};
use crate::pool;
use crate::recordings::NativeRun;
use crate::robot::NativeRobot;
use crate::watched::watched;

/// Settings for folding the recordings of a fleet: to find sets, or to check a model.
#[pyclass(frozen, name = "Fleet", module = "reachtube._reachtube")]
pub(crate) struct NativeFleet {
    setup: Arc<Setup>,
    model: Option<Arc<Model>>,
}

/// A part of a fleet's recordings. It holds what is needed of them, and not the recordings.
#[pyclass(frozen, name = "Fold", module = "reachtube._reachtube")]
pub(crate) struct NativeFold {
    fold: Mutex<Fold>,
}

/// SHA-256, number of samples and duration of a recording; or its defects.
type Summary = std::result::Result<(String, usize, f64), Vec<String>>;

/// The same as Python has it.
type Taken = (Option<(String, usize, f64)>, Vec<String>);

#[pymethods]
impl NativeFleet {
    /// Prepares a conformance.
    #[staticmethod]
    #[pyo3(signature = (robot, abstraction, settings))]
    fn to_conform(
        py: Python<'_>,
        robot: Option<PyRef<'_, NativeRobot>>,
        abstraction: Option<PyRef<'_, NativeAbstraction>>,
        settings: String,
    ) -> PyResult<Self> {
        let basis = basis(robot, abstraction).map_err(|failure| failure.raised(py))?;
        let setup = watched(py, None, move |_| setup(basis, &settings))?;
        Ok(Self { setup: Arc::new(setup), model: None })
    }

    /// Prepares a check of a model.
    #[staticmethod]
    fn to_check(py: Python<'_>, model: String, settings: String) -> PyResult<Self> {
        watched(py, None, move |_| {
            let (model, setup) = arm::parse(&model, Path::new("model"))?;
            let given: Map<String, Value> =
                serde_json::from_str(&settings).map_err(Failure::setting)?;
            let setup = differing(setup, given)?;
            Ok(Self { setup: Arc::new(setup), model: Some(Arc::new(model)) })
        })
    }

    /// Returns the fold of no recording.
    fn fold(&self, py: Python<'_>) -> PyResult<NativeFold> {
        let fold = match &self.model {
            None => Fold::new(&self.setup),
            Some(model) => Fold::to_check(&self.setup, model),
        };
        let fold = fold.map_err(|error| Failure::from(error).raised(py))?;
        Ok(NativeFold { fold: Mutex::new(fold) })
    }

    /// Merges folds in any order.
    fn merge(&self, py: Python<'_>, parts: Vec<PyBackedBytes>) -> PyResult<Vec<u8>> {
        let setup = Arc::clone(&self.setup);
        watched(py, None, move |_| Ok(merged(&setup, &parts)?.to_bytes()))
    }

    /// Returns how many recordings have no defect, how many have some, and their list for people.
    fn count(&self, py: Python<'_>, fold: PyBackedBytes) -> PyResult<(u64, u64, Vec<String>)> {
        let setup = Arc::clone(&self.setup);
        watched(py, None, move |_| {
            let fold = Fold::from_bytes(&setup, &fold)?;
            let defects = fold.defects().iter().map(ToString::to_string).collect();
            Ok((fold.run_count(), fold.defect_count(), defects))
        })
    }

    /// Refuses what cannot be fitted, whatever the recordings are.
    #[pyo3(signature = (fit, pull=None))]
    fn check_fit(&self, py: Python<'_>, fit: Vec<String>, pull: Option<f64>) -> PyResult<()> {
        let setup = Arc::clone(&self.setup);
        watched(py, None, move |_| {
            if let Some(settings) = fit_settings(&fit, pull)? {
                settings.check(&setup)?;
            }
            Ok(())
        })
    }

    /// Finds the smallest sets, of a fitted nominal model where groups are given, and returns the
    /// model file's text and notes.
    #[pyo3(signature = (fold, report, fit, pull=None, progress=None))]
    fn conform(
        &self,
        py: Python<'_>,
        fold: PyBackedBytes,
        report: bool,
        fit: Vec<String>,
        pull: Option<f64>,
        progress: Option<Bound<'_, PyAny>>,
    ) -> PyResult<(String, Vec<String>)> {
        let setup = Arc::clone(&self.setup);
        watched(py, progress.as_ref(), move |watch| {
            let problem = problem(&setup, &fold, report)?;
            let fit = fit_settings(&fit, pull)?;
            Ok(told(&Answer::new(problem, fit.as_ref(), None, watch)?))
        })
    }

    /// Compares the recordings with the model's reachable sets, and returns the answer as JSON.
    fn check(&self, py: Python<'_>, fold: PyBackedBytes, report: bool) -> PyResult<String> {
        let (setup, model) = (Arc::clone(&self.setup), self.model.clone());
        watched(py, None, move |_| {
            let model = model.ok_or_else(|| Failure::Setting("there is no model".into()))?;
            let problem = problem(&setup, &fold, report)?;
            let tube = Tube::new(&problem, model.sets())?;
            let check = product::check(&model, &problem, &tube)?;
            Ok(serde_json::to_string(&check).expect("a check has string keys"))
        })
    }
}

fn merged(setup: &Setup, parts: &[PyBackedBytes]) -> Result<Fold> {
    let mut parts = parts.iter().map(|part| Fold::from_bytes(setup, part));
    let first = parts.next().ok_or_else(|| Failure::Setting("there is no fold".into()))??;
    parts.try_fold(first, |mut all, part| {
        all.merge(part?)?;
        Ok(all)
    })
}

fn problem(setup: &Setup, fold: &[u8], report: bool) -> Result<Problem> {
    let fold = Fold::from_bytes(setup, fold)?;
    let on_defect = if report { OnDefect::Report } else { OnDefect::Refuse };
    Ok(Problem::of_fold(setup.clone(), fold, on_defect)?)
}

impl NativeFold {
    fn lock(&self) -> MutexGuard<'_, Fold> {
        self.fold.lock().unwrap_or_else(|lock| lock.into_inner())
    }

    fn take(
        &self,
        py: Python<'_>,
        row: &Entry,
        read: impl FnOnce(&Fold) -> Result<reachtube::Run, Vec<Defect>> + Send,
    ) -> PyResult<Taken> {
        pool::check()?;
        let entry = entry(row);
        let taken = py.detach(|| {
            let mut fold = self.lock();
            let read = read(&fold).map(reachtube::Run::with_digest);
            let summary = match &read {
                Ok(run) => Ok((run.sha256.clone(), run.len(), run.duration())),
                Err(defects) => Err(defects.iter().map(ToString::to_string).collect()),
            };
            fold.take(row.0, &entry, read)?;
            Ok(summary)
        });
        let taken: Result<Summary, product::Error> = taken;
        let (summary, defects) = match taken.map_err(|e| Failure::from(e).raised(py))? {
            Ok(summary) => (Some(summary), vec![]),
            Err(defects) => (None, defects),
        };
        Ok((summary, defects))
    }
}

#[pymethods]
impl NativeFold {
    /// Takes the recording in the content of a CSV file.
    fn take_csv(&self, py: Python<'_>, row: Entry, content: &[u8]) -> PyResult<Taken> {
        self.take(py, &row, |fold| read_csv(&row, content, &fold.read_options()))
    }

    /// Takes a recording in memory.
    fn take_run(&self, py: Python<'_>, row: Entry, run: PyRef<'_, NativeRun>) -> PyResult<Taken> {
        let run = Arc::clone(&run.run);
        self.take(py, &row, |fold| read_run(&row, &run, &fold.read_options()))
    }

    /// Takes a recording that could not be read.
    fn take_defect(
        &self,
        py: Python<'_>,
        row: Entry,
        problem: String,
        remedy: String,
    ) -> PyResult<Taken> {
        let defect = Defect::new(&row.1, None, problem, remedy).of_kind(DefectKind::File);
        self.take(py, &row, |_| Err(vec![defect]))
    }

    /// Merges the bytes of another fold of the same job.
    fn merge(&self, py: Python<'_>, fleet: PyRef<'_, NativeFleet>, part: &[u8]) -> PyResult<()> {
        pool::check()?;
        let setup = &fleet.setup;
        let merged = py.detach(|| self.lock().merge(Fold::from_bytes(setup, part)?));
        merged.map_err(|error| Failure::from(error).raised(py))
    }

    fn to_bytes(&self, py: Python<'_>) -> Vec<u8> {
        py.detach(|| self.lock().to_bytes())
    }
}
