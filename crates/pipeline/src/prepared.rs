use reachtube_arm::ArmModel;
use std::path::{Path, PathBuf};

use reachtube_conform::{CheckJob, Model, Setup};
use reachtube_identify::prepare::{PrepareSettings, RawLog, check_window};
use reachtube_recordings::{DataSet, MemoryRuns, Preparation, any_simulated};
use reachtube_robot::Robot;

use crate::error::{Error, Result};
use crate::planned::Planned;
use crate::robot::prepare_for;
use crate::sorted::{WARMTH, origins_of, read_logs, unknown_warmth};
use crate::windows::{Prepared, windows_of};

/// Makes the job that compares a model with the recordings at a path: a folder with runs.csv, one
/// CSV file (a planned motion), or for a model that `model` made, logs, which are prepared as its
/// own were; `max_gap` is the longest time between two of their samples, s, if it is another.
///
/// # Errors
///
/// Recordings that cannot be opened, or logs as for [`prepared`].
pub fn check_job(
    model: Model,
    setup: Setup,
    data: &Path,
    max_gap: Option<f64>,
) -> Result<CheckJob> {
    let windows = model
        .preparation
        .as_ref()
        .map(|known| prepared(&model, known, &[data.to_path_buf()], max_gap))
        .transpose()?;
    Ok(match windows {
        Some(windows) => CheckJob::new(model, setup, windows),
        None if data.is_file() => CheckJob::new(model, setup, Planned::of(data)),
        None => {
            let data = DataSet::open(data).map_err(reachtube_conform::Error::from)?;
            CheckJob::new(model, setup, data)
        }
    })
}

/// Reads logs and does to them what `preparation` says, as was done to the recordings of `model`;
/// `max_gap` is the longest time between two of their samples, s, if it is another.
///
/// # Errors
///
/// Logs that cannot be read or prepared, or that lack the warmth of the robot although the model
/// needs it, and [`Error::NoWindow`](crate::Error::NoWindow) if none is as long as a window.
pub fn prepared(
    model: &Model,
    preparation: &Preparation,
    paths: &[PathBuf],
    max_gap: Option<f64>,
) -> Result<MemoryRuns> {
    let Preparation { torque, gains, cut_off, window, columns, log, .. } = preparation;
    let robot = Robot::from_description(&model.robot())?;
    let settings = PrepareSettings {
        gains: gains.clone(),
        torque: Some(*torque),
        max_gap: max_gap.or(preparation.max_gap),
        columns: columns.clone(),
        log: log.clone(),
        ..PrepareSettings::default()
    };
    let raw = read_logs(paths, &robot, &settings)?;
    window.map_or(Ok(()), |window| check_window(window, &raw))?;
    if let Some(warming) = model.arm().correction.as_ref().filter(|known| known.differs_by_run()) {
        let logs: Vec<&RawLog> = raw.iter().collect();
        if let Some(file) = unknown_warmth(&logs, warming.reference_temperatures.is_some()) {
            let value = format!("{}, for a model whose friction warms up", file.display());
            return Err(Error::Choice { key: "data", value, needed: WARMTH });
        }
    }
    let logs = prepare_for(&raw, &robot, *torque, &settings, cut_off.unwrap_or(f64::INFINITY))?;
    let mut origins = origins_of(&raw);
    // A copy without some samples, or a log that overlaps, is no other one than the model's.
    for log in &raw {
        if let (Some(own), Some(origin)) =
            (model.log_with_samples_of(&log.run), origins.get_mut(&log.name))
        {
            origin.sha256 = own.into();
        }
    }
    let (from_start, origins) = (window.is_none(), &origins);
    let longest = logs.iter().map(|log| log.len() as f64 * log.step).fold(0.0, f64::max);
    let simulated = any_simulated(raw.iter().map(|log| &*log.file));
    let prepared =
        Prepared { logs: &logs, origins, from_start, divides: false, simulated, shortest: 0.0 };
    let horizon = match (window, model.usefulness.as_ref()) {
        (Some(window), _) => *window,
        (None, Some(said)) => said.horizon.min(longest),
        (None, None) => longest,
    };
    Ok(prepared.cut(horizon, usize::MAX)?.named(windows_of(paths)))
}
