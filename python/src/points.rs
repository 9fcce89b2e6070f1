//! The recorded points of a fleet, which the notions phase-plane and exact ask in rounds.

use std::sync::{Arc, Mutex, PoisonError};

use pyo3::prelude::*;
use pyo3::pybacked::PyBackedBytes;
use pyo3::types::PyBytes;
use reachtube::conform::fleet::{FleetProblem, PartPoints, PartReader, PointServer};

use crate::failure::Failure;
use crate::manifest::{Entry, Read, entry, read_csv, read_run};
use crate::pool;
use crate::recordings::NativeRun;

/// What every part of a fleet needs to find its points.
#[pyclass(frozen, name = "FleetProblem", module = "reachtube._reachtube")]
pub(crate) struct NativeFleetProblem {
    pub problem: FleetProblem,
}

/// The recorded points of a part.
#[pyclass(frozen, name = "PartPoints", module = "reachtube._reachtube")]
pub(crate) struct NativePartPoints {
    points: PartPoints,
}

/// A recording of a part: a CSV file's content, or a run in memory.
#[derive(FromPyObject)]
enum Recorded<'py> {
    Content(Bound<'py, PyBytes>),
    Run(PyRef<'py, NativeRun>),
}

#[pymethods]
impl NativePartPoints {
    /// Takes the recordings of a part, which `recordings` returns one by one: the entry of each in
    /// the manifest, and what was read.
    #[staticmethod]
    fn read(
        py: Python<'_>,
        fleet: PyRef<'_, NativeFleetProblem>,
        recordings: Bound<'_, PyAny>,
    ) -> PyResult<Self> {
        let raised = |error| Failure::from(error).raised(py);
        let mut reader = PartReader::new(&fleet.problem).map_err(raised)?;
        for item in recordings.try_iter()? {
            let (row, recorded): (Entry, Option<Recorded<'_>>) = item?.extract()?;
            let options = reader.read_options();
            let read: Read = match &recorded {
                Some(Recorded::Content(content)) => read_csv(&row, content.as_bytes(), &options),
                Some(Recorded::Run(run)) => read_run(&row, &run.run, &options),
                // It has defects.
                None => Err(Vec::new()),
            };
            reader.take(row.0, &entry(&row), read).map_err(raised)?;
        }
        Ok(Self { points: reader.finish() })
    }

    /// Answers a question.
    fn answer(
        &self,
        py: Python<'_>,
        fleet: PyRef<'_, NativeFleetProblem>,
        question: &[u8],
    ) -> PyResult<Vec<u8>> {
        pool::check()?;
        let fleet = &fleet.problem;
        let answer = py.detach(|| self.points.answer(fleet, question));
        answer.map_err(|error| Failure::from(error).raised(py))
    }

    /// Merges the answers of parts to one question, in any order.
    #[staticmethod]
    fn merge(py: Python<'_>, answers: Vec<PyBackedBytes>) -> PyResult<Vec<u8>> {
        pool::check()?;
        let merged = py.detach(|| PartPoints::merge(answers.iter().map(|answer| &**answer)));
        merged.map_err(|error| Failure::from(error).raised(py))
    }

    fn to_bytes<'py>(&self, py: Python<'py>) -> Bound<'py, PyBytes> {
        PyBytes::new(py, &py.detach(|| self.points.to_bytes()))
    }

    #[staticmethod]
    fn from_bytes(py: Python<'_>, data: &[u8]) -> PyResult<Self> {
        let points = py.detach(|| PartPoints::from_bytes(data));
        points.map(|points| Self { points }).map_err(|error| Failure::from(error).raised(py))
    }

    fn __reduce__<'py>(
        slf: &Bound<'py, Self>,
    ) -> PyResult<(Bound<'py, PyAny>, (Bound<'py, PyBytes>,))> {
        let py = slf.py();
        let make = py.get_type::<Self>().getattr("from_bytes")?;
        Ok((make, (slf.get().to_bytes(py),)))
    }

    /// Returns the bytes in memory, by which Dask plans.
    fn __sizeof__(&self) -> usize {
        self.points.size()
    }
}

/// A function of Python that asks all points.
#[derive(Debug)]
pub(crate) struct Asked {
    ask: Py<PyAny>,
    /// The exception with which it ended.
    raised: Mutex<Option<PyErr>>,
}

impl PointServer for Asked {
    fn ask(&self, question: &[u8]) -> Result<Vec<u8>, String> {
        Python::attach(|py| {
            let answer = self.ask.call1(py, (PyBytes::new(py, question),));
            let answer =
                answer.and_then(|answer| Ok(answer.extract::<PyBackedBytes>(py)?.to_vec()));
            answer.map_err(|error| {
                let words = format!("the points gave no answer: {error}");
                *self.raised.lock().unwrap_or_else(PoisonError::into_inner) = Some(error);
                words
            })
        })
    }
}

/// Runs a job that may ask points. The job raises the exception of the function that asks.
pub(crate) fn asking<T>(
    ask: Option<Py<PyAny>>,
    job: impl FnOnce(Option<Arc<Asked>>) -> PyResult<T>,
) -> PyResult<T> {
    let Some(ask) = ask else { return job(None) };
    let server = Arc::new(Asked { ask, raised: Mutex::default() });
    job(Some(Arc::clone(&server))).map_err(|error| {
        let raised = server.raised.lock().unwrap_or_else(PoisonError::into_inner).take();
        raised.unwrap_or(error)
    })
}
