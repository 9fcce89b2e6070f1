use std::ops::{Add, Div, Mul, Sub};
use std::path::{Path, PathBuf};

use reachtube_files::hex;
use reachtube_logs::{LogFiles, read_commands};
use reachtube_recordings::{
    Axis, ColumnSettings, GapLimit, LogSettings, Logged, LoggedOptions, Wanted, parse_logged,
    read_logged_runs,
};
use sha2::{Digest, Sha256};

use crate::basis::{delayed, rates};
use crate::error::{Error, Result};

/// Fewest samples of a recording, which has an acceleration.
pub(crate) const FEWEST_SAMPLES: usize = 3;

/// Samples of the commanded and the actual positions of n joints.
#[derive(Debug, Clone, PartialEq)]
pub struct TrackedRun {
    /// The file, or its first one.
    pub file: PathBuf,
    /// The names of the joints.
    pub joints: Vec<String>,
    /// The units of their positions: rad, or m.
    pub units: Vec<&'static str>,
    /// Times since the first sample, K, s, strictly increasing.
    pub times: Vec<f64>,
    /// Commanded positions, row-major K x n, rad.
    pub command: Vec<f64>,
    /// Actual positions, row-major K x n, rad.
    pub actual: Vec<f64>,
    /// SHA-256 of the files; of the rows, if a file has several recordings; or of the positions
    /// that a log has in messages.
    pub sha256: String,
}

/// Samples of the commanded positions of n joints.
#[derive(Debug, Clone, PartialEq)]
pub struct Plan {
    /// The file.
    pub file: PathBuf,
    /// The names of the joints.
    pub joints: Vec<String>,
    /// The units of their positions: rad, or m.
    pub units: Vec<&'static str>,
    /// Times since the first sample, K, s, strictly increasing.
    pub times: Vec<f64>,
    /// Commanded positions, row-major K x n, rad.
    pub command: Vec<f64>,
}

/// How logs are read.
#[derive(Debug, Clone, Copy)]
pub struct Reading<'a> {
    /// The robot's joints, if a robot is given; without one, the positions of a log are its joints.
    pub axes: Option<&'a [Axis]>,
    /// Columns whose names do not tell.
    pub columns: &'a ColumnSettings,
    /// Topics and times of MCAP and rosbag2 logs, and the names of the joints that are read if no
    /// robot is given.
    pub log: &'a LogSettings,
    /// Time after the first sample beyond which samples are not used, s.
    pub until: Option<f64>,
}

impl<'a> Reading<'a> {
    /// Reads the commanded and actual positions of all logs at some paths, files or folders, but
    /// not of copies. The notes say how they were read.
    ///
    /// # Errors
    ///
    /// Defects of files, paths without a log, and logs of different joints.
    pub fn read(&self, paths: &[PathBuf]) -> Result<(Vec<TrackedRun>, Vec<String>)> {
        let (mut recordings, mut notes) = (Vec::<TrackedRun>::new(), Vec::new());
        for path in paths {
            let logs = LogFiles::find(path)?;
            if logs.is_empty() {
                return Err(Error::NoLog { folder: path.clone() });
            }
            for log in logs {
                for (plan, logged) in self.logged(&log, Wanted::Commands)? {
                    for note in &logged.notes {
                        if !notes.contains(note) {
                            notes.push(note.clone());
                        }
                    }
                    let recording = TrackedRun::of(plan, logged);
                    match recordings.iter().find(|other| other.sha256 == recording.sha256) {
                        None => recordings.push(recording),
                        Some(other) => {
                            let [copy, of] = [&recording, other].map(|of| of.file.display());
                            notes.push(format!("{copy} is a copy of {of}; it is not used"));
                        }
                    }
                }
            }
        }
        check(&recordings)?;
        Ok((recordings, notes))
    }

    /// Reads the recordings of a log: their positions, and what was read besides.
    pub(crate) fn logged(&self, log: &LogFiles, wanted: Wanted) -> Result<Vec<(Plan, Logged)>> {
        let options = LoggedOptions {
            robot: self.axes,
            joints: &self.log.joints,
            columns: self.columns,
            gains: false,
            wanted,
            gap_limit: GapLimit::Seconds(f64::INFINITY),
            until: self.until,
        };
        let refused = reachtube_recordings::Error::Defects;
        let plan = |(file, logged): (PathBuf, Logged)| (self.plan(file, &logged), logged);
        let runs: Vec<(PathBuf, Logged)> = match log {
            LogFiles::Csv(files) => {
                let runs = read_logged_runs(files, &options).map_err(refused)?;
                let name = |run: Option<String>| match run {
                    Some(run) => files[0].with_file_name(format!(
                        "{}_{run}.{}",
                        files[0].file_stem().unwrap_or_default().display(),
                        files[0].extension().unwrap_or_default().display()
                    )),
                    None => files[0].clone(),
                };
                runs.into_iter().map(|(run, logged)| (name(run), logged)).collect()
            }
            LogFiles::Container(path) => {
                let axes = self.axes.unwrap_or_default().iter();
                let joints: Vec<String> = axes.map(|axis| axis.name.clone()).collect();
                let found = read_commands(path, self.log, &joints, wanted)?;
                // The text has numbers in place of names.
                let options = LoggedOptions { joints: &[], columns: &found.columns, ..options };
                let mut logged = parse_logged(path, found.text, &options).map_err(refused)?;
                logged.notes.splice(..0, found.notes);
                if let Some(understood) = &mut logged.understood {
                    understood.joints = found.joints;
                }
                vec![(path.clone(), logged)]
            }
        };
        Ok(runs.into_iter().map(plan).collect())
    }

    /// Returns the positions of a recording.
    fn plan(&self, file: PathBuf, logged: &Logged) -> Plan {
        let run = &logged.run;
        let of_columns = logged.understood.as_ref().map_or(&[][..], |of| &of.joints);
        let of_columns = of_columns.iter().map(|name| match name.parse::<usize>() {
            Ok(number) => format!("joint_{number}"),
            Err(_) => name.clone(),
        });
        Plan {
            file,
            joints: match self.axes {
                Some(axes) => axes.iter().map(|axis| axis.name.clone()).collect(),
                None => of_columns.collect(),
            },
            units: match self.axes {
                Some(axes) => axes.iter().map(|axis| axis.units[0]).collect(),
                None => vec!["rad"; run.joints],
            },
            times: run.times.clone(),
            command: (0..run.len()).flat_map(|k| run.q(k).to_vec()).collect(),
        }
    }
}

/// Refuses no recordings, recordings of different joints, and one that is too short.
pub(crate) fn check(recordings: &[TrackedRun]) -> Result<()> {
    let first = recordings.first().ok_or(Error::NoData)?;
    for recording in recordings {
        let (file, samples) = (recording.file.clone(), recording.times.len());
        if samples < FEWEST_SAMPLES {
            return Err(Error::Short { file, samples });
        }
        if recording.joints != first.joints {
            return Err(Error::Joints {
                file,
                joints: recording.joints.clone(),
                other: first.file.clone(),
                others: first.joints.clone(),
            });
        }
    }
    Ok(())
}

impl TrackedRun {
    /// Returns a recording of actual positions, in place of a plan's, and what was read besides.
    fn of(actual: Plan, logged: Logged) -> Self {
        let Plan { file, joints, units, times, command: actual } = actual;
        let command = logged.command[..actual.len()].to_vec();
        Self { file, joints, units, times, command, actual, sha256: logged.run.sha256 }
    }

    /// Returns a recording of numbers: times K in s, commanded and actual positions K x n.
    #[must_use]
    pub fn of_numbers(
        name: &str,
        (joints, units): (Vec<String>, Vec<&'static str>),
        [times, command, actual]: [Vec<f64>; 3],
    ) -> Self {
        let mut digest = Sha256::new();
        let numbers = times.iter().chain(&command).chain(&actual);
        numbers.for_each(|number| digest.update(number.to_le_bytes()));
        let sha256 = hex(&digest.finalize());
        Self { file: name.into(), joints, units, times, command, actual, sha256 }
    }

    /// Returns the number of joints n.
    #[must_use]
    pub fn joint_count(&self) -> usize {
        self.joints.len()
    }

    /// Returns ṙ and r̈ of the command of a joint at sample `k`, as numbers or enclosed.
    pub(crate) fn rates<T>(&self, k: usize, joint: usize) -> [T; 2]
    where
        T: Copy + From<f64> + Add<Output = T> + Sub<Output = T> + Mul<Output = T> + Div<Output = T>,
    {
        let n = self.joint_count();
        rates(k, &self.times, |k| T::from(self.command[k * n + joint]))
    }

    /// Returns the recording with the command of a delay before, s.
    pub(crate) fn delayed(&self, delay: f64) -> Self {
        Self { command: delayed(&self.times, &self.command, delay), ..self.clone() }
    }

    /// Returns the highest speed of the command over the joints at sample `k`, rad/s.
    pub(crate) fn speed(&self, k: usize) -> f64 {
        (0..self.joint_count())
            .map(|joint| self.rates::<f64>(k, joint)[0].abs())
            .fold(0.0, f64::max)
    }

    /// Returns the actual position of a joint minus the commanded one, rad.
    pub(crate) fn error(&self, k: usize, joint: usize) -> f64 {
        let at = k * self.joint_count() + joint;
        self.actual[at] - self.command[at]
    }

    /// Returns the median of the times between two samples, s.
    pub(crate) fn usual_step(&self) -> f64 {
        let mut steps: Vec<f64> = self.times.windows(2).map(|pair| pair[1] - pair[0]).collect();
        let middle = steps.len() / 2;
        *steps.select_nth_unstable_by(middle, f64::total_cmp).1
    }

    /// Returns the name of the file.
    #[must_use]
    pub fn name(&self) -> String {
        Path::new(&self.file).file_stem().unwrap_or_default().to_string_lossy().into_owned()
    }
}
