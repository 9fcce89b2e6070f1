//! Which columns of a recording's files are its time, positions, velocities and torques.

use std::path::PathBuf;

use super::dialect::Dialect;
use super::files::quantity_of_file;
use super::joints::{Column, Joints, Mismatch, by_pattern, listed};
use super::name::{ColumnName, Origin, Quantity};
use super::options::{LoggedOptions, Wanted};
use super::time_column::{TimeColumns, time_columns};
use crate::defect::{Defect, DefectKind};

/// The kind of the torques of a log.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum TorqueKind {
    Measured,
    /// What the model of the controller demands.
    Demanded,
    /// Motor currents, which gains turn into torques.
    Current,
}

/// The columns of a recording.
#[derive(Debug, Clone)]
pub(super) struct Assignment {
    /// Columns of the time, for each file.
    pub time: Vec<TimeColumns>,
    pub q: Vec<Column>,
    /// Commanded positions, where they are asked for.
    pub command: Option<Vec<Column>>,
    pub qd: Option<Vec<Column>>,
    pub tau: Option<(Vec<Column>, TorqueKind)>,
    pub temperatures: Option<Vec<Column>>,
    /// Names of the joints, if they are known.
    pub joints: Vec<String>,
    pub notes: Vec<String>,
    pub unused: Vec<String>,
}

impl Assignment {
    pub(super) fn lists(&self) -> [(Quantity, &[Column]); 5] {
        let tau = self.tau.as_ref().map(|(columns, _)| &columns[..]);
        [
            (Quantity::Position, &self.q),
            (Quantity::Position, self.command.as_deref().unwrap_or_default()),
            (Quantity::Velocity, self.qd.as_deref().unwrap_or_default()),
            (Quantity::Torque, tau.unwrap_or_default()),
            (Quantity::Temperature, self.temperatures.as_deref().unwrap_or_default()),
        ]
    }
}

pub(super) fn assign(
    files: &[PathBuf],
    dialects: &[Dialect],
    options: &LoggedOptions,
) -> Result<Assignment, Vec<Defect>> {
    let finder =
        Finder { files, line: dialects[0].line, options, columns: columns(files, dialects) };
    finder.assignment(dialects).map_err(|defect| vec![*defect])
}

/// Returns the columns of all files. A file of one quantity has it in its name or its columns'.
fn columns(files: &[PathBuf], dialects: &[Dialect]) -> Vec<Column> {
    let mut columns = Vec::new();
    for (file, dialect) in dialects.iter().enumerate() {
        let of_file = quantity_of_file(&files[file]);
        for (at, text) in dialect.names.iter().enumerate().filter(|(_, text)| !text.is_empty()) {
            let mut name = ColumnName::new(text);
            name.quantity = name.quantity.or(of_file);
            columns.push(Column { file, at, text: text.clone(), name });
        }
    }
    columns
}

type Found<T> = Result<T, Box<Defect>>;

struct Finder<'a> {
    files: &'a [PathBuf],
    /// Line of the first file's header.
    line: u64,
    options: &'a LoggedOptions<'a>,
    columns: Vec<Column>,
}

impl Finder<'_> {
    fn assignment(&self, dialects: &[Dialect]) -> Found<Assignment> {
        let time = time_columns(self.files, dialects, &self.columns, self.options)?;
        let mut notes = Vec::new();
        let joints = self.joints()?;
        let (q, others) = self.positions(&joints)?;
        let is_of_robot = self.options.robot.is_some();
        if !others.is_empty() && (is_of_robot || self.options.joints.is_empty()) {
            let others = listed(others.iter().map(|column| column.text.as_str()));
            let why =
                if is_of_robot { "the robot has no joint for" } else { "there is no command of" };
            notes.push(format!("{why} {others}, which are not used"));
        }
        let find = |quantity, origins: &[Origin]| self.find(quantity, origins, &joints);
        let measured = [Origin::Measured, Origin::Unstated];
        let qd = find(Quantity::Velocity, &measured)?.map(|(columns, _)| columns);
        let temperatures = find(Quantity::Temperature, &measured).ok().flatten();
        let temperatures = temperatures.map(|(columns, _)| columns);
        let is_command = self.options.wanted == Wanted::Commands;
        let command = is_command.then(|| self.commands(&joints)).transpose()?;
        let tau = if self.options.wanted.has_torques() { self.torques(&joints)? } else { None };
        let mut out = Assignment {
            time,
            q,
            command,
            qd,
            tau,
            temperatures,
            joints: joints.names,
            notes,
            unused: vec![],
        };
        out.unused = self.unused(&out);
        Ok(out)
    }

    /// Returns the columns of a quantity from the first of some origins that has any.
    fn find(
        &self,
        quantity: Quantity,
        origins: &[Origin],
        joints: &Joints,
    ) -> Found<Option<(Vec<Column>, Vec<Column>)>> {
        match self.given_by(key_of(quantity), joints)? {
            Some(columns) => Ok(Some((columns, vec![]))),
            None => self.matched(quantity, origins, joints),
        }
    }

    /// Returns the columns whose names fit a quantity, as [`find`](Self::find) does.
    fn matched(
        &self,
        quantity: Quantity,
        origins: &[Origin],
        joints: &Joints,
    ) -> Found<Option<(Vec<Column>, Vec<Column>)>> {
        let mut first = None;
        for origin in origins {
            let columns = self.of(quantity, *origin);
            if columns.is_empty() {
                continue;
            }
            match joints.matched(&columns) {
                Ok(found) => return Ok(Some(found)),
                Err(mismatch) => first = first.or(Some((mismatch, columns))),
            }
        }
        match first {
            None => Ok(None),
            Some((mismatch, columns)) => Err(self.mismatch(quantity, mismatch, &columns, joints)),
        }
    }

    fn of(&self, quantity: Quantity, origin: Origin) -> Vec<Column> {
        let fits = |column: &&Column| {
            column.name.quantity == Some(quantity) && column.name.origin == origin
        };
        self.columns.iter().filter(fits).cloned().collect()
    }

    /// Returns the columns that the settings name under a key.
    fn given_by(&self, key: &str, joints: &Joints) -> Found<Option<Vec<Column>>> {
        let Some((_, pattern)) = self.options.columns.patterns().find(|(own, _)| key == *own)
        else {
            return Ok(None);
        };
        let found = by_pattern(&self.columns, pattern, self.options.columns.first);
        let count = joints.names.len();
        if self.options.robot.is_none() && count > 0 && count < found.len() {
            let refused = |of| self.mismatch(Quantity::Position, of, &found, joints);
            return joints.matched(&found).map(|(chosen, _)| Some(chosen)).map_err(refused);
        }
        if found.is_empty() || (count > 0 && found.len() != count) {
            let problem = format!(
                "columns.{key} = \"{pattern}\" names {} columns of the {}; the header has {}",
                found.len(),
                if count > 0 { format!("{count} joints") } else { "joints".into() },
                self.header()
            );
            return Err(self.defect(DefectKind::Header, problem, REMEDY));
        }
        let places = joints.places.iter().map(|place| found[*place].clone());
        Ok(Some(if count > 0 { places.collect() } else { found }))
    }

    /// Returns the robot's joints; without a robot, the joints that the positions name.
    fn joints(&self) -> Found<Joints> {
        let first = self.options.columns.first;
        if let Some(joints) = Joints::of_robot(self.options) {
            return Ok(joints);
        }
        let none = Joints { first, ..Joints::default() };
        let given = self.given_by(key_of(Quantity::Position), &none)?;
        let measured =
            || [Origin::Measured, Origin::Unstated].map(|o| self.of(Quantity::Position, o));
        let found = given.or_else(|| measured().into_iter().find(|columns| !columns.is_empty()));
        let mut found = found.unwrap_or_default();
        let [head, ..] = &found[..] else { return Ok(none) };
        // One series is in the order of its numbers, names are in the order of the file.
        let series = head.name.series();
        if found.iter().all(|c| c.name.number().is_some() && c.name.series() == series) {
            found.sort_by_key(|column| column.name.number());
        }
        let name = |column: &Column| match column.name.joint[..] {
            [] => column.text.clone(),
            _ => column.name.joint.join("_"),
        };
        let mut joints = Joints { names: found.iter().map(name).collect(), places: vec![], first };
        let is_command = self.options.wanted == Wanted::Commands;
        let commands = is_command.then(|| self.of(Quantity::Position, Origin::Target));
        joints.choose(self.options.joints, commands.as_deref());
        Ok(joints)
    }

    fn positions(&self, joints: &Joints) -> Found<(Vec<Column>, Vec<Column>)> {
        if self.options.wanted == Wanted::Plan {
            // Columns that were named for logs need not be in a plan.
            if let Ok(Some(columns)) = self.given_by("r", joints) {
                return Ok((columns, vec![]));
            }
            // The header may be the joints' names and nothing else.
            let named = |name: &String| self.columns.iter().find(|of| of.text == *name).cloned();
            let named: Option<Vec<Column>> = joints.names.iter().map(named).collect();
            if let Some(columns) = named.filter(|columns| !columns.is_empty()) {
                return Ok((columns, vec![]));
            }
            let origins = [Origin::Target, Origin::Unstated, Origin::Measured];
            if let Some(found) = self.matched(Quantity::Position, &origins, joints)? {
                return Ok(found);
            }
        }
        let measured = [Origin::Measured, Origin::Unstated];
        if let Some(found) = self.find(Quantity::Position, &measured, joints)? {
            return Ok(found);
        }
        let targets = self.of(Quantity::Position, Origin::Target);
        if targets.is_empty() {
            let problem =
                format!("no column is a position of a joint; the header has {}", self.header());
            return Err(self.defect(DefectKind::Header, problem, REMEDY));
        }
        let problem = format!(
            "the positions are targets only: {}; a model needs the measured motion",
            listed(targets.iter().map(|column| column.text.as_str()))
        );
        let remedy = "log the measured positions too, such as actual_q_0, or leave the file out";
        Err(self.defect(DefectKind::Header, problem, remedy))
    }

    fn commands(&self, joints: &Joints) -> Found<Vec<Column>> {
        if let Some(columns) = self.given_by("r", joints)? {
            return Ok(columns);
        }
        if let Some((columns, _)) = self.matched(Quantity::Position, &[Origin::Target], joints)? {
            return Ok(columns);
        }
        let header = self.header();
        let problem = format!("no column is a commanded position; the header has {header}");
        let remedy = "log the commanded positions too, such as target_q_0, or name their columns: \
                      --columns r=NAME_{}; to model an arm by its torques, say --torque motor, \
                      link or compensated";
        Err(self.defect(DefectKind::Header, problem, remedy))
    }

    fn torques(&self, joints: &Joints) -> Found<Option<(Vec<Column>, TorqueKind)>> {
        let measured = [Origin::Measured, Origin::Unstated];
        let torque = self.find(Quantity::Torque, &measured, joints)?;
        if let Some((columns, _)) = torque {
            return Ok(Some((columns, TorqueKind::Measured)));
        }
        let current = self.find(Quantity::Current, &measured, joints);
        if self.options.gains
            && let Some((columns, _)) = current.clone()?
        {
            return Ok(Some((columns, TorqueKind::Current)));
        }
        let demanded = self.find(Quantity::Torque, &[Origin::Target], joints)?;
        if let Some((columns, _)) = demanded {
            return Ok(Some((columns, TorqueKind::Demanded)));
        }
        if self.options.wanted == Wanted::AnyTorques {
            return Ok(current.ok().flatten().map(|(columns, _)| (columns, TorqueKind::Current)));
        }
        if let Some((columns, _)) = current? {
            let problem = format!(
                "there is no torque, but there are motor currents: {}",
                listed(columns.iter().map(|column| column.text.as_str()))
            );
            let remedy = "give the torque per current of each joint, N m/A at the output side of \
                          the gear: gains = [..] in the settings, or --gains";
            return Err(self.defect(DefectKind::Header, problem, remedy));
        }
        let problem = format!("no column is a torque of a joint; the header has {}", self.header());
        let remedy = "log torques or motor currents too; where a column holds them, name it in the \
                      settings: [columns] tau = \"NAME_{}\"";
        Err(self.defect(DefectKind::Header, problem, remedy))
    }

    fn mismatch(
        &self,
        quantity: Quantity,
        mismatch: Mismatch,
        columns: &[Column],
        joints: &Joints,
    ) -> Box<Defect> {
        let word = word_of(quantity);
        let found = listed(columns.iter().map(|column| column.text.as_str()));
        match mismatch {
            Mismatch::Twice([first, second]) => {
                let problem = format!("\"{first}\" and \"{second}\" may be {word} of one joint");
                self.defect(DefectKind::Header, problem, REMEDY)
            }
            Mismatch::Missing(missing) => {
                let names: Vec<&str> = missing.iter().map(|i| joints.names[*i].as_str()).collect();
                let (problem, remedy) = self.missing(word, &names, joints.names.len(), &found);
                self.defect(DefectKind::Joints, problem, &remedy)
            }
            Mismatch::Count(_) => {
                let problem = format!(
                    "the log has {} {word} columns, {found}, but the robot has {} joints: {}",
                    columns.len(),
                    joints.names.len(),
                    joints.names.join(", ")
                );
                let remedy = "give the robot that was recorded; hold joints that were not recorded \
                              with --lock JOINT=VALUE, or name the columns in the settings: \
                              [columns] q = \"NAME_{}\"";
                self.defect(DefectKind::Joints, problem, remedy)
            }
        }
    }

    /// Returns problem and remedy of joints that the log lacks.
    fn missing(&self, word: &str, names: &[&str], count: usize, found: &str) -> (String, String) {
        let problem = format!(
            "the log has no {word} of {}, {} of the robot's {count} joints; it has {found}",
            names.join(", "),
            names.len()
        );
        let Some(robot) = self.options.robot else {
            return (problem, REMEDY.into());
        };
        let lock = |name: &&str| {
            let axis = robot.iter().find(|axis| axis.name == **name);
            let [low, high] = axis.and_then(|axis| axis.position_limits).unwrap_or([0.0, 0.0]);
            format!("--lock {name}={}", 0.0f64.clamp(low.min(high), high.max(low)))
        };
        let locks: Vec<String> = names.iter().map(lock).collect();
        let remedy = format!(
            "if they were held, give the positions at which they were: {}; else log them too",
            locks.join(" ")
        );
        (problem, remedy)
    }

    fn unused(&self, assignment: &Assignment) -> Vec<String> {
        let used = |column: &Column| {
            assignment.lists().iter().any(|(_, list)| list.contains(column))
                || assignment.time[column.file].contains(column.at)
        };
        self.columns.iter().filter(|c| !used(c)).map(|c| c.text.clone()).collect()
    }

    fn header(&self) -> String {
        listed(self.columns.iter().map(|column| column.text.as_str()))
    }

    fn defect(&self, kind: DefectKind, problem: String, remedy: &str) -> Box<Defect> {
        Box::new(Defect::new(&self.files[0], Some(self.line), problem, remedy).of_kind(kind))
    }
}

const REMEDY: &str = "name the columns in the settings: [columns] q = \"NAME_{}\", qd = .., \
                      tau = .., time = .., or --columns q=NAME_{},..";

fn key_of(quantity: Quantity) -> &'static str {
    match quantity {
        Quantity::Position => "q",
        Quantity::Velocity => "qd",
        Quantity::Torque => "tau",
        Quantity::Current => "current",
        _ => "",
    }
}

fn word_of(quantity: Quantity) -> &'static str {
    match quantity {
        Quantity::Position => "position",
        Quantity::Velocity => "velocity",
        Quantity::Torque => "torque",
        Quantity::Current => "current",
        _ => "temperature",
    }
}
