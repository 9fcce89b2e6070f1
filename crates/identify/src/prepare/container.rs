//! Recordings in logs of MCAP and rosbag2.

use crate::error::Result;
use crate::prepare::raw_log::RawLog;
use crate::prepare::settings::PrepareSettings;
use reachtube_diagnose::axes;
use reachtube_logs::{Cut, Cutting, Log, LogOptions, convert};
use reachtube_recordings::{
    Error as RecordingsError, GapLimit, ReadOptions, Run, RunSource, check_limits,
};
use reachtube_robot::Robot;
use std::path::Path;

/// Returns a whole log as a recording, up to a time since its first sample \[s\], with notes.
pub(crate) fn whole(
    path: &Path,
    until: Option<f64>,
    robot: &Robot,
    settings: &PrepareSettings,
) -> Result<(Run, Vec<String>)> {
    let logs = [log(path, robot, settings, None)?];
    let cuts = Cutting::Whole.runs(&logs)?;
    let mut runs = runs(&logs, &cuts, until, settings)?;
    Ok((runs.remove(0), logs[0].notes().to_vec()))
}

/// Returns the runs that the topic of markers marks in a log, each as a recording. The value of a
/// marker names the motion.
pub(crate) fn marked(
    path: &Path,
    robot: &Robot,
    settings: &PrepareSettings,
) -> Result<Vec<RawLog>> {
    let logs = [log(path, robot, settings, settings.log.marker.clone())?];
    let cuts = Cutting::Marked.runs(&logs)?;
    let mut notes = logs[0].notes().to_vec();
    let runs = runs(&logs, &cuts, None, settings)?;
    let mut found = Vec::new();
    for (number, (run, cut)) in runs.into_iter().zip(&cuts).enumerate() {
        let defects = check_limits(path, &run, &axes(robot));
        if !defects.is_empty() {
            return Err(RecordingsError::Defects(defects).into());
        }
        let name = format!("{}_{:02}", name_of(path), number + 1);
        let (motion, notes) = (cut.suite.clone(), std::mem::take(&mut notes));
        found.push(RawLog { motion, notes, ..RawLog::new(name, path, run) });
    }
    Ok(found)
}

/// Returns the name of a log without its endings.
pub(crate) fn name_of(path: &Path) -> String {
    let name = path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned();
    let plain = [".zstd", ".zst"].iter().find_map(|ending| name.strip_suffix(ending));
    let plain = plain.unwrap_or(&name);
    let stem = [".mcap", ".db3"].iter().find_map(|ending| plain.strip_suffix(ending));
    stem.unwrap_or(plain).into()
}

fn log(
    path: &Path,
    robot: &Robot,
    settings: &PrepareSettings,
    marker: Option<String>,
) -> Result<Log> {
    let joints: Vec<String> = robot.joints().iter().map(|joint| joint.name.clone()).collect();
    let options = LogOptions { marker, ..LogOptions::new(&settings.log, &joints)? };
    Ok(Log::read(path, &options)?)
}

fn runs(
    logs: &[Log],
    cuts: &[Cut],
    until: Option<f64>,
    settings: &PrepareSettings,
) -> Result<Vec<Run>> {
    let runs = convert(logs, cuts, settings.gap_limit())?.into_runs();
    // Gaps were judged already.
    let gap_limit = GapLimit::Seconds(f64::INFINITY);
    let options = ReadOptions { gap_limit, until, ..ReadOptions::default() };
    let read = |index: usize| runs.read(index, &options);
    let read = (0..cuts.len()).map(read).collect::<std::result::Result<Vec<Run>, _>>();
    Ok(read.map_err(RecordingsError::Defects)?)
}

#[cfg(test)]
mod tests {
    use super::name_of;

    #[test]
    fn a_log_has_its_name_without_endings() {
        let names = ["a/day.1.mcap", "bag_0.db3.zstd", "bag"].map(|path| name_of(path.as_ref()));
        assert_eq!(names, ["day.1", "bag_0", "bag"]);
    }
}
