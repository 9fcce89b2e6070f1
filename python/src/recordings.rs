//! Recordings: runs from arrays, and data sets.

use std::sync::Arc;

use pyo3::prelude::*;
use reachtube::recordings::{
    DataSet, Defect, GapLimit, MemoryRuns, ReadOptions, RunEntry, column_names, inspect,
    picoseconds,
};
use reachtube::{Run, RunSource};

use crate::arrays::{Input, Output, array, values};
use crate::failure::{Failure, Result};
use crate::watched::{watched, watched_alone};

/// One run.
#[pyclass(frozen, name = "Run", module = "reachtube._reachtube")]
pub(crate) struct NativeRun {
    pub run: Arc<Run>,
}

/// Returns the times since the first, s, as a CSV file with the same numbers has them: differences
/// of the shortest decimals, to the picosecond.
fn relative(times: &[f64]) -> Result<Vec<f64>> {
    let wrong = |k: usize| {
        Failure::Setting(format!("t holds {} at sample {k} (from 0); drop that sample", times[k]))
    };
    let exact: Vec<i128> = times
        .iter()
        .enumerate()
        .map(|(k, time)| picoseconds(&time.to_string()).ok_or_else(|| wrong(k)))
        .collect::<Result<_>>()?;
    if let Some(k) = (1..exact.len()).find(|&k| exact[k] <= exact[k - 1]) {
        return Err(Failure::Setting(format!(
            "t is {} s at sample {k} (from 0), which is not a picosecond after the sample before; \
             sort the samples and drop duplicates",
            times[k]
        )));
    }
    // Both numbers are exact in double precision up to 2.5 hours; a division rounds once.
    Ok(exact.iter().map(|time| (time - exact[0]) as f64 / 1e12).collect())
}

/// Returns a run; `start` is the time of its first sample where times already count from it.
fn run_of(
    start: Option<f64>,
    t: &Input<'_>,
    q: &Input<'_>,
    qd: &Input<'_>,
    tau: &Input<'_>,
    temperature: Option<&Input<'_>>,
) -> Result<Run> {
    let samples = t.as_array().len();
    let joints = q.as_array().shape().get(1).copied().unwrap_or(0);
    let times = values("t", t, &[samples])?;
    let shape = [samples, joints];
    let (q, qd, tau) =
        (values("q", q, &shape)?, values("qd", qd, &shape)?, values("tau", tau, &shape)?);
    let states = q.chunks(joints.max(1)).zip(qd.chunks(joints.max(1)));
    let states = states.flat_map(|(q, qd)| q.iter().chain(qd)).copied().collect();
    let first = times.first().copied().unwrap_or(0.0);
    let times = if start.is_some() { times } else { relative(&times)? };
    let run = Run::new(joints, times, states, tau).map_err(Failure::setting)?;
    let run = Run { start: start.unwrap_or(first), ..run };
    match temperature {
        None => Ok(run),
        Some(given) => {
            let given = values("temperature", given, &shape)?;
            run.with_temperatures(given).map_err(Failure::setting)
        }
    }
}

#[pymethods]
impl NativeRun {
    #[new]
    #[pyo3(signature = (start, t, q, qd, tau, temperature=None))]
    fn new(
        py: Python<'_>,
        start: Option<f64>,
        t: Input<'_>,
        q: Input<'_>,
        qd: Input<'_>,
        tau: Input<'_>,
        temperature: Option<Input<'_>>,
    ) -> PyResult<Self> {
        let run = run_of(start, &t, &q, &qd, &tau, temperature.as_ref());
        run.map(|run| Self { run: run.into() }).map_err(|failure| failure.raised(py))
    }

    /// Returns times since the first sample, q, qd, tau and, if they were recorded, the
    /// temperatures.
    #[allow(clippy::type_complexity)]
    fn arrays<'py>(
        &self,
        py: Python<'py>,
    ) -> (Output<'py>, Output<'py>, Output<'py>, Output<'py>, Option<Output<'py>>) {
        let (run, n) = (&*self.run, self.run.joints);
        let shape = [run.len(), n];
        let half = |first: usize| {
            run.states.chunks(2 * n).flat_map(|x| &x[first..first + n]).copied().collect()
        };
        let warm = (!run.temperatures.is_empty()).then(|| run.temperatures.clone());
        (
            array(py, run.times.clone(), &shape[..1]),
            array(py, half(0), &shape),
            array(py, half(n), &shape),
            array(py, run.torques.clone(), &shape),
            warm.map(|warm| array(py, warm, &shape)),
        )
    }

    fn start(&self) -> f64 {
        self.run.start
    }

    fn samples(&self) -> usize {
        self.run.len()
    }

    fn joints(&self) -> usize {
        self.run.joints
    }

    fn duration(&self) -> f64 {
        self.run.duration()
    }
}

/// A source of recordings that jobs share.
#[derive(Debug, Clone)]
pub(crate) struct SharedSource(pub Arc<dyn RunSource>);

impl RunSource for SharedSource {
    fn index_name(&self) -> std::path::PathBuf {
        self.0.index_name()
    }

    fn runs(&self) -> &[RunEntry] {
        self.0.runs()
    }

    fn run_name(&self, index: usize) -> std::path::PathBuf {
        self.0.run_name(index)
    }

    fn read(&self, index: usize, options: &ReadOptions) -> Result<Run, Vec<Defect>> {
        self.0.read(index, options)
    }

    fn notes(&self) -> Vec<String> {
        self.0.notes()
    }
}

/// Returns a run as a CSV file, whose numbers are read back to the last bit, with the temperatures
/// if it has them.
pub(crate) fn csv(run: &Run) -> String {
    let mut text = String::from("t");
    column_names(run.joints).for_each(|column| text += &format!(",{column}"));
    let warm = if run.temperatures.is_empty() { 0 } else { run.joints };
    (1..=warm).for_each(|joint| text += &format!(",temp{joint}"));
    for k in 0..run.len() {
        text += &format!("\n{}", run.times[k]);
        let temperatures = &run.temperatures[k * warm..(k + 1) * warm];
        let numbers = run.state(k).iter().chain(run.torque(k)).chain(temperatures);
        numbers.for_each(|number| text += &format!(",{number}"));
    }
    text
}

/// A folder of recordings, or runs in memory.
#[pyclass(frozen, name = "Source", module = "reachtube._reachtube")]
pub(crate) struct NativeSource {
    pub source: SharedSource,
    folder: Option<DataSet>,
}

impl NativeSource {
    /// Makes a source of runs in memory.
    pub(crate) fn in_memory(runs: MemoryRuns) -> Self {
        Self { source: SharedSource(Arc::new(runs)), folder: None }
    }
}

/// A run with its name, suite, motion and place in the order of the suite.
type NamedRun<'py> =
    (PyRef<'py, NativeRun>, String, Option<String>, Option<String>, Option<u64>, Option<f64>);

/// The entry of a run in the index: name, suite, motion, kind, order and temperature.
type IndexRow = (String, Option<String>, Option<String>, Option<String>, u64, Option<f64>);

#[pymethods]
impl NativeSource {
    #[staticmethod]
    fn open(py: Python<'_>, folder: String) -> PyResult<Self> {
        let data = DataSet::open(folder).map_err(|error| Failure::from(error).raised(py))?;
        Ok(Self { source: SharedSource(Arc::new(data.clone())), folder: Some(data) })
    }

    #[staticmethod]
    fn of_runs(runs: Vec<NamedRun<'_>>, simulated: bool) -> Self {
        let mut all = MemoryRuns::default();
        for (run, name, suite, motion, order, temperature) in &runs {
            let run = (*run.run).clone();
            let entry = all.push(name, suite.as_deref(), motion.as_deref(), run);
            entry.order = order.unwrap_or(entry.order);
            entry.temperature = *temperature;
            entry.simulated = simulated;
        }
        Self::in_memory(all)
    }

    /// Returns the entry of each run in the index.
    fn index(&self) -> Vec<IndexRow> {
        let row = |run: &RunEntry| {
            let RunEntry { file, suite, motion, kind, order, temperature, .. } = run.clone();
            (file, suite, motion, kind, order, temperature)
        };
        self.source.runs().iter().map(row).collect()
    }

    /// Returns whether a run is marked as simulated.
    fn simulated(&self) -> bool {
        self.source.runs().iter().any(|run| run.simulated)
    }

    /// Reads a run.
    fn read(&self, py: Python<'_>, index: usize) -> PyResult<NativeRun> {
        let source = self.source.clone();
        watched_alone(py, None, move |_| {
            let options =
                ReadOptions { gap_limit: GapLimit::Seconds(f64::INFINITY), ..Default::default() };
            let run = source.read(index, &options);
            run.map_err(|defects| reachtube::recordings::Error::Defects(defects).into())
        })
        .map(|run| NativeRun { run: Arc::new(run) })
    }

    /// Reads all runs of a folder and summarises them as JSON; `None` for runs in memory.
    #[pyo3(signature = (max_gap=None))]
    fn inspection(&self, py: Python<'_>, max_gap: Option<f64>) -> PyResult<Option<String>> {
        let Some(data) = self.folder.clone() else { return Ok(None) };
        watched(py, None, move |_| {
            let found = inspect(&data, max_gap.into());
            Ok(Some(serde_json::to_string(&found).expect("an inspection has string keys")))
        })
    }
}
