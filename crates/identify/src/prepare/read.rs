use super::{PrepareSettings, RawLog};
use crate::error::{Error, Result};
use reachtube_recordings::{GapLimit, Run, check_limits};
use reachtube_robot::Robot;
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};

/// Recordings named in settings: a CSV file or a folder, whole or a stretch of it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum LogEntry {
    /// A CSV file, or a folder: all CSV files in it but runs.csv, by name.
    Path(PathBuf),
    /// A stretch of each of these files.
    Stretch {
        /// The file or folder.
        path: PathBuf,
        /// First time that is used \[s\].
        #[serde(default)]
        from: f64,
        /// Last time that is used \[s\].
        #[serde(default)]
        until: Option<f64>,
    },
}

impl LogEntry {
    fn parts(&self) -> (&Path, f64, Option<f64>) {
        match self {
            Self::Path(path) => (path, 0.0, None),
            Self::Stretch { path, from, until } => (path, *from, *until),
        }
    }
}

impl From<PathBuf> for LogEntry {
    fn from(path: PathBuf) -> Self {
        Self::Path(path)
    }
}

/// Reads recordings of a robot; paths are taken from `folder` on. Columns are brought into the
/// order of the robot's joints.
///
/// # Errors
///
/// Defects of the files (units that cannot be the robot's among them), [`Error::File`] for a path
/// that is not there, [`Error::Setting`] for joints that the robot does not have.
pub fn read(
    entries: &[LogEntry],
    folder: &Path,
    robot: &Robot,
    settings: &PrepareSettings,
) -> Result<Vec<RawLog>> {
    let order = order(robot, &settings.joints)?;
    let mut logs = Vec::new();
    for entry in entries {
        let (path, from, until) = entry.parts();
        for file in files(&folder.join(path))? {
            let limit = settings.max_gap.map_or(GapLimit::Usual, GapLimit::Seconds);
            let run = Run::read(&file, Some(robot.joint_count()), limit, until)
                .map_err(reachtube_recordings::Error::Defects)?;
            let name = file.file_stem().unwrap_or_default().to_string_lossy().into_owned();
            let run = ordered(cut(run, from), &order);
            match check_limits(&file, &run, robot) {
                defects if defects.is_empty() => logs.push(RawLog { name, run }),
                defects => return Err(reachtube_recordings::Error::Defects(defects).into()),
            }
        }
    }
    Ok(logs)
}

fn files(path: &Path) -> Result<Vec<PathBuf>> {
    let unreadable = |source| reachtube_files::Error::Read {
        path: path.to_path_buf(),
        source,
        remedy: "give a CSV file of one recording, or a folder of them",
    };
    if !path.metadata().map_err(unreadable)?.is_dir() {
        return Ok(vec![path.to_path_buf()]);
    }
    let entries = std::fs::read_dir(path).map_err(unreadable)?;
    let mut files: Vec<PathBuf> = entries
        .flatten()
        .map(|entry| entry.path())
        .filter(|path| {
            path.extension().is_some_and(|e| e == "csv")
                && path.file_name().is_some_and(|f| f != "runs.csv")
        })
        .collect();
    files.sort();
    if files.is_empty() {
        return Err(Error::Setting(format!(
            "{}: no CSV file in this folder; name the files themselves",
            path.display()
        )));
    }
    Ok(files)
}

/// The column of each of the robot's joints.
fn order(robot: &Robot, names: &[String]) -> Result<Vec<usize>> {
    let n = robot.joint_count();
    if names.is_empty() {
        return Ok((0..n).collect());
    }
    let own: Vec<&str> = robot.joints().iter().map(|joint| joint.name.as_str()).collect();
    let column = |name: &&str| names.iter().position(|other| other == name);
    let order: Option<Vec<usize>> = own.iter().map(column).collect();
    order.filter(|_| names.len() == n).ok_or_else(|| {
        Error::Setting(format!(
            "joints = {names:?} must name each of the robot's {n} joints once, in the order of the recordings' columns: {}",
            own.join(", ")
        ))
    })
}

fn ordered(run: Run, order: &[usize]) -> Run {
    let n = run.joints;
    let pick = |row: &[f64]| order.iter().map(|column| row[*column]).collect::<Vec<_>>();
    let states = (0..run.len()).flat_map(|k| [pick(run.q(k)), pick(run.qd(k))].concat()).collect();
    let torques = run.torques.chunks_exact(n).flat_map(pick).collect();
    Run { states, torques, ..run }
}

fn cut(mut run: Run, from: f64) -> Run {
    let (first, n) = (run.times.partition_point(|t| *t < from), run.joints);
    run.times.drain(..first);
    run.states.drain(..2 * n * first);
    run.torques.drain(..n * first);
    run
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_follow_the_names() {
        let robot = Robot::lwa4p();
        let names = ["joint2", "joint1", "joint3", "joint4", "joint5", "joint6"].map(String::from);
        assert_eq!(order(&robot, &names).unwrap(), [1, 0, 2, 3, 4, 5]);
        assert!(
            order(&robot, &names[..5])
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
            sha256: String::new(),
        };
        let turned = ordered(run, &[1, 0]);
        assert_eq!((turned.states, turned.torques), (vec![2.0, 1.0, 4.0, 3.0], vec![6.0, 5.0]));
    }

    #[test]
    fn a_stretch_is_cut_from_a_folder() {
        let folder = tempfile::tempdir().unwrap();
        let rows: String = (0..50)
            .map(|k| format!("{},0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,{k}\n", 0.1 * k as f64))
            .collect();
        let header = "t,q1,q2,q3,q4,q5,q6,qd1,qd2,qd3,qd4,qd5,qd6,tau1,tau2,tau3,tau4,tau5,tau6\n";
        std::fs::write(folder.path().join("a.csv"), format!("{header}{rows}")).unwrap();
        std::fs::write(folder.path().join("runs.csv"), "file,suite\n").unwrap();
        let entry = LogEntry::Stretch { path: ".".into(), from: 1.0, until: Some(2.0) };
        let robot = Robot::lwa4p();
        let logs = read(&[entry], folder.path(), &robot, &PrepareSettings::default()).unwrap();
        assert_eq!((logs.len(), logs[0].name.as_str(), logs[0].run.len()), (1, "a", 11));
        assert_eq!(logs[0].run.torque(0)[5], 10.0);
        let nowhere =
            read(&[LogEntry::Path("b".into())], folder.path(), &robot, &PrepareSettings::default());
        assert!(nowhere.unwrap_err().to_string().contains("folder of them"));
    }
}
