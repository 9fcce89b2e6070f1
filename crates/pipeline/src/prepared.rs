use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use reachtube_conform::Model;
use reachtube_identify::prepare::{LogEntry, PrepareSettings, read};
use reachtube_recordings::{MemoryRuns, Preparation};
use reachtube_robot::Robot;

use crate::error::Result;
use crate::robot::prepare_for;
use crate::windows::cut;

/// Reads logs and does to them what `preparation` says, as was done to the recordings of `model`.
///
/// # Errors
///
/// Logs that cannot be read or prepared, and [`Error::NoWindow`](crate::Error::NoWindow) if none is
/// as long as a window.
pub fn prepared(model: &Model, preparation: &Preparation, logs: &[PathBuf]) -> Result<MemoryRuns> {
    let Preparation { torque, gains, cut_off, window } = preparation;
    let robot = Robot::from_description(&model.robot)?;
    let settings = PrepareSettings { gains: gains.clone(), ..PrepareSettings::default() };
    let entries: Vec<LogEntry> = logs.iter().cloned().map(LogEntry::from).collect();
    let raw = read(&entries, Path::new(""), &robot, &settings)?;
    let logs = prepare_for(&raw, &robot, *torque, &settings, cut_off.unwrap_or(f64::INFINITY))?;
    cut(&logs, &BTreeMap::new(), *window, usize::MAX)
}
