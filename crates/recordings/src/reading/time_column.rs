//! The column with the time.

use std::path::PathBuf;

use super::dialect::Dialect;
use super::joints::{Column, listed};
use super::name::{Origin, Quantity};
use super::options::LoggedOptions;
use super::unit::TimeUnit;
use crate::defect::{Defect, DefectKind};

/// The columns of a file that give the time.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct TimeColumns {
    /// The column of the time, or of its whole seconds.
    pub at: usize,
    /// The column of the nanoseconds of each second, if there is one.
    pub nanoseconds: Option<usize>,
    /// The unit that the settings or the name give.
    pub unit: Option<TimeUnit>,
    pub name: String,
}

impl TimeColumns {
    pub(super) fn contains(&self, at: usize) -> bool {
        self.at == at || self.nanoseconds == Some(at)
    }
}

/// Words of the name of a time that make it no other time, such as one of execution.
const USUAL: [&str; 18] = [
    "t",
    "time",
    "timestamp",
    "timestamps",
    "stamp",
    "header",
    "field",
    "s",
    "sec",
    "secs",
    "seconds",
    "ms",
    "us",
    "ns",
    "elapsed",
    "msec",
    "usec",
    "nsec",
];

pub(super) fn time_columns(
    files: &[PathBuf],
    dialects: &[Dialect],
    columns: &[Column],
    options: &LoggedOptions,
) -> Result<Vec<TimeColumns>, Box<Defect>> {
    let of_file = |(file, dialect): (usize, &Dialect)| {
        let columns: Vec<&Column> = columns.iter().filter(|c| c.file == file).collect();
        time_of(&columns, options).ok_or_else(|| {
            let names = listed(columns.iter().map(|column| column.text.as_str()));
            let problem = match &options.columns.time {
                Some(name) => format!("there is no column \"{name}\"; the header has {names}"),
                None => format!("no column is the time; the header has {names}"),
            };
            let remedy = "name it in the settings: [columns] time = \"NAME\", or --columns \
                          time=NAME; where samples without a time are evenly spaced, give their \
                          rate in Hz: --columns rate=HZ";
            let defect = Defect::new(&files[file], Some(dialect.line), problem, remedy);
            Box::new(defect.of_kind(DefectKind::Header))
        })
    };
    dialects.iter().enumerate().map(of_file).collect()
}

fn time_of(columns: &[&Column], options: &LoggedOptions) -> Option<TimeColumns> {
    let unit = options.columns.time_unit;
    if let Some(name) = &options.columns.time {
        let column = columns.iter().find(|column| column.text == *name)?;
        let unit = unit.or(column.name.time_unit);
        return Some(TimeColumns { at: column.at, nanoseconds: None, unit, name: name.clone() });
    }
    let is_time = |column: &&&Column| {
        let name = &column.name;
        let whole = ["sec", "secs"].map(|word| name.words.last().is_some_and(|last| last == word));
        let is_time = name.quantity == Some(Quantity::Time) || whole.contains(&true);
        is_time && name.origin != Origin::Target && !is_nanoseconds(column)
    };
    let extra = |column: &Column| {
        let words = column.name.words.iter();
        words.filter(|word| !USUAL.contains(&word.as_str())).count()
    };
    let is_header = |column: &Column| {
        ["header", "stamp"].iter().all(|word| column.name.words.iter().any(|w| w == word))
    };
    let column = columns
        .iter()
        .filter(is_time)
        .min_by_key(|column| (!is_header(column), extra(column), column.at))?;
    let nanoseconds = columns.iter().find(|other| {
        let sibling = |words: &[String]| words[..words.len() - 1].to_vec();
        is_nanoseconds(other) && sibling(&other.name.words) == sibling(&column.name.words)
    });
    let ends_in_seconds = column.name.words.last().is_some_and(|word| word.starts_with("sec"));
    let nanoseconds = nanoseconds.filter(|_| ends_in_seconds).map(|other| other.at);
    let of_name = column.name.time_unit.or_else(|| ends_in_seconds.then_some(TimeUnit::Seconds));
    let name = column.text.clone();
    Some(TimeColumns { at: column.at, nanoseconds, unit: unit.or(of_name), name })
}

fn is_nanoseconds(column: &Column) -> bool {
    let last = column.name.words.last();
    last.is_some_and(|word| matches!(word.as_str(), "nsec" | "nsecs" | "nanosec" | "nanosecs"))
}
