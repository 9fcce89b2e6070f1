use crate::error::{Error, Result};
use crate::prepare::entry::{LogEntry, csv_files};
use crate::prepare::raw_log::RawLog;
use crate::prepare::settings::PrepareSettings;
use crate::prepare::time_unit::check_time_unit;
use reachtube_recordings::{GapLimit, ReadOptions, Run, check_limits, read_csv};
use reachtube_robot::Robot;
use std::path::{Path, PathBuf};

/// Reads recordings of a robot and puts their columns into the order of the robot's joints.
///
/// Relative paths start at `folder`.
///
/// # Errors
///
/// - [`Error::Recordings`] lists defects of the files, such as units that do not fit the robot.
/// - [`Error::File`] reports a path that cannot be read, [`Error::NoCsvFile`] an empty folder.
/// - [`Error::JointNames`] reports names that are not the robot's joints.
/// - [`Error::TimeUnit`] reports times that are not in seconds.
pub fn read(
    entries: &[LogEntry],
    folder: &Path,
    robot: &Robot,
    settings: &PrepareSettings,
) -> Result<Vec<RawLog>> {
    let sources = sources(entries, folder)?;
    sources.iter().map(|source| source.read(robot, settings)).collect()
}

/// A recording to read.
#[derive(Debug, Clone)]
pub(crate) struct Source {
    file: PathBuf,
    /// Times between which samples are used \[s\].
    from: f64,
    until: Option<f64>,
    order: Option<u64>,
    /// Whether `tau` is the input u.
    compensated: bool,
}

/// Returns the recordings of a list, without reading them.
pub(crate) fn sources(entries: &[LogEntry], folder: &Path) -> Result<Vec<Source>> {
    let mut found = Vec::new();
    for entry in entries {
        let (path, from, until) = entry.parts();
        for (index, file) in (0..).zip(csv_files(&folder.join(path))?) {
            let order = entry.order().map(|first| first + index);
            let compensated = entry.is_compensated();
            found.push(Source { file, from, until, order, compensated });
        }
    }
    Ok(found)
}

impl Source {
    /// Reads the recording, with its columns in the order of the robot's joints.
    pub(crate) fn read(&self, robot: &Robot, settings: &PrepareSettings) -> Result<RawLog> {
        let order = column_order(robot, &settings.joints)?;
        let gap_limit = settings.max_gap.map_or(GapLimit::Usual, GapLimit::Seconds);
        let options =
            ReadOptions { joints: Some(robot.joint_count()), gap_limit, until: self.until };
        let file = self.file.clone();
        let run = read_csv(&file, &options).map_err(reachtube_recordings::Error::Defects)?;
        let name = file.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let run = reordered(starting_at(run, self.from), &order);
        match check_limits(&file, &run, robot) {
            defects if defects.is_empty() => {
                check_time_unit(&file, &run)?;
                let run = if self.compensated { with_compensation(run, robot) } else { run };
                Ok(RawLog { name, file, order: self.order, run })
            }
            defects => Err(reachtube_recordings::Error::Defects(defects).into()),
        }
    }
}

/// Returns a run with the motor torque in place of the input u.
fn with_compensation(mut run: Run, robot: &Robot) -> Run {
    let motor = |k: usize| robot.motor_torque_from_input(run.q(k), run.qd(k), run.torque(k));
    run.torques = (0..run.len()).flat_map(|k| motor(k).data.as_vec().clone()).collect();
    run
}

/// Returns the index of the column of each of the robot's joints.
fn column_order(robot: &Robot, names: &[String]) -> Result<Vec<usize>> {
    let n = robot.joint_count();
    if names.is_empty() {
        return Ok((0..n).collect());
    }
    let joints = robot.joints().iter().map(|joint| joint.name.as_str());
    let column = |name: &str| names.iter().position(|other| other == name);
    let order: Option<Vec<usize>> = joints.clone().map(column).collect();
    order.filter(|_| names.len() == n).ok_or_else(|| Error::JointNames {
        given: names.to_vec(),
        joints: joints.map(String::from).collect(),
    })
}

fn reordered(run: Run, order: &[usize]) -> Run {
    let n = run.joints;
    let pick = |row: &[f64]| order.iter().map(|column| row[*column]).collect::<Vec<_>>();
    let states = (0..run.len()).flat_map(|k| [pick(run.q(k)), pick(run.qd(k))].concat()).collect();
    let torques = run.torques.chunks_exact(n).flat_map(pick).collect();
    let temperatures = run.temperatures.chunks_exact(n).flat_map(pick).collect();
    Run { states, torques, temperatures, ..run }
}

/// Removes the samples before `from` \[s\].
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
        let names = ["joint2", "joint1", "joint3", "joint4", "joint5", "joint6"].map(String::from);
        assert_eq!(column_order(&robot, &names).unwrap(), [1, 0, 2, 3, 4, 5]);
        assert!(
            column_order(&robot, &names[..5])
                .unwrap_err()
                .to_string()
                .contains("each of the robot's 6 joints")
        );
        let run = Run {
            joints: 2,
            start: 0.0,
            times: vec![0.0],
            states: vec![1.0, 2.0, 3.0, 4.0],
            torques: vec![5.0, 6.0],
            temperatures: vec![7.0, 8.0],
            sha256: String::new(),
        };
        let swapped = reordered(run, &[1, 0]);
        assert_eq!(swapped.temperatures, [8.0, 7.0]);
        assert_eq!((swapped.states, swapped.torques), (vec![2.0, 1.0, 4.0, 3.0], vec![6.0, 5.0]));
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
        assert!(nowhere.unwrap_err().to_string().contains("folder of them"));
    }
}
