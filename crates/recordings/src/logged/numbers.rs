//! The numbers in the columns of a file.

use std::path::Path;

use super::dialect::Dialect;
use super::time_column::TimeColumns;
use super::unit::TimeUnit;
use crate::decimal::picoseconds;
use crate::defect::{Defect, DefectKind};
use crate::text::quoted;

/// Number of defects after which a file is not read on.
const MOST_DEFECTS: usize = 1000;

/// No quantity of a joint is beyond this in any unit.
const LARGEST: f64 = 1e9;

/// The numbers of some columns of a file, K rows.
pub(super) struct FileNumbers {
    /// Line of each row, from 1.
    pub lines: Vec<u64>,
    /// Times as written, in units of 1e-12 of the unit of the time.
    pub times: Vec<i128>,
    /// Values of each column.
    pub values: Vec<Vec<f64>>,
}

/// Reads the numbers in some columns of a file.
///
/// # Errors
///
/// Every line that is cut short, value that is no number, and time that does not increase.
pub(super) fn read(
    path: &Path,
    bytes: &[u8],
    dialect: &Dialect,
    time: &TimeColumns,
    columns: &[usize],
) -> Result<FileNumbers, Vec<Defect>> {
    let numbers = FileNumbers { lines: vec![], times: vec![], values: vec![vec![]; columns.len()] };
    let mut reading =
        Reading { path, dialect, time, columns, numbers, above: None, defects: vec![] };
    if let Err((line, problem)) = dialect.rows(bytes, |line, row| reading.row(line, row)) {
        reading.defect(DefectKind::File, Some(line), problem, "correct the line");
    }
    if reading.numbers.lines.is_empty() && reading.defects.is_empty() {
        let problem = "there is no sample after the header".into();
        let remedy = "record at least one sample, or take the file out of the folder";
        reading.defect(DefectKind::Empty, None, problem, remedy);
    }
    if reading.defects.is_empty() { Ok(reading.numbers) } else { Err(reading.defects) }
}

struct Reading<'a> {
    path: &'a Path,
    dialect: &'a Dialect,
    time: &'a TimeColumns,
    columns: &'a [usize],
    numbers: FileNumbers,
    /// Time of the row above, where it is known.
    above: Option<i128>,
    defects: Vec<Defect>,
}

impl Reading<'_> {
    fn defect(&mut self, kind: DefectKind, line: Option<u64>, problem: String, remedy: &str) {
        self.defects.push(Defect::new(self.path, line, problem, remedy).of_kind(kind));
    }

    /// Reads one row, and returns whether to go on.
    fn row(&mut self, line: u64, row: &[&str]) -> bool {
        if self.defects.len() >= MOST_DEFECTS {
            let problem = format!("reading stopped after {MOST_DEFECTS} defects");
            self.defect(DefectKind::Other, Some(line), problem, "correct the defects before");
            return false;
        }
        let fields = self.dialect.names.len();
        if row.len() != fields {
            let problem = format!("the line has {} fields, but the header has {fields}", row.len());
            let remedy = "the line is cut short or has a stray separator: correct it, or remove \
                          it if it is the last";
            self.above = None;
            self.defect(DefectKind::Fields, Some(line), problem, remedy);
            return true;
        }
        let before = self.defects.len();
        let time = self.time_of(line, row);
        let mut values = Vec::with_capacity(self.columns.len());
        for &at in self.columns {
            values.push(self.value(line, at, row[at]));
        }
        if let Some(time) = time {
            self.check_order(line, time, row[self.time.at]);
            self.numbers.times.push(time);
        }
        if self.defects.len() == before {
            self.numbers.lines.push(line);
            for (column, value) in self.numbers.values.iter_mut().zip(values) {
                column.push(value);
            }
        }
        true
    }

    fn value(&mut self, line: u64, at: usize, text: &str) -> f64 {
        let name = quoted(&self.dialect.names[at]);
        let value = number(text, self.dialect.separator);
        let problem = match value {
            Some(value) if value.abs() <= LARGEST => return value,
            Some(value) if value.is_finite() => {
                format!("column {name} is {value:e}, which no joint has in any unit")
            }
            _ if text.is_empty() => format!("column {name} is empty"),
            _ => format!("column {name} is {}, not a finite number", quoted(text)),
        };
        let remedy = "every value must be a number: cut the log before this line, or record again";
        self.defect(DefectKind::Value, Some(line), problem, remedy);
        f64::NAN
    }

    /// Returns the time of a row in units of 1e-12 of its unit.
    fn time_of(&mut self, line: u64, row: &[&str]) -> Option<i128> {
        let of = |at: usize| decimal(row[at], self.dialect.separator);
        let time = match self.time.nanoseconds {
            None => of(self.time.at),
            // In units of seconds: a nanosecond has 1000 of 1e-12.
            Some(at) => of(self.time.at)
                .zip(of(at))
                .and_then(|(s, ns)| s.checked_add(ns / TimeUnit::Nanoseconds.per_second())),
        };
        if time.is_none() {
            let text = row[self.time.at];
            let problem = format!("the time {} is {}, not a number", self.time.name, quoted(text));
            let remedy = "write times as decimal numbers in s, ms, us or ns";
            self.defect(DefectKind::Time, Some(line), problem, remedy);
        }
        time
    }

    fn check_order(&mut self, line: u64, time: i128, text: &str) {
        if let Some(above) = self.above.replace(time)
            && time <= above
        {
            let what = if above == time {
                "the time of the sample above"
            } else {
                "earlier than the sample above"
            };
            let problem = format!("{} = {text} is {what}", self.time.name);
            let remedy = "times must increase strictly: sort the samples and drop duplicates";
            self.defect(DefectKind::Time, Some(line), problem, remedy);
        }
    }
}

/// Returns a number; where commas do not separate columns, it may have one for its point.
fn number(text: &str, separator: u8) -> Option<f64> {
    let number = text.parse().ok();
    number.or_else(|| with_point(text, separator)?.parse().ok()).filter(|n: &f64| !n.is_nan())
}

fn decimal(text: &str, separator: u8) -> Option<i128> {
    picoseconds(text).or_else(|| picoseconds(&with_point(text, separator)?))
}

fn with_point(text: &str, separator: u8) -> Option<String> {
    let one = text.matches(',').count() == 1 && !text.contains('.');
    (separator != b',' && one).then(|| text.replace(',', "."))
}
