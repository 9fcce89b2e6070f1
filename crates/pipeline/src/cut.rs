use std::collections::{BTreeMap, BTreeSet};
use std::path::PathBuf;

use reachtube_identify::prepare::{
    PrepareSettings, RawLog, check_window, cut_off, prepare, unfiltered,
};
use reachtube_recordings::{
    ColumnSettings, LogSettings, MemoryRuns, Preparation, RunSource, Torque, any_simulated,
    matching,
};
use reachtube_robot::Robot;

use crate::error::Result;
use crate::one_motion::{link_notes, links};
use crate::robot::are_differentiated;
use crate::sorted::{origins_of, read_logs, without_suite_note};
use crate::stretches::{Use, in_stretches};
use crate::windows::{Origin, Prepared, windows_of};

/// Logs that were cut into windows, and what was done to them.
#[derive(Debug, Clone)]
pub struct Cut {
    /// The windows, whose torques are the input of the robot's model.
    pub windows: MemoryRuns,
    /// The preparation of the logs. A model that carries it takes other logs in the same way.
    pub preparation: Preparation,
    /// Notes for the user about the logs and their preparation.
    pub notes: Vec<String>,
}

impl Cut {
    /// Reads logs and cuts them into windows of `horizon` \[s\]. Before that, torques of motors or
    /// links are filtered with a cut-off that is chosen from the logs, and the robot's gravity and
    /// dry friction are subtracted from them; compensated torques stay as they are. Logs of the
    /// motions `calibrate`, by name or pattern, choose no cut-off.
    ///
    /// # Errors
    ///
    /// A robot that is not physical; logs that cannot be read or prepared;
    /// [`Error::NoWindow`](crate::Error::NoWindow) if none is as long as a window.
    pub fn new(
        robot: &Robot,
        torque: Torque,
        horizon: f64,
        calibrate: &[String],
        paths: &[PathBuf],
    ) -> Result<Self> {
        robot.check_physical()?;
        let settings = PrepareSettings { torque: Some(torque), ..PrepareSettings::default() };
        let raw = read_logs(paths, robot, &settings)?;
        check_window(horizon, &raw)?;
        let mut notes: Vec<String> =
            raw.iter().flat_map(|log| log.moved.iter().chain(&log.notes).cloned()).collect();
        notes.extend(without_suite_note(&raw));
        let all: Vec<&RawLog> = raw.iter().collect();
        notes.extend(link_notes(&all, &links(&all)).into_iter().flatten());
        let whole = origins_of(&raw);
        let cut_off = match torque {
            Torque::Compensated => None,
            _ => {
                let what = Use { cut_off: f64::INFINITY, from_start: false };
                let (raw, origins, _) = in_stretches(&raw, &whole, what)?;
                Some(rounded(cut_off(&without(&raw, &origins, calibrate), &settings)?))
            }
        };
        let of = raw.len();
        let what = Use { cut_off: cut_off.unwrap_or(f64::INFINITY), from_start: false };
        let (raw, origins, left_out) = in_stretches(&raw, &whole, what)?;
        notes.extend(left_out);
        let logs: Vec<_> = match cut_off {
            Some(cut_off) => {
                let prepared = prepare(&raw, &settings, cut_off, Some(robot))?;
                notes.extend(prepared.changes);
                prepared.logs
            }
            None => raw.iter().map(|log| unfiltered(log, &[])).collect::<Result<_, _>>()?,
        };
        let simulated = any_simulated(raw.iter().map(|log| &*log.file));
        let prepared = Prepared {
            logs: &logs,
            origins: &origins,
            from_start: false,
            divides: false,
            simulated,
            shortest: 0.0,
        };
        let windows = prepared.cut(horizon, usize::MAX)?.named(windows_of(paths));
        let count = windows.runs().len();
        notes.push(format!("cut {of} recordings into {count} windows of {horizon} s"));
        let preparation = Preparation {
            torque,
            gains: Vec::new(),
            cut_off,
            window: Some(horizon),
            differentiated: are_differentiated(&logs),
            columns: ColumnSettings::default(),
            log: LogSettings::default(),
        };
        Ok(Self { windows, preparation, notes })
    }
}

/// Returns the logs of the motions that `calibrate` does not name. If it names every motion, which
/// a calibration refuses, all logs are returned.
fn without<'a>(
    raw: &'a [RawLog],
    origins: &BTreeMap<String, Origin>,
    calibrate: &[String],
) -> Vec<&'a RawLog> {
    let motions = || origins.values().map(|origin| origin.motion.as_str());
    let named: BTreeSet<&str> =
        calibrate.iter().flat_map(|name| matching(name, motions())).collect();
    let others: Vec<&RawLog> =
        raw.iter().filter(|log| !named.contains(&*origins[&log.name].motion)).collect();
    if others.is_empty() { raw.iter().collect() } else { others }
}

/// Rounds a cut-off to 0.1 Hz, so that it is short in files.
pub(crate) fn rounded(cut_off: f64) -> f64 {
    (10.0 * cut_off).round() / 10.0
}

#[cfg(test)]
mod tests {
    use std::fmt::Write;

    use reachtube_recordings::ReadOptions;

    use super::*;
    use crate::pendulum::pendulum;

    #[test]
    fn motions_that_calibrate_choose_no_cut_off() {
        let folder = tempfile::tempdir().unwrap();
        for (name, pace) in [("slow", 2.0), ("fast", 30.0)] {
            let mut log = String::from("t,q1,qd1,tau1\n");
            for k in 0..1001 {
                let t = 0.01 * f64::from(k);
                let (sin, cos) = (pace * t).sin_cos();
                let [q, qd, tau] = [0.1 * sin, 0.1 * pace * cos, -pace * sin];
                writeln!(log, "{t:.2},{q:.9},{qd:.9},{tau:.9}").unwrap();
            }
            std::fs::write(folder.path().join(format!("{name}.csv")), log).unwrap();
        }
        let cut_off = |calibrate: &[&str], path: &str| {
            let calibrate: Vec<String> = calibrate.iter().map(ToString::to_string).collect();
            let paths = [folder.path().join(path)];
            let cut = Cut::new(&pendulum(), Torque::Motor, 0.25, &calibrate, &paths).unwrap();
            cut.preparation.cut_off.unwrap()
        };
        let [all, slow] = [cut_off(&[], ""), cut_off(&[], "slow.csv")];
        assert_ne!(all, slow);
        assert_eq!(cut_off(&["fast"], ""), slow);
        assert_eq!(cut_off(&["*"], ""), all, "a conformance refuses it");
    }

    #[test]
    fn windows_without_a_second_sample_are_refused() {
        let folder = tempfile::tempdir().unwrap();
        let log = "t,q1,qd1,tau1\n0,0,1,0\n0.1,0.1,1,0\n0.2,0.2,1,0\n";
        std::fs::write(folder.path().join("a.csv"), log).unwrap();
        let paths = [folder.path().to_path_buf()];
        let cut = |horizon| Cut::new(&pendulum(), Torque::Compensated, horizon, &[], &paths);
        let refused = cut(0.001).unwrap_err().to_string();
        assert!(refused.contains("0.001 s is shorter than") && refused.contains("0.1 s"));
        assert_eq!(cut(0.1).unwrap().windows.runs().len(), 2);
    }

    #[test]
    fn windows_have_the_order_of_the_index_and_the_temperatures_of_the_log() {
        let folder = tempfile::tempdir().unwrap();
        let mut index = String::from("file,suite,order\n");
        for (order, temperature) in [(7, 31.5), (3, 24.0)] {
            let mut log = String::from("t,q1,qd1,tau1,temp1\n");
            for k in 0..101 {
                let t = 0.01 * f64::from(k);
                writeln!(log, "{t:.2},{:.9},{:.9},0.5,{temperature}", t.sin(), t.cos()).unwrap();
            }
            std::fs::write(folder.path().join(format!("run{order}.csv")), log).unwrap();
            writeln!(index, "run{order}.csv,A,{order}").unwrap();
        }
        std::fs::write(folder.path().join("runs.csv"), &index).unwrap();
        let robot = pendulum();
        let paths = [folder.path().to_path_buf()];
        let cut = || Cut::new(&robot, Torque::Compensated, 0.25, &[], &paths).unwrap();
        let noted = |cut: &Cut| cut.notes.iter().any(|n| n.contains("no suite in runs.csv"));
        let one = index.replace("run7.csv,A,7\n", "");
        std::fs::write(folder.path().join("runs.csv"), one).unwrap();
        assert!(noted(&cut()) && cut().notes.concat().contains("1 of the 2 recordings have no"));
        std::fs::write(folder.path().join("runs.csv"), index).unwrap();
        let cut = cut();
        assert!(!noted(&cut));
        let unknown = cut.windows.select(&["run7".into()]).unwrap_err().to_string();
        let windows = format!("windows of {}: ", paths[0].display());
        assert!(unknown.starts_with(&windows) && unknown.contains("\"run7*\""), "{unknown}");
        let windows = cut.windows.runs();
        assert_eq!(windows.len(), 8);
        for (index, window) in windows.iter().enumerate() {
            let is_first = window.file.contains("run3");
            assert_eq!(window.order, if is_first { 3 } else { 7 }, "{}", window.file);
            let run = cut.windows.read(index, &ReadOptions::default()).unwrap();
            let temperature = if is_first { 24.0 } else { 31.5 };
            assert_eq!(run.temperatures, vec![temperature; run.len()], "{}", window.file);
        }
    }
}
