//! One recording of a log: the numbers of its files, joined and brought to the units of reachtube.

use std::path::PathBuf;

use super::assignment::{Assignment, TorqueKind};
use super::canonical::recording;
use super::command::commanded;
use super::dialect::Dialect;
use super::joints::{Column, Joints, listed};
use super::name::Quantity;
use super::options::LoggedOptions;
use super::recognise::{Numbers, Units, recognise};
use super::table::{ReadColumn, Table};
use super::understood::Understood;
use crate::defect::{Defect, DefectKind};
use crate::run::Run;
use crate::source::ReadOptions;
use crate::text::quoted;
use crate::units::dead_torques;
use crate::unwrap::take_out_turns;

/// No quantity of a joint is beyond these in any unit.
const POSSIBLE: [f64; 2] = [-1e9, 1e9];

/// A recording of a log, and what was understood of it.
#[derive(Debug, Clone, PartialEq)]
pub struct Logged {
    /// The recording, with columns in the order of the robot's joints. Motor currents stand in
    /// place of its torques where gains were announced. Torques are 0 where a log has none, which
    /// [`Wanted::Torques`](super::Wanted::Torques) does not accept.
    pub run: Run,
    /// Commanded positions, row-major K x n, rad; empty unless they are wanted.
    pub command: Vec<f64>,
    /// What was understood of columns and units; `None` for a file in the format of
    /// `docs/recordings.md`.
    pub understood: Option<Understood>,
    /// Notes for the user, each with the name of the file.
    pub notes: Vec<String>,
}

/// Reads a file in the format of recordings, and takes whole turns out.
pub(super) fn as_it_is(
    files: &[PathBuf],
    content: &[u8],
    dialect: &Dialect,
    options: &LoggedOptions,
) -> Result<Logged, Vec<Defect>> {
    let joints = options.robot.map(<[_]>::len);
    let read = ReadOptions { joints, gap_limit: options.gap_limit, until: None };
    let of_robot = Joints::of_robot(options).unwrap_or_default();
    let (mut run, table) =
        recording(&files[0], content, dialect, (&of_robot.places, Some(POSSIBLE)), &read)?;
    let names = match options.robot {
        Some(_) => of_robot.names,
        None => (1..=run.joints).map(|joint| format!("joint {joint}")).collect(),
    };
    let notes = turn_notes(&mut run, files, &table, &names, options);
    Ok(Logged { run, command: vec![], understood: None, notes })
}

/// Takes whole turns out of the positions of revolute joints, and returns a note for each.
fn turn_notes(
    run: &mut Run,
    files: &[PathBuf],
    table: &Table,
    joints: &[String],
    options: &LoggedOptions,
) -> Vec<String> {
    let (n, is_revolute) = (run.joints, revolute(options, run.joints));
    let note = |joint: usize| {
        let jumps = take_out_turns(run, joint);
        let first = *jumps.first()?;
        Some(format!(
            "{}:{}: {} jumps by whole turns at {:.3} s{}; the turns were taken out",
            files[0].display(),
            table.line(first)?,
            joints[joint],
            run.times[first],
            match jumps.len() - 1 {
                0 => String::new(),
                more => format!(" and {more} times more"),
            }
        ))
    };
    (0..n).filter(|joint| is_revolute[*joint]).filter_map(note).collect()
}

/// Returns whether each joint is revolute, as all are without a robot.
fn revolute(options: &LoggedOptions, joints: usize) -> Vec<bool> {
    options.robot.map_or(vec![true; joints], |axes| axes.iter().map(|of| of.is_revolute).collect())
}

/// A log whose columns are known.
pub(super) struct Log<'a> {
    pub files: &'a [PathBuf],
    pub dialects: &'a [Dialect],
    pub assignment: &'a Assignment,
    pub options: &'a LoggedOptions<'a>,
}

impl Log<'_> {
    /// Reads the numbers, brings them to s, rad and rad/s, and notes the changes.
    pub(super) fn logged(&self, contents: &[Vec<u8>]) -> Result<Logged, Vec<Defect>> {
        let Self { files, assignment, options, .. } = *self;
        let tables = self.tables(contents)?;
        let values = |column: &Column| tables[column.file].values(&[column.at]);
        let columns = |list: &Vec<Column>| list.iter().map(values).collect::<Vec<_>>();
        let mut q = columns(&assignment.q);
        let mut qd = assignment.qd.as_ref().map(columns);
        let tau = assignment.tau.as_ref().map(|(list, _)| columns(list));
        let command = assignment.command.as_ref().map(columns);
        let n = q.len();
        let revolute = revolute(options, n);
        let units = self.units(&revolute, &tables[0], &q, qd.as_deref());
        let units = units.map_err(|[problem, remedy]| {
            vec![Defect::new(&files[0], None, problem, remedy).of_kind(DefectKind::Units)]
        })?;
        for joint in (0..n).filter(|joint| revolute[*joint]) {
            scale(&mut q[joint], units.q.per_radian());
            qd.iter_mut().for_each(|qd| scale(&mut qd[joint], units.qd.per_radian()));
        }
        let per_second = units.time.per_second();
        let gaps = tables[0].gaps(&files[0], per_second, options.gap_limit);
        if !gaps.is_empty() {
            return Err(gaps);
        }
        let times = tables[0].seconds(per_second);
        let rows = |columns: &[&[Vec<f64>]]| -> Vec<f64> {
            let row = |k: usize| columns.iter().copied().flatten().map(move |column| column[k]);
            (0..times.len()).flat_map(row).collect()
        };
        let still = vec![vec![0.0; times.len()]; n];
        let first = tables[0].time(0).unwrap_or_default() as f64;
        let mut run = Run {
            joints: n,
            start: first / 1e12 / per_second as f64,
            states: rows(&[&q, qd.as_ref().unwrap_or(&still)]),
            torques: rows(&[tau.as_ref().unwrap_or(&still)]),
            temperatures: rows(&[&assignment.temperatures.as_ref().map_or(vec![], columns)]),
            times,
            before: vec![],
            sha256: String::new(),
        };
        let name = files[0].display();
        let named = |note: String| format!("{name}: {note}");
        let mut notes: Vec<String> = assignment.notes.iter().cloned().map(named).collect();
        let is_missed = qd.is_none() && options.wanted.has_torques();
        notes.extend(units.notes(!is_missed).map(named));
        notes.extend(turn_notes(&mut run, files, &tables[0], &assignment.joints, options));
        if qd.is_none() {
            differentiate(&mut run);
        }
        let dead = tau.is_some().then(|| dead_torque_note(&run, &assignment.joints)).flatten();
        notes.extend(torque_note(assignment).into_iter().chain(dead).map(named));
        let command = command.map_or(vec![], |r| commanded(r, &run, &revolute, units.q));
        let understood = Understood::new(files, &self.dialects[0], assignment, units, &run);
        Ok(Logged { run, command, understood: Some(understood), notes })
    }

    /// Reads the numbers of each file, which have the same times.
    fn tables(&self, contents: &[Vec<u8>]) -> Result<Vec<Table>, Vec<Defect>> {
        let lists = self.assignment.lists();
        let mut tables: Vec<Table> = Vec::new();
        for (file, dialect) in self.dialects.iter().enumerate() {
            let time = &self.assignment.time[file];
            let column = |at: usize, quantity| ReadColumn {
                at,
                name: format!("column {}", quoted(&dialect.names[at])).into(),
                joint: None,
                quantity,
                limits: (quantity != Quantity::Time).then_some(POSSIBLE),
            };
            let times = std::iter::once(time.at).chain(time.nanoseconds);
            let mut columns: Vec<_> = times.map(|at| column(at, Quantity::Time)).collect();
            for (quantity, list) in &lists {
                let of_file = list.iter().filter(|column| column.file == file);
                columns.extend(of_file.map(|of| column(of.at, *quantity)));
            }
            let path = &self.files[file];
            let (table, defects) = Table::read(path, &contents[file], dialect, time, columns);
            if !defects.is_empty() {
                return Err(defects);
            }
            tables.push(table);
        }
        check_times(self.files, &tables).map_err(|defect| vec![*defect])?;
        Ok(tables)
    }

    fn units(
        &self,
        revolute: &[bool],
        table: &Table,
        q: &[Vec<f64>],
        qd: Option<&[Vec<f64>]>,
    ) -> Result<Units, [String; 2]> {
        let furthest = |[low, high]: [f64; 2]| low.abs().max(high.abs());
        let (mut limits, mut speeds) = (vec![None; q.len()], vec![None; q.len()]);
        if let Some(axes) = self.options.robot {
            limits = axes.iter().map(|axis| axis.position_limits.map(furthest)).collect();
            speeds = axes.iter().map(|axis| axis.velocity_limit).collect();
        }
        let numbers = Numbers {
            times: &table.seconds(1),
            first: table.time(0).unwrap_or_default() as f64 / 1e12,
            q,
            qd,
            revolute,
            limits: &limits,
            speeds: &speeds,
        };
        let columns = self.assignment.q.iter().chain(self.assignment.qd.iter().flatten());
        let named = columns.filter_map(|column| column.name.angle).next();
        recognise(&numbers, self.assignment.time[0].unit, self.options.columns.angle.or(named))
    }
}

/// Checks that the files of one recording have the same times.
fn check_times(files: &[PathBuf], tables: &[Table]) -> Result<(), Box<Defect>> {
    let (first, of) = (&tables[0], files[0].display());
    for (file, other) in files.iter().zip(tables).skip(1) {
        let counts = [other.len(), first.len()];
        let rows = 0..counts[0].max(counts[1]);
        let Some(k) = rows.into_iter().find(|k| first.time(*k) != other.time(*k)) else { continue };
        let problem = match k < counts[0].min(counts[1]) {
            true => format!("sample {} is at another time than in {of}", k + 1),
            false => format!("there are {} samples, but {} in {of}", counts[0], counts[1]),
        };
        let remedy = "the files of one recording need the same times: export them together, or \
                      give a file with all quantities";
        let defect = Defect::new(file, other.line(k), problem, remedy);
        return Err(Box::new(defect.of_kind(DefectKind::Time)));
    }
    Ok(())
}

/// Names the joints whose torques were not measured.
fn dead_torque_note(run: &Run, joints: &[String]) -> Option<String> {
    let dead = dead_torques(&[run]);
    let names: Vec<&str> = dead.iter().map(|i| joints[*i].as_str()).collect();
    Some(format!(
        "the torque of {} is {} in every sample, although the joint moves: it was not measured, \
         and no model of it can be identified",
        names.join(", "),
        run.torque(0)[*dead.first()?]
    ))
}

fn torque_note(assignment: &Assignment) -> Option<String> {
    let (columns, kind) = assignment.tau.as_ref()?;
    let names = listed(columns.iter().map(|column| column.text.as_str()));
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

/// Makes the velocities the derivatives of the positions at each sample: the slope of the parabola
/// through three.
fn differentiate(run: &mut Run) {
    let (n, last) = (run.joints, run.len() - 1);
    for joint in 0..n {
        let q: Vec<f64> = (0..=last).map(|k| run.q(k)[joint]).collect();
        let times = &run.times;
        let slope = |a: usize, b: usize| (q[b] - q[a]) / (times[b] - times[a]);
        for k in 0..=last {
            run.states[(2 * k + 1) * n + joint] = match k {
                _ if last == 0 => 0.0,
                0 => slope(0, 1),
                k if k == last => slope(k - 1, k),
                k => {
                    let (before, after) = (times[k] - times[k - 1], times[k + 1] - times[k]);
                    (slope(k - 1, k) * after + slope(k, k + 1) * before) / (before + after)
                }
            };
        }
    }
}
