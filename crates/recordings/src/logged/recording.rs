//! One recording of a log: its files, read, joined and brought to the units of reachtube.

use std::path::{Path, PathBuf};

use reachtube_files::hex;
use reachtube_robot::JointKind;
use sha2::{Digest, Sha256};

use super::assignment::{Assignment, TorqueKind, assign};
use super::dialect::Dialect;
use super::joints::Column;
use super::numbers::{self, FileNumbers};
use super::options::LoggedOptions;
use super::recognise::{Numbers, Units, recognise};
use super::understood::Understood;
use super::unit::TimeUnit;
use crate::defect::{Defect, DefectKind};
use crate::run::Run;
use crate::wraps::unwrap;

/// A joint that leaves its first position by more than this moves, rad or m.
const MOVES: f64 = 0.05;

/// A recording of a log, and what was understood of it.
#[derive(Debug, Clone, PartialEq)]
pub struct Logged {
    /// The recording, with columns in the order of the robot's joints. Motor currents stand in
    /// place of its torques where gains were announced. Torques are 0 where a log has none, which
    /// only [`LoggedOptions::torque`] = `false` accepts.
    pub run: Run,
    /// What was understood.
    pub understood: Understood,
    /// Notes for the user, each with the name of the file.
    pub notes: Vec<String>,
}

/// Reads a recording from the files of a log: one with all quantities, or one for each quantity
/// with the same times.
///
/// # Errors
///
/// Every defect, with file, line, column and remedy.
///
/// # Panics
///
/// Panics without a file.
///
/// # Examples
///
/// ```
/// use reachtube_recordings::{ColumnSettings, GapLimit, LoggedOptions, read_logged};
///
/// let folder = tempfile::tempdir()?;
/// let path = folder.path().join("log.csv");
/// let rows = "0 0.10 1.0 2.0\n4 0.104 1.0 2.0\n8 0.108 1.0 2.0\n";
/// std::fs::write(&path, format!("time_ms actual_q_0 actual_qd_0 target_moment_0\n{rows}"))?;
///
/// let columns = ColumnSettings::default();
/// let options = LoggedOptions {
///     robot: None,
///     joints: &[],
///     columns: &columns,
///     gains: false,
///     torque: true,
///     gap_limit: GapLimit::Usual,
///     until: None,
/// };
/// let logged = read_logged(&[path], &options).unwrap();
/// assert_eq!(logged.run.times, [0.0, 0.004, 0.008]);
/// # Ok::<(), std::io::Error>(())
/// ```
pub fn read_logged(files: &[PathBuf], options: &LoggedOptions) -> Result<Logged, Vec<Defect>> {
    let contents: Vec<Vec<u8>> = files.iter().map(|file| bytes(file)).collect::<Result<_, _>>()?;
    let dialect = |(file, bytes): (&PathBuf, &Vec<u8>)| Dialect::of(file, bytes);
    let dialects: Vec<Dialect> = files
        .iter()
        .zip(&contents)
        .map(dialect)
        .collect::<Result<_, _>>()
        .map_err(|defect| vec![*defect])?;
    let assignment = assign(files, &dialects, options)?;
    let table = Table::read(files, &contents, &dialects, &assignment)?;
    let mut logged = table.logged(files, &assignment, options)?;
    let mut digest = Sha256::new();
    contents.iter().for_each(|bytes| digest.update(bytes));
    logged.run.sha256 = hex(&digest.finalize());
    logged.understood.set(files, &dialects[0], &assignment, &logged.run);
    logged.run.truncate(options.until);
    Ok(logged)
}

fn bytes(file: &Path) -> Result<Vec<u8>, Vec<Defect>> {
    reachtube_files::bytes(file).map_err(|source| {
        let problem = format!("cannot read: {source}");
        let defect = Defect::new(file, None, problem, "check the path and its permissions");
        vec![defect.of_kind(DefectKind::File)]
    })
}

/// The numbers of a recording as written.
struct Table {
    /// Line of each sample in the first file.
    lines: Vec<u64>,
    /// Times, in units of 1e-12 of the unit of the time.
    times: Vec<i128>,
    q: Vec<Vec<f64>>,
    qd: Option<Vec<Vec<f64>>>,
    tau: Option<Vec<Vec<f64>>>,
    temperatures: Option<Vec<Vec<f64>>>,
}

impl Table {
    fn read(
        files: &[PathBuf],
        contents: &[Vec<u8>],
        dialects: &[Dialect],
        assignment: &Assignment,
    ) -> Result<Self, Vec<Defect>> {
        let tau = assignment.tau.as_ref().map(|(columns, _)| columns);
        let lists =
            [Some(&assignment.q), assignment.qd.as_ref(), tau, assignment.temperatures.as_ref()];
        let mut read: Vec<FileNumbers> = Vec::new();
        for (file, dialect) in dialects.iter().enumerate() {
            let columns: Vec<usize> = of_file(&lists, file).map(|column| column.at).collect();
            let (path, bytes, time) = (&files[file], &contents[file], &assignment.time[file]);
            read.push(numbers::read(path, bytes, dialect, time, &columns)?);
        }
        check_times(files, &read)?;
        let mut values: Vec<_> =
            read.iter_mut().map(|f| std::mem::take(&mut f.values).into_iter()).collect();
        let mut take = |list: Option<&Vec<Column>>| {
            let mut next = |column: &Column| values[column.file].next().unwrap_or_default();
            list.map(|columns| columns.iter().map(&mut next).collect::<Vec<_>>())
        };
        let q = take(lists[0]).unwrap_or_default();
        let (qd, tau, temperatures) = (take(lists[1]), take(lists[2]), take(lists[3]));
        let FileNumbers { lines, times, .. } = read.swap_remove(0);
        Ok(Self { lines, times, q, qd, tau, temperatures })
    }

    /// Brings the numbers to s, rad and rad/s, and says what was done.
    fn logged(
        mut self,
        files: &[PathBuf],
        assignment: &Assignment,
        options: &LoggedOptions,
    ) -> Result<Logged, Vec<Defect>> {
        let n = self.q.len();
        let kinds = options.robot.map_or(vec![JointKind::Revolute; n], |robot| robot.kinds());
        let units = self.units(&kinds, assignment, options).map_err(|[problem, remedy]| {
            vec![Defect::new(&files[0], None, problem, remedy).of_kind(DefectKind::Units)]
        })?;
        for joint in (0..n).filter(|joint| kinds[*joint] == JointKind::Revolute) {
            scale(&mut self.q[joint], units.q.per_radian());
            self.qd.iter_mut().for_each(|qd| scale(&mut qd[joint], units.qd.per_radian()));
        }
        let times = self.seconds(units.time);
        self.check_gaps(&files[0], &times, options)?;
        let name = files[0].display();
        let mut notes: Vec<String> =
            assignment.notes.iter().map(|note| format!("{name}: {note}")).collect();
        notes.extend(units.notes(assignment.qd.is_some()).map(|note| format!("{name}: {note}")));
        for joint in (0..n).filter(|joint| kinds[*joint] == JointKind::Revolute) {
            let jumps = unwrap(&mut self.q[joint]);
            let Some(&first) = jumps.first() else { continue };
            notes.push(format!(
                "{name}:{}: {} jumps by whole turns at {:.3} s{}; the turns were taken out",
                self.lines[first],
                assignment.joints[joint],
                times[first],
                if jumps.len() > 1 {
                    format!(" and {} times more", jumps.len() - 1)
                } else {
                    String::new()
                }
            ));
        }
        let about_torques =
            torque_note(assignment).into_iter().chain(self.dead_torques(assignment));
        notes.extend(about_torques.map(|note| format!("{name}: {note}")));
        let run = self.run(times, units.time);
        Ok(Logged { run, understood: Understood::of(units), notes })
    }

    fn units(
        &self,
        kinds: &[JointKind],
        assignment: &Assignment,
        options: &LoggedOptions,
    ) -> Result<Units, [String; 2]> {
        let times: Vec<f64> =
            self.times.iter().map(|time| (time - self.times[0]) as f64 / 1e12).collect();
        let revolute: Vec<bool> = kinds.iter().map(|kind| *kind == JointKind::Revolute).collect();
        let furthest = |[low, high]: [f64; 2]| low.abs().max(high.abs());
        let limits: Vec<Option<f64>> = match options.robot {
            None => vec![None; kinds.len()],
            Some(robot) => {
                let joints = robot.description().joints.iter();
                joints.map(|joint| joint.position_limits.map(furthest)).collect()
            }
        };
        let speeds: Vec<Option<f64>> = match options.robot {
            None => vec![None; kinds.len()],
            Some(robot) => robot.joints().iter().map(|joint| joint.velocity_limit).collect(),
        };
        let numbers = Numbers {
            times: &times,
            first: self.times[0] as f64 / 1e12,
            q: &self.q,
            qd: self.qd.as_deref(),
            revolute: &revolute,
            limits: &limits,
            speeds: &speeds,
        };
        let columns = assignment.q.iter().chain(assignment.qd.iter().flatten());
        let named = columns.filter_map(|column| column.name.angle).next();
        recognise(&numbers, assignment.time[0].unit, options.columns.angle.or(named))
    }

    /// Names the joints that move while their torque stays the same.
    fn dead_torques(&self, assignment: &Assignment) -> Option<String> {
        let tau = self.tau.as_ref()?;
        let moves = |joint: &usize| {
            let first = self.q[*joint][0];
            self.q[*joint].iter().any(|q| (q - first).abs() > MOVES)
        };
        let is_dead = |joint: &usize| tau[*joint].iter().all(|value| *value == tau[*joint][0]);
        let dead: Vec<usize> = (0..tau.len()).filter(moves).filter(is_dead).collect();
        let [first, ..] = dead[..] else { return None };
        let names: Vec<&str> = dead.iter().map(|i| assignment.joints[*i].as_str()).collect();
        Some(format!(
            "the torque of {} is {} in every sample, although the joint moves: it was not \
             measured, and no model of it can be identified",
            names.join(", "),
            tau[first][0]
        ))
    }

    /// Returns the times since the first sample, s.
    fn seconds(&self, unit: TimeUnit) -> Vec<f64> {
        // A picosecond is the least difference, as in recordings of reachtube.
        let picoseconds = |time: &i128| (time - self.times[0]) / unit.per_second();
        self.times.iter().map(|time| picoseconds(time) as f64 / 1e12).collect()
    }

    fn check_gaps(
        &self,
        file: &Path,
        times: &[f64],
        options: &LoggedOptions,
    ) -> Result<(), Vec<Defect>> {
        let steps: Vec<f64> = times.windows(2).map(|pair| pair[1] - pair[0]).collect();
        let longest = options.gap_limit.longest_step(steps.clone());
        let defect = |(line, step): (&u64, &f64)| {
            let problem = format!(
                "there is a gap of {step:.6} s before this sample, but the limit is {longest:.6} s"
            );
            let remedy = "samples are missing there: cut the log, or accept it with --max-gap \
                          SECONDS (max_gap in the settings)";
            Defect::new(file, Some(*line), problem, remedy).of_kind(DefectKind::gap(*step))
        };
        let gaps = self.lines[1..].iter().zip(&steps).filter(|(_, step)| **step > longest);
        let defects: Vec<Defect> = gaps.map(defect).collect();
        if defects.is_empty() { Ok(()) } else { Err(defects) }
    }

    fn run(self, times: Vec<f64>, unit: TimeUnit) -> Run {
        let (n, samples) = (self.q.len(), times.len());
        let qd = self.qd.unwrap_or_else(|| self.q.iter().map(|q| derivative(&times, q)).collect());
        let row = |columns: &[Vec<f64>], k: usize| -> Vec<f64> {
            columns.iter().map(|column| column[k]).collect()
        };
        let rows = |columns: Option<Vec<Vec<f64>>>| {
            let columns = columns.unwrap_or_default();
            (0..samples).flat_map(|k| row(&columns, k)).collect::<Vec<f64>>()
        };
        let tau = self.tau.unwrap_or_else(|| vec![vec![0.0; samples]; n]);
        Run {
            joints: n,
            start: self.times[0] as f64 / 1e12 / unit.per_second() as f64,
            states: (0..samples).flat_map(|k| [row(&self.q, k), row(&qd, k)].concat()).collect(),
            torques: rows(Some(tau)),
            temperatures: rows(self.temperatures),
            times,
            sha256: String::new(),
        }
    }
}

/// Returns the columns of one file in the order of the lists.
fn of_file<'a>(
    lists: &'a [Option<&'a Vec<Column>>],
    file: usize,
) -> impl Iterator<Item = &'a Column> {
    lists.iter().flatten().flat_map(|list| list.iter()).filter(move |column| column.file == file)
}

/// Checks that the files of one recording have the same times.
fn check_times(files: &[PathBuf], read: &[FileNumbers]) -> Result<(), Vec<Defect>> {
    let first = &read[0];
    for (file, other) in files.iter().zip(read).skip(1) {
        let differs = (0..first.times.len().max(other.times.len()))
            .find(|&k| first.times.get(k) != other.times.get(k));
        let Some(k) = differs else { continue };
        let problem = if other.times.get(k).is_some() && first.times.get(k).is_some() {
            format!("sample {} is at another time than in {}", k + 1, files[0].display())
        } else {
            let counts = [other.times.len(), first.times.len()];
            format!("there are {} samples, but {} in {}", counts[0], counts[1], files[0].display())
        };
        let remedy = "the files of one recording need the same times: export them together, or \
                      give a file with all quantities";
        let line = other.lines.get(k).copied();
        return Err(vec![Defect::new(file, line, problem, remedy).of_kind(DefectKind::Time)]);
    }
    Ok(())
}

fn torque_note(assignment: &Assignment) -> Option<String> {
    let (columns, kind) = assignment.tau.as_ref()?;
    let names = super::joints::listed(columns.iter().map(|column| column.text.as_str()));
    match kind {
        TorqueKind::Measured => None,
        TorqueKind::Demanded => Some(format!(
            "the torques {names} are what the model of the controller demands, not a measurement: \
             what is identified from them is that model"
        )),
        TorqueKind::Current => Some(format!("{names} are motor currents")),
    }
}

fn scale(values: &mut [f64], per_unit: f64) {
    if per_unit != 1.0 {
        values.iter_mut().for_each(|value| *value /= per_unit);
    }
}

/// Returns the derivative of a position at each sample: the slope of the parabola through three.
fn derivative(times: &[f64], q: &[f64]) -> Vec<f64> {
    let slope = |a: usize, b: usize| (q[b] - q[a]) / (times[b] - times[a]);
    let last = times.len() - 1;
    let at = |k: usize| match k {
        _ if last == 0 => 0.0,
        0 => slope(0, 1),
        k if k == last => slope(k - 1, k),
        k => {
            let (before, after) = (times[k] - times[k - 1], times[k + 1] - times[k]);
            (slope(k - 1, k) * after + slope(k, k + 1) * before) / (before + after)
        }
    };
    (0..=last).map(at).collect()
}
