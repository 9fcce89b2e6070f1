//! Robot logs: MCAP and rosbag2 files.

use std::path::PathBuf;
use std::sync::Arc;

use pyo3::prelude::*;
use reachtube::RunSource;
use reachtube::recordings::{GapLimit, ReadOptions};
use reachtube_logs::{Cut, Cutting, Log, LogOptions, LogTime, convert, find_repeats};

use crate::failure::{Failure, Result};
use crate::recordings::NativeRun;
use crate::watched::watched_alone;

/// Options for cutting a log into runs.
#[derive(Debug)]
struct CuttingOptions {
    marker: Option<String>,
    repeats: bool,
    rest_speed: f64,
    max_gap: Option<f64>,
}

/// A run with its name, suite and motion.
type NamedRun = (NativeRun, String, Option<String>, Option<String>);

/// Reads logs and cuts them into runs; also returns notes, and what was lost from damaged logs.
#[pyfunction]
#[pyo3(signature = (paths, topics, joints, receipt_time, recover, cutting))]
pub(crate) fn read_log(
    py: Python<'_>,
    paths: Vec<PathBuf>,
    topics: Vec<String>,
    joints: Vec<String>,
    receipt_time: bool,
    recover: bool,
    cutting: (Option<String>, bool, f64, Option<f64>),
) -> PyResult<(Vec<NamedRun>, Vec<String>, Vec<String>)> {
    let (marker, repeats, rest_speed, max_gap) = cutting;
    let cutting = CuttingOptions { marker, repeats, rest_speed, max_gap };
    watched_alone(py, None, move |_| {
        let time = if receipt_time { LogTime::Receipt } else { LogTime::Header };
        let marker = cutting.marker.clone();
        let options = LogOptions { topics, joints, marker, time, recover };
        let read = paths.iter().map(|path| Log::read(path, &options));
        let logs = read.collect::<Result<Vec<Log>, _>>()?;
        let notes = logs.iter().flat_map(|log| log.notes().to_vec()).collect();
        let lost = logs.iter().flat_map(Log::losses).map(ToString::to_string).collect();
        Ok((runs(&logs, &cutting)?, notes, lost))
    })
}

fn runs(logs: &[Log], cutting: &CuttingOptions) -> Result<Vec<NamedRun>> {
    let mut cuts: Vec<Cut> = match cutting {
        CuttingOptions { marker: Some(_), .. } => Cutting::Marked.runs(logs)?,
        CuttingOptions { repeats: true, rest_speed, .. } => {
            Cutting::Motions(*rest_speed).runs(logs)?
        }
        _ => Cutting::Whole.runs(logs)?,
    };
    if cutting.repeats {
        find_repeats(logs, &mut cuts, cutting.marker.is_none());
    }
    let source = convert(logs, &cuts, cutting.max_gap.into())?.into_runs();
    let options =
        ReadOptions { gap_limit: GapLimit::Seconds(f64::INFINITY), ..ReadOptions::default() };
    let named = |(index, entry): (usize, &reachtube::recordings::RunEntry)| {
        let run = source.read(index, &options);
        let run =
            run.map_err(|defects| Failure::from(reachtube::recordings::Error::Defects(defects)))?;
        let run = NativeRun { run: Arc::new(run) };
        Ok((run, entry.file.clone(), entry.suite.clone(), entry.motion.clone()))
    };
    source.runs().iter().enumerate().map(named).collect()
}
