//! Columns of text files that are named, for systems other than robots.

use std::path::Path;

use reachtube_files::hex;
use sha2::Digest;

use super::content::{Content, content};
use super::dialect::Dialect;
use super::even_times::with_times;
use super::joints::listed;
use super::name::{ColumnName, Quantity};
use super::runs::run_column;
use super::table::{ReadColumn, Table};
use super::time_column::TimeColumns;
use super::unit::TimeUnit;
use crate::defect::{Defect, DefectKind};
use crate::text::quoted;

/// The columns that are read of a file.
#[derive(Debug, Clone, Copy)]
pub struct NamedColumns<'a> {
    /// Names of columns that a file must have.
    pub required: &'a [String],
    /// Names of columns that are read if a file has all of them.
    pub optional: &'a [String],
    /// The time between samples, s, of files without a column of times.
    pub step: Option<f64>,
}

/// A run: samples of named columns.
#[derive(Debug, Clone, PartialEq)]
pub struct NamedRun {
    /// The number in the column of the runs, if the file has that.
    pub number: Option<f64>,
    /// Line of its first sample in the file, from 1.
    pub line: u64,
    /// Times since its first sample, K, s, strictly increasing.
    pub times: Vec<f64>,
    /// Required columns, row-major K x their number.
    pub required: Vec<f64>,
    /// Optional columns, row-major K x their number; empty if the file has not all of them.
    pub optional: Vec<f64>,
}

/// Reads the runs of a file, and the SHA-256 of its content. A file with a column `run`, `episode`
/// or `episode_index` has a run for each of its numbers, row after row; any other file is one run.
/// The time is the column
/// `t`, `time` or the like, in s unless its name has another unit.
///
/// # Errors
///
/// Every defect, with file, line, column and remedy.
///
/// # Panics
///
/// If the step is not above 0.
///
/// # Examples
///
/// ```
/// use reachtube_recordings::{NamedColumns, read_named};
///
/// let folder = tempfile::tempdir()?;
/// let path = folder.path().join("walkers.csv");
/// std::fs::write(&path, "run,px,py\n1,0.0,1.0\n1,0.5,1.1\n2,3.0,0.0\n")?;
/// let [required, optional] = [vec!["px".into(), "py".into()], vec![]];
/// let columns = NamedColumns { required: &required, optional: &optional, step: Some(0.4) };
/// let (runs, _) = read_named(&path, &columns).unwrap();
/// assert_eq!((runs.len(), &runs[0].times[..]), (2, &[0.0, 0.4][..]));
/// assert_eq!(runs[1].required, [3.0, 0.0]);
/// # Ok::<(), std::io::Error>(())
/// ```
pub fn read_named(
    path: &Path,
    columns: &NamedColumns<'_>,
) -> Result<(Vec<NamedRun>, String), Vec<Defect>> {
    let Content { text: mut bytes, digest, .. } = content(path)?;
    let sha256 = hex(&digest.finalize());
    let own = dialect(path, &bytes)?;
    let run = run_column(&own);
    let time = own.names.iter().position(|text| is_time(text)).filter(|at| run != Some(*at));
    // Rows of several runs, and rows without a time, are counted.
    let is_counted = run.is_some() || time.is_none();
    let step = match (time, columns.step) {
        (None, None) => return Err(vec![no_time(path, &own)]),
        (None, Some(step)) => step,
        (Some(_), _) => 1.0,
    };
    if is_counted {
        bytes = with_times(&bytes, &own, step.recip());
    }
    let dialect = self::dialect(path, &bytes)?;
    let find = |names: &[String]| -> Vec<Option<usize>> {
        names.iter().map(|name| position(&dialect, name)).collect()
    };
    let required = found(path, &own, columns.required, &find(columns.required))?;
    let optional: Vec<usize> =
        find(columns.optional).into_iter().collect::<Option<_>>().unwrap_or_default();
    let moved = |at: usize| at + usize::from(is_counted);
    let times = TimeColumns {
        at: if is_counted { 0 } else { time.unwrap_or_default() },
        nanoseconds: None,
        unit: Some(TimeUnit::Seconds),
        name: "t".into(),
    };
    let extra = [run, time].map(|at| at.map(moved));
    let others = required.iter().chain(&optional).copied().chain(extra.into_iter().flatten());
    let mut read: Vec<usize> = others.chain([times.at]).collect();
    read.sort_unstable();
    read.dedup();
    let column = |at: usize| ReadColumn {
        at,
        name: format!("column {}", quoted(&dialect.names[at])).into(),
        joint: None,
        quantity: if at == times.at { Quantity::Time } else { Quantity::Other },
        limits: None,
    };
    let (table, defects) =
        Table::read(path, &bytes, &dialect, &times, read.into_iter().map(column).collect());
    if !defects.is_empty() {
        return Err(defects);
    }
    let per_second = time.map_or(1, |at| per_second(&own.names[at]));
    let one = |at: usize| table.values(&[at]);
    let own_times = time.filter(|_| is_counted).map(|at| one(moved(at)));
    let numbers = run.map(|at| one(moved(at)));
    let split = NamedRows { path, table: &table, numbers, own_times, step, per_second };
    split.runs([&required, &optional]).map(|runs| (runs, sha256))
}

/// A table that is divided into runs.
struct NamedRows<'a> {
    path: &'a Path,
    table: &'a Table,
    /// The column `run`.
    numbers: Option<Vec<f64>>,
    /// The times of rows that were counted.
    own_times: Option<Vec<f64>>,
    step: f64,
    per_second: i128,
}

impl NamedRows<'_> {
    fn runs(&self, [required, optional]: [&[usize]; 2]) -> Result<Vec<NamedRun>, Vec<Defect>> {
        let number = |row: usize| self.numbers.as_ref().map(|all| all[row]);
        let all: Vec<usize> = (0..self.table.len()).collect();
        let seconds = self.table.seconds(self.per_second);
        let [required, optional] =
            [required, optional].map(|columns| (columns.len(), self.table.values(columns)));
        let run = |rows: &[usize]| {
            let rows = rows[0]..rows[0] + rows.len();
            let of = |(width, values): &(usize, Vec<f64>)| {
                values[rows.start * width..rows.end * width].to_vec()
            };
            let time = |row: usize| match &self.own_times {
                Some(own) => (own[row] - own[rows.start]) / self.per_second as f64,
                None if self.numbers.is_some() => (row - rows.start) as f64 * self.step,
                None => seconds[row],
            };
            let times: Vec<f64> = rows.clone().map(time).collect();
            self.increase(&times, rows.start)?;
            let line = self.table.line(rows.start).unwrap_or_default();
            let (number, required, optional) = (number(rows.start), of(&required), of(&optional));
            Ok(NamedRun { number, line, times, required, optional })
        };
        let runs: Vec<&[usize]> = all.chunk_by(|a, b| number(*a) == number(*b)).collect();
        let mut seen: Vec<(f64, usize)> =
            runs.iter().filter_map(|rows| Some((number(rows[0])?, rows[0]))).collect();
        seen.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        if let Some(pair) = seen.windows(2).find(|pair| pair[0].0 == pair[1].0) {
            let problem = format!("run {} continues after other runs", pair[1].0);
            let remedy = "sort the rows by run, or give each run its own number";
            let defect = Defect::new(self.path, self.table.line(pair[1].1), problem, remedy);
            return Err(vec![defect.of_kind(DefectKind::Other)]);
        }
        runs.into_iter().map(run).collect()
    }

    /// Refuses times of a run that do not increase.
    fn increase(&self, times: &[f64], first: usize) -> Result<(), Vec<Defect>> {
        let Some(late) = (1..times.len()).find(|row| times[*row] <= times[*row - 1]) else {
            return Ok(());
        };
        let problem =
            format!("the time is {} s after the line above", times[late] - times[late - 1]);
        let remedy = "times of a run must increase strictly: sort its samples and drop duplicates";
        let defect = Defect::new(self.path, self.table.line(first + late), problem, remedy);
        Err(vec![defect.of_kind(DefectKind::Time)])
    }
}

fn dialect(path: &Path, bytes: &[u8]) -> Result<Dialect, Vec<Defect>> {
    Dialect::of(path, bytes).map_err(|defect| vec![*defect])
}

/// Returns the column that is called `name`, with a unit or without.
fn position(dialect: &Dialect, name: &str) -> Option<usize> {
    let without_unit = |text: &str| text.split(['[', '(']).next().unwrap_or(text).trim() == name;
    let exact = dialect.names.iter().rposition(|text| text == name);
    exact.or_else(|| dialect.names.iter().position(|text| without_unit(text)))
}

fn is_time(text: &str) -> bool {
    ColumnName::new(text).quantity == Some(Quantity::Time)
}

fn per_second(text: &str) -> i128 {
    ColumnName::new(text).time_unit.unwrap_or(TimeUnit::Seconds).per_second()
}

/// Returns the places of columns that a file must have.
fn found(
    path: &Path,
    dialect: &Dialect,
    names: &[String],
    places: &[Option<usize>],
) -> Result<Vec<usize>, Vec<Defect>> {
    let missing: Vec<&str> =
        names.iter().zip(places).filter(|(_, at)| at.is_none()).map(|(name, _)| &**name).collect();
    if missing.is_empty() {
        return Ok(places.iter().flatten().copied().collect());
    }
    let names = listed(dialect.names.iter().map(String::as_str));
    let problem = format!(
        "there is no column {}; the header has {names}",
        missing.iter().map(|name| quoted(name)).collect::<Vec<_>>().join(", ")
    );
    let remedy = "give outputs and inputs of the system the names of their columns";
    let defect = Defect::new(path, Some(dialect.line), problem, remedy);
    Err(vec![defect.of_kind(DefectKind::Header)])
}

fn no_time(path: &Path, dialect: &Dialect) -> Defect {
    let names = listed(dialect.names.iter().map(String::as_str));
    let problem = format!("no column is the time; the header has {names}");
    let remedy = "add a column t [s]; only a system with a step can count samples";
    Defect::new(path, Some(dialect.line), problem, remedy).of_kind(DefectKind::Header)
}
