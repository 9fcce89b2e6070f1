use crate::error::{Error, Result};
use crate::prepare::container::{marked, name_of, whole};
use crate::prepare::entry::LogEntry;
use crate::prepare::raw_log::RawLog;
use crate::prepare::settings::PrepareSettings;
use crate::prepare::turns::{add_turns, extents, missing_turns};
use reachtube_diagnose::axes;
use reachtube_logs::LogFiles;
use reachtube_recordings::{Defect, LoggedOptions, Run, Wanted, check_limits, read_logged};
use reachtube_robot::Robot;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Reads recordings of a robot and puts their columns into the order of the robot's joints.
///
/// Logs in MCAP and rosbag2 are read by the names of the joints; each is one recording, or one for
/// each run that a topic marks. A CSV file with the header `t,q1..qn,qd1..qdn,tau1..taun` is read
/// as it is. In others, columns and units are recognised ([`read_logged`]), and [`RawLog::notes`]
/// says how.
///
/// Relative paths start at `folder`.
///
/// # Errors
///
/// - [`Error::Recordings`] lists defects of the files, such as units that do not fit the robot or
///   times that are not in seconds.
/// - [`Error::File`] reports a path that cannot be read, [`Error::NoCsvFile`] an empty folder.
/// - [`Error::Log`] reports a log in MCAP or rosbag2 that cannot be read.
/// - [`Error::JointNames`] reports names that are not the robot's joints.
/// - [`Error::GainCount`] and [`Error::Gain`] report gains that are not one for each joint.
pub fn read(
    entries: &[LogEntry],
    folder: &Path,
    robot: &Robot,
    settings: &PrepareSettings,
) -> Result<Vec<RawLog>> {
    settings.gain_of_each_joint(robot.joint_count())?;
    let sources = sources(entries, folder, robot, settings)?;
    let read = sources.iter().map(|source| source.read(robot, settings));
    let mut logs = read.collect::<Result<Vec<RawLog>>>()?;
    let names: Vec<String> = logs.iter().map(|log| log.file.display().to_string()).collect();
    let found: Vec<_> = logs.iter().map(|log| extents(&log.run)).collect();
    let (turns, notes) = missing_turns(robot, &names, &found);
    logs.iter_mut().zip(turns).for_each(|(log, turns)| add_turns(&mut log.run, &turns));
    if let Some(first) = logs.first_mut() {
        first.moved.extend(notes);
    }
    Ok(logs)
}

/// A recording to read.
#[derive(Debug, Clone)]
pub(crate) struct Source {
    content: Content,
    /// Times between which samples are used \[s\].
    from: f64,
    until: Option<f64>,
    order: Option<u64>,
    /// Whether `tau` is the input u.
    compensated: bool,
    /// Turns to add to the positions of each joint; empty for none.
    pub turns: Vec<f64>,
}

/// Where a recording is.
#[derive(Debug, Clone)]
enum Content {
    /// CSV files: more than one if each quantity has a file.
    Csv(Vec<PathBuf>),
    /// A log in MCAP or rosbag2.
    Container(PathBuf),
    /// A recording that was read.
    Memory(Arc<RawLog>),
}

/// Returns the recordings of a list. They are not read, except where a topic marks the runs of a
/// log.
pub(crate) fn sources(
    entries: &[LogEntry],
    folder: &Path,
    robot: &Robot,
    settings: &PrepareSettings,
) -> Result<Vec<Source>> {
    let mut found = Vec::new();
    for entry in entries {
        let mut contents = Vec::new();
        let (path, from, until) = entry.parts();
        let path = folder.join(path);
        let is_marked = settings.log.marker.is_some() && matches!(entry, LogEntry::Path(_));
        if let LogEntry::Recording(log) = entry {
            contents.push(Content::Memory(Arc::clone(log)));
        } else {
            for files in LogFiles::find(&path)? {
                match files {
                    LogFiles::Csv(files) => contents.push(Content::Csv(files)),
                    LogFiles::Container(path) if is_marked => {
                        let logs = marked(&path, robot, settings)?.into_iter().map(Arc::new);
                        contents.extend(logs.map(Content::Memory));
                    }
                    LogFiles::Container(path) => contents.push(Content::Container(path)),
                }
            }
        }
        if contents.is_empty() {
            return Err(Error::NoCsvFile { folder: path });
        }
        for (index, content) in (0..).zip(contents) {
            let order = entry.order().map(|first| first + index);
            let compensated = entry.is_compensated();
            found.push(Source { content, from, until, order, compensated, turns: vec![] });
        }
    }
    Ok(found)
}

impl Source {
    /// Reads the recording, with its columns in the order of the robot's joints.
    pub(crate) fn read(&self, robot: &Robot, settings: &PrepareSettings) -> Result<RawLog> {
        let (file, run, notes) = match &self.content {
            Content::Memory(log) => {
                let mut log = RawLog::clone(log);
                log.run = log.run.with_digest();
                add_turns(&mut log.run, &self.turns);
                return Ok(log);
            }
            Content::Csv(files) => {
                let (run, notes) = self.read_csv_files(files, robot, settings)?;
                (files[0].clone(), run, notes)
            }
            Content::Container(path) => {
                let (run, notes) = whole(path, self.until, robot, settings)?;
                (path.clone(), run, notes)
            }
        };
        let mut run = starting_at(run.with_digest(), self.from);
        check(&file, &run, robot)?;
        add_turns(&mut run, &self.turns);
        let run = if self.compensated { with_compensation(run, robot) } else { run };
        let (name, order) = (self.name(), self.order);
        Ok(RawLog { order, notes, ..RawLog::new(name, file, run) })
    }

    /// Returns the name of the file, or of the folder of the files.
    fn name(&self) -> String {
        match &self.content {
            Content::Csv(files) => {
                let file = &files[0];
                let folder = file.parent().and_then(Path::file_name).filter(|_| files.len() > 1);
                let name = folder.or_else(|| file.file_stem()).unwrap_or_default();
                name.to_string_lossy().into_owned()
            }
            Content::Container(path) => name_of(path),
            Content::Memory(log) => log.name.clone(),
        }
    }

    fn read_csv_files(
        &self,
        files: &[PathBuf],
        robot: &Robot,
        settings: &PrepareSettings,
    ) -> Result<(Run, Vec<String>)> {
        check_names(robot, &settings.joints)?;
        let options = LoggedOptions {
            robot: Some(&axes(robot)),
            joints: &settings.joints,
            columns: &settings.columns,
            gains: !settings.gains.is_empty(),
            wanted: Wanted::Torques,
            gap_limit: settings.gap_limit(),
            until: self.until,
        };
        let logged = read_logged(files, &options).map_err(refused)?;
        Ok((logged.run, logged.notes))
    }
}

fn check(file: &Path, run: &Run, robot: &Robot) -> Result<()> {
    match check_limits(file, run, &axes(robot)) {
        defects if defects.is_empty() => Ok(()),
        defects => Err(refused(defects)),
    }
}

fn refused(defects: Vec<Defect>) -> Error {
    reachtube_recordings::Error::Defects(defects).into()
}

/// Returns a run with the motor torque in place of the input u.
fn with_compensation(mut run: Run, robot: &Robot) -> Run {
    let motor = |k: usize| robot.motor_torque_from_input(run.q(k), run.qd(k), run.torque(k));
    run.torques = (0..run.len()).flat_map(|k| motor(k).data.as_vec().clone()).collect();
    run
}

/// Checks that each name is a joint's and each joint has one, if any are given.
fn check_names(robot: &Robot, names: &[String]) -> Result<()> {
    let joints: Vec<String> = robot.joints().iter().map(|joint| joint.name.clone()).collect();
    let all = names.len() == joints.len() && joints.iter().all(|joint| names.contains(joint));
    match names.is_empty() || all {
        true => Ok(()),
        false => Err(Error::JointNames { given: names.to_vec(), joints }),
    }
}

fn starting_at(mut run: Run, from: f64) -> Run {
    let (first, n) = (run.times.partition_point(|t| *t < from), run.joints);
    run.times.drain(..first);
    run.states.drain(..2 * n * first);
    run.torques.drain(..n * first);
    run.temperatures.drain(..run.temperatures.len().min(n * first));
    run
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_follow_the_names() {
        let robot = Robot::lwa4p();
        let joints = ["joint2", "joint1", "joint3", "joint4", "joint5", "joint6"].map(String::from);
        let folder = tempfile::tempdir().unwrap();
        let names = ["q", "qd", "tau", "temp"].map(|n| (1..=6).map(move |i| format!(",{n}{i}")));
        let header: String = names.into_iter().flatten().collect();
        let row = ",0.1,0.2,0.3,0.4,0.5,0.6,1,2,3,4,5,6,7,8,9,10,11,12,21,22,23,24,25,26";
        let path = folder.path().join("a.csv");
        std::fs::write(&path, format!("t{header}\n0{row}\n0.1{row}\n")).unwrap();
        let read = |joints: &[String]| {
            let settings = PrepareSettings { joints: joints.into(), ..PrepareSettings::default() };
            let entry = LogEntry::Path("a.csv".into());
            read(&[entry], folder.path(), &robot, &settings)
        };
        let error = read(&joints[..5]).unwrap_err().to_string();
        assert!(error.contains("each of the robot's 6 joints"), "{error}");
        let run = read(&joints).unwrap().remove(0).run;
        assert_eq!(run.q(1), [0.2, 0.1, 0.3, 0.4, 0.5, 0.6]);
        assert_eq!(run.qd(1), [2.0, 1.0, 3.0, 4.0, 5.0, 6.0]);
        assert_eq!(run.torque(1), [8.0, 7.0, 9.0, 10.0, 11.0, 12.0]);
        assert_eq!(run.temperature(1), [22.0, 21.0, 23.0, 24.0, 25.0, 26.0]);
    }

    #[test]
    fn an_interval_is_cut_from_the_files_of_a_folder() {
        let folder = tempfile::tempdir().unwrap();
        let rows: String = (0..50)
            .map(|k| format!("{},0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,{k}\n", 0.1 * k as f64))
            .collect();
        let header = "t,q1,q2,q3,q4,q5,q6,qd1,qd2,qd3,qd4,qd5,qd6,tau1,tau2,tau3,tau4,tau5,tau6\n";
        std::fs::write(folder.path().join("a.csv"), format!("{header}{rows}")).unwrap();
        std::fs::write(folder.path().join("runs.csv"), "file,suite\n").unwrap();
        let entry = LogEntry::Stretch {
            path: ".".into(),
            from: 1.0,
            until: Some(2.0),
            order: Some(7),
            compensated: false,
        };
        let robot = Robot::lwa4p();
        let logs = read(&[entry], folder.path(), &robot, &PrepareSettings::default()).unwrap();
        assert_eq!((logs.len(), logs[0].name.as_str(), logs[0].run.len()), (1, "a", 11));
        assert_eq!((logs[0].run.torque(0)[5], logs[0].order), (10.0, Some(7)));
        let nowhere =
            read(&[LogEntry::Path("b".into())], folder.path(), &robot, &PrepareSettings::default());
        assert!(nowhere.unwrap_err().to_string().contains("folder of logs"));
    }

    #[test]
    fn turns_within_a_recording_are_taken_out_and_stated_units_count() {
        let folder = tempfile::tempdir().unwrap();
        let names = ["q", "qd", "tau"].map(|n| (1..=6).map(move |i| format!(",{n}{i}")));
        let header: String = names.into_iter().flatten().collect();
        let read = |turn: f64, scale: f64, columns: &str| {
            let row = |k: usize| {
                let t = 0.01 * k as f64;
                let turns = if k < 150 { 0.0 } else { turn };
                let first = format!(",{}", scale * (t.sin() + turns));
                let others = format!(",{}", scale * t.sin()).repeat(5);
                let velocities = format!(",{}", scale * t.cos()).repeat(6);
                format!("{t}{first}{others}{velocities}{}\n", ",2".repeat(6))
            };
            let rows: String = (0..300).map(row).collect();
            let path = folder.path().join("a.csv");
            std::fs::write(&path, format!("t{header}\n{rows}")).unwrap();
            let columns = columns.parse().unwrap();
            let settings = PrepareSettings { columns, ..PrepareSettings::default() };
            read(&[path.into()], folder.path(), &Robot::lwa4p(), &settings).unwrap().remove(0)
        };
        let smooth = read(0.0, 1.0, "");
        for (turn, scale, columns, note) in [
            (std::f64::consts::TAU, 1.0, "", "joint1 jumps by whole turns at 1.500 s"),
            (0.0, 1f64.to_degrees(), "angle=deg", "in degrees"),
        ] {
            let log = read(turn, scale, columns);
            assert!(log.notes.concat().contains(note), "{:?}", log.notes);
            let mut pairs = smooth.run.states.iter().zip(&log.run.states);
            assert!(pairs.all(|(a, b)| (a - b).abs() < 1e-12), "{note}");
        }
    }

    #[test]
    fn logs_are_read_with_the_settings_and_counted_turns_are_brought_together() {
        let folder = tempfile::tempdir().unwrap();
        let header = |name: &str| (0..6).map(|i| format!(",{name}_{i}")).collect::<String>();
        let names = [header("actual_q"), header("actual_qd"), header("actual_current")].concat();
        for (file, turn) in [("a", 0.0), ("b", 360.0), ("c", 0.0)] {
            let row = |k: usize| {
                let t = 0.01 * k as f64;
                let [q, qd] = [30.0 * t.sin(), 30.0 * t.cos()];
                let rest = [vec![q; 5], vec![qd; 6], vec![2.0; 6]].concat();
                let cells = rest.iter().map(|cell| format!(",{cell}")).collect::<String>();
                format!("{},{}{cells}\n", 10 * k, q + turn)
            };
            let rows: String = (0..300).map(row).collect();
            let path = folder.path().join(format!("{file}.csv"));
            std::fs::write(path, format!("timestamp{names}\n\n{rows}")).unwrap();
        }
        let robot = Robot::lwa4p();
        let entries = [LogEntry::Path(folder.path().into())];
        let none = PrepareSettings::default();
        let refused = read(&entries, folder.path(), &robot, &none).unwrap_err().to_string();
        assert!(refused.contains("motor currents: actual_current_0"), "{refused}");
        let gains = |count| PrepareSettings { gains: vec![3.0; count], ..none.clone() };
        assert!(read(&entries, folder.path(), &robot, &gains(5)).is_err());
        let logs = read(&entries, folder.path(), &robot, &gains(6)).unwrap();
        let said = |log: &RawLog| [log.notes.clone(), log.moved.clone()].concat();
        let said = logs.iter().flat_map(said).collect::<Vec<_>>().join("\n");
        assert!(said.contains("b.csv: joint1 is a turn away from other recordings"), "{said}");
        assert!(said.contains("the times are in ms") && said.contains("in degrees"), "{said}");
        for log in &logs {
            assert!((log.run.times[299] - 2.99).abs() < 1e-9);
            assert!((log.run.q(100)[0] - (30.0 * 1f64.sin()).to_radians()).abs() < 1e-9);
            assert_eq!(log.run.torque(5), [2.0; 6]);
        }
    }
}
