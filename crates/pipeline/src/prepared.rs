use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use reachtube_arm::ArmModel;
use reachtube_conform::{CheckJob, Model, Setup};
use reachtube_identify::prepare::{
    PrepareSettings, PreparedLog, RawLog, VelocitySource, check_window,
};
use reachtube_recordings::{DataSet, MemoryRuns, Preparation, Torque, any_simulated};
use reachtube_robot::Robot;

use crate::error::{Error, Result};
use crate::planned::Planned;
use crate::robot::prepare_for;
use crate::sorted::{WARMTH, origins_of, read_logs, unknown_warmth};
use crate::stretches::{Use, in_stretches};
use crate::windows::{Origin, Prepared, windows_of};

/// Makes the job that compares a model with the recordings at a path: a folder with runs.csv, one
/// CSV file (a planned motion), or for a model that `model` made, logs, which are prepared as its
/// own were.
///
/// # Errors
///
/// Recordings that cannot be opened, or logs as for [`prepared`].
pub fn check_job(model: Model, setup: Setup, data: &Path) -> Result<CheckJob> {
    let windows = model
        .preparation
        .as_ref()
        .map(|known| prepared(&model, known, &[data.to_path_buf()]))
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

/// Reads logs and does to them what `preparation` says, as was done to the recordings of `model`.
/// The notes of the windows say what was left out.
///
/// # Errors
///
/// Logs that cannot be read or prepared, or that lack the warmth of the robot although the model
/// needs it, and [`Error::NoWindow`](crate::Error::NoWindow) if none is as long as a window.
pub fn prepared(model: &Model, preparation: &Preparation, paths: &[PathBuf]) -> Result<MemoryRuns> {
    let later = Later::read(model, preparation, paths)?;
    let Later { raw, origins, notes, from_start, .. } = &later;
    let window = &preparation.window;
    window.map_or(Ok(()), |window| check_window(window, raw))?;
    if let Some(warming) = model.arm().correction.as_ref().filter(|known| known.differs_by_run()) {
        let logs: Vec<&RawLog> = raw.iter().collect();
        if let Some(file) = unknown_warmth(&logs, warming.reference_temperatures.is_some()) {
            let value = format!("{}, for a model whose friction warms up", file.display());
            return Err(Error::Choice { key: "data", value, needed: WARMTH });
        }
    }
    let simulated = any_simulated(raw.iter().map(|log| &*log.file));
    let logs = later.logs()?;
    let longest = logs.iter().map(|log| log.len() as f64 * log.step).fold(0.0, f64::max);
    let (from_start, divides) = (*from_start, false);
    let prepared = Prepared { logs: &logs, origins, from_start, divides, simulated, shortest: 0.0 };
    let horizon = match (window, model.usefulness.as_ref()) {
        (Some(window), _) => *window,
        (None, Some(said)) => said.horizon.min(longest),
        (None, None) => longest,
    };
    Ok(prepared.cut(horizon, usize::MAX)?.named(windows_of(paths)).noted(notes.clone()))
}

/// Logs in stretches without gaps, which are prepared as the recordings of a model were.
pub(crate) struct Later {
    pub raw: Vec<RawLog>,
    pub robot: Robot,
    pub settings: PrepareSettings,
    origins: BTreeMap<String, Origin>,
    /// Notes about samples that are left out.
    notes: Vec<String>,
    /// Whether motions start where the recordings do.
    from_start: bool,
    torque: Torque,
    cut_off: f64,
}

impl Later {
    pub(crate) fn read(
        model: &Model,
        preparation: &Preparation,
        paths: &[PathBuf],
    ) -> Result<Self> {
        let Preparation { torque, gains, cut_off, columns, log, window, differentiated } =
            preparation;
        let robot = Robot::from_description(&model.robot())?;
        let settings = PrepareSettings {
            gains: gains.clone(),
            torque: Some(*torque),
            columns: columns.clone(),
            log: log.clone(),
            velocity: match differentiated {
                true => VelocitySource::Differentiated,
                false => VelocitySource::Quieter,
            },
            ..PrepareSettings::default()
        };
        let whole = read_logs(paths, &robot, &settings)?;
        let (from_start, torque) = (window.is_none(), *torque);
        let cut_off = cut_off.unwrap_or(f64::INFINITY);
        let mut origins = origins_of(&whole);
        // A copy without some samples, or a log that overlaps, is no other one than the model's.
        for log in &whole {
            if let (Some(own), Some(origin)) =
                (model.log_with_samples_of(&log.run), origins.get_mut(&log.name))
            {
                origin.sha256 = own.into();
            }
        }
        let (raw, origins, notes) = in_stretches(&whole, &origins, Use { cut_off, from_start })?;
        Ok(Self { raw, robot, settings, origins, notes, from_start, torque, cut_off })
    }

    /// Returns the logs with the inputs of the model's robot.
    pub(crate) fn logs(&self) -> Result<Vec<PreparedLog>> {
        prepare_for(&self.raw, &self.robot, self.torque, &self.settings, self.cut_off)
    }
}
