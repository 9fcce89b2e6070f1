//! The numbers in the columns of a text file. All defects are found at once.

use std::borrow::Cow;
use std::path::Path;

use super::dialect::{Dialect, end_of_line, is_plain};
use super::name::Quantity;
use super::number::number;
use super::row::{Row, time};
use super::time_column::TimeColumns;
use crate::defect::{Defect, DefectKind};
use crate::gap_limit::GapLimit;
use crate::text::quoted;

const NUMBER: &str = "every value must be a number: cut the run before this line, or record again";

const DECIMAL: &str = "write times as decimal numbers, or cut the run before this line";

/// Number of defects after which a file is not read on.
const MOST_DEFECTS: usize = 1000;

/// A column of a file that is read.
#[derive(Debug)]
pub(super) struct ReadColumn<'a> {
    /// Number of the column in the file, from 0.
    pub at: usize,
    /// What messages call it.
    pub name: Cow<'a, str>,
    /// The joint, from 1.
    pub joint: Option<usize>,
    pub quantity: Quantity,
    /// The lowest and the highest value that a joint can have, unless all are possible.
    pub limits: Option<[f64; 2]>,
}

/// The numbers of some columns of a file.
#[derive(Debug)]
pub(super) struct Table {
    rows: Vec<TableRow>,
    /// Columns of the file that were read, in the order of the file.
    columns: Vec<usize>,
    /// Values of each row without a defect, in this order.
    values: Vec<f64>,
}

#[derive(Debug)]
struct TableRow {
    /// Line in the file, from 1.
    line: u64,
    /// Time in units of 1e-12 of its unit, where it is a number.
    time: Option<i128>,
}

impl Table {
    /// Reads the numbers in some columns of a file, which has the times among them.
    pub(super) fn read(
        path: &Path,
        bytes: &[u8],
        dialect: &Dialect,
        times: &TimeColumns,
        mut columns: Vec<ReadColumn<'_>>,
    ) -> (Self, Vec<Defect>) {
        columns.sort_by_key(|column| column.at);
        let place = |at| columns.iter().position(|column| column.at == at);
        let table =
            Self { rows: vec![], columns: columns.iter().map(|c| c.at).collect(), values: vec![] };
        let mut reader = Reader {
            path,
            dialect,
            times,
            time: place(times.at).unwrap_or_default(),
            nanoseconds: times.nanoseconds.and_then(place),
            limited: (0..).zip(&columns).filter_map(|(i, c)| Some((i, c.limits?))).collect(),
            row: Row::new(dialect.names.len(), &table.columns, times.at, dialect.separator),
            columns,
            table,
            defects: vec![],
        };
        reader.read(bytes);
        (reader.table, reader.defects)
    }

    pub(super) fn len(&self) -> usize {
        self.rows.len()
    }

    /// Returns the line of a row, from 1.
    pub(super) fn line(&self, row: usize) -> Option<u64> {
        self.rows.get(row).map(|row| row.line)
    }

    /// Returns the time of a row, in units of 1e-12 of its unit.
    pub(super) fn time(&self, row: usize) -> Option<i128> {
        self.rows.get(row).and_then(|row| row.time)
    }

    pub(super) fn first(&self) -> Option<f64> {
        self.values.first().copied()
    }

    /// Returns the times since the first one, s, to the picosecond.
    pub(super) fn seconds(&self, per_second: i128) -> Vec<f64> {
        let first = self.time(0).unwrap_or_default();
        let times = self.rows.iter().map(|row| row.time.unwrap_or(first));
        times.map(|time| seconds(time.saturating_sub(first), per_second)).collect()
    }

    /// Returns the values of some columns of the file, row by row.
    pub(super) fn values(&self, columns: &[usize]) -> Vec<f64> {
        let place = |at: &usize| self.columns.binary_search(at).unwrap_or_default();
        let places: Vec<usize> = columns.iter().map(place).collect();
        let mut values = Vec::with_capacity(places.len() * self.rows.len());
        let rows = self.values.chunks_exact(self.columns.len().max(1));
        match places.windows(2).all(|pair| pair[1] == pair[0] + 1) {
            true => {
                let first = places.first().copied().unwrap_or_default();
                rows.for_each(|row| values.extend_from_slice(&row[first..first + places.len()]));
            }
            false => rows.for_each(|row| values.extend(places.iter().map(|place| row[*place]))),
        }
        values
    }

    /// Returns a defect for each step that is too long. Steps to and from a line whose time is
    /// unknown are not known.
    pub(super) fn gaps(&self, path: &Path, per_second: i128, limit: GapLimit) -> Vec<Defect> {
        let step = |pair: &[TableRow]| {
            let step = seconds(pair[1].time?.saturating_sub(pair[0].time?), per_second);
            (step > 0.0).then_some((Some(pair[1].line), step))
        };
        limit.gaps(path, self.rows.windows(2).filter_map(step).collect())
    }
}

/// The state of reading a file.
struct Reader<'a> {
    path: &'a Path,
    dialect: &'a Dialect,
    times: &'a TimeColumns,
    columns: Vec<ReadColumn<'a>>,
    /// Places of the time, of its nanoseconds, and of columns with limits among the columns.
    time: usize,
    nanoseconds: Option<usize>,
    limited: Vec<(usize, [f64; 2])>,
    row: Row,
    table: Table,
    defects: Vec<Defect>,
}

impl Reader<'_> {
    fn defect(&mut self, kind: DefectKind, line: Option<u64>, problem: String, remedy: &str) {
        self.defects.push(Defect::new(self.path, line, problem, remedy).of_kind(kind));
    }

    fn read(&mut self, bytes: &[u8]) {
        let is_done = self.dialect.plain_rows(bytes).is_some_and(|rows| self.plain_rows(rows));
        if !is_done {
            (self.table.rows, self.table.values, self.defects) = (vec![], vec![], vec![]);
            self.quoted_rows(bytes);
        }
        if self.table.rows.is_empty() && self.defects.is_empty() {
            let remedy = "record at least one sample, or leave the run out";
            let problem = "there is no sample after the header".into();
            self.defect(DefectKind::Empty, None, problem, remedy);
        }
    }

    /// Reads the rows of text without quotes; returns false if it has some.
    fn plain_rows(&mut self, text: &[u8]) -> bool {
        self.reserve(text);
        let (mut at, mut line, mut is_known_as_plain) = (0, self.dialect.line, false);
        let mut fields = Vec::with_capacity(self.row.fields());
        while at < text.len() && !self.has_too_many_defects() {
            let rest = &text[at..];
            line += 1;
            if let Some(length) = self.row.read(rest)
                && self.keeps(line)
            {
                at += length;
                continue;
            }
            // Something else than sound numbers is left to the careful reader of one line.
            is_known_as_plain = is_known_as_plain || is_plain(text, false);
            if !is_known_as_plain {
                return false;
            }
            let end = end_of_line(rest);
            self.dialect.fields(&rest[..end], &mut fields);
            if !fields.is_empty() {
                self.careful(line, &fields);
            }
            at += end + 1;
        }
        true
    }

    /// Reserves memory for lines as long as the first one of `text`, and for no more values than
    /// the text can hold.
    fn reserve(&mut self, text: &[u8]) {
        let most = text.len() / (2 * self.row.fields().max(1));
        let samples = (text.len() / (end_of_line(text) + 1)).min(most) + 1;
        self.table.rows.reserve(samples);
        self.table.values.reserve(samples * self.columns.len());
    }

    fn quoted_rows(&mut self, bytes: &[u8]) {
        let read = self.dialect.rows(bytes, |line, fields| {
            let goes_on = !self.has_too_many_defects();
            if goes_on {
                self.careful(line, fields);
            }
            goes_on
        });
        if let Err((line, problem)) = read {
            self.defect(DefectKind::File, Some(line), problem, "correct the line");
        }
    }

    /// Returns whether reading ends here, and adds a defect that says so.
    fn has_too_many_defects(&mut self) -> bool {
        let is_over = self.defects.len() >= MOST_DEFECTS;
        if is_over {
            // On the last line, so that the defects before come first.
            let line = self.table.rows.last().map(|row| row.line);
            let problem = format!("reading stopped after {MOST_DEFECTS} defects");
            self.defect(DefectKind::Other, line, problem, "correct the defects before");
        }
        is_over
    }

    /// Returns the time that was read, in units of 1e-12 of its unit.
    fn row_time(&self) -> i128 {
        match self.nanoseconds {
            None => self.row.time,
            // In units of seconds: a nanosecond has 1000 of 1e-12.
            Some(place) => self.row.time.saturating_add((self.row.values[place] * 1e3) as i128),
        }
    }

    /// Keeps the numbers of a line, unless they have a defect.
    fn keeps(&mut self, line: u64) -> bool {
        let (time, values) = (self.row_time(), &self.row.values);
        let above = self.table.rows.last().and_then(|row| row.time);
        let is_possible = |(place, limits): &(usize, [f64; 2])| within(*limits, values[*place]);
        let is_sound =
            above.is_none_or(|above| time > above) && self.limited.iter().all(is_possible);
        if is_sound {
            self.table.rows.push(TableRow { line, time: Some(time) });
            self.table.values.extend_from_slice(values);
        }
        is_sound
    }

    /// Reads the fields of one line, and keeps its numbers if they have no defect.
    fn careful(&mut self, line: u64, fields: &[&[u8]]) {
        let (found, expected) = (fields.len(), self.row.fields());
        if found != expected {
            self.table.rows.push(TableRow { line, time: None });
            let problem = format!("the line has {found} fields, but the header has {expected}");
            let remedy = "the line is cut short or has a stray separator or quote: correct it, \
                          record again, or remove it if it is the last";
            return self.defect(DefectKind::Fields, Some(line), problem, remedy);
        }
        let before = self.defects.len();
        for place in 0..self.columns.len() {
            let text = self.with_point(fields[self.columns[place].at]);
            let value = number(&text).unwrap_or(f64::NAN);
            self.row.values[place] = value;
            if place == self.time {
                self.row.time = time(&text, value);
            }
            let is_possible = self.columns[place].limits.is_none_or(|limits| within(limits, value));
            if !value.is_finite() || !is_possible {
                self.bad_value(line, place, value, fields[self.columns[place].at]);
            }
        }
        if self.defects.len() == before && self.keeps(line) {
            return;
        }
        let above = self.table.rows.last().and_then(|row| row.time);
        let is_known = self.row.values[self.time].is_finite();
        let time = is_known.then(|| self.row_time());
        self.table.rows.push(TableRow { line, time });
        if let (Some(above), Some(time)) = (above, time)
            && time <= above
        {
            let what = if above == time { "the time of" } else { "earlier than" };
            let unit = self.times.unit.map_or(String::new(), |unit| format!(" {}", unit.name()));
            let text = String::from_utf8_lossy(fields[self.times.at]);
            let problem = format!("{} = {text}{unit} is {what} the line above", self.times.name);
            let remedy = "times must increase strictly: sort the samples and drop duplicates";
            self.defect(DefectKind::Time, Some(line), problem, remedy);
        }
    }

    /// Returns a field with a decimal point in place of a decimal comma.
    fn with_point<'a>(&self, field: &'a [u8]) -> Cow<'a, [u8]> {
        let commas = field.iter().filter(|byte| **byte == b',').count();
        match self.dialect.separator != b',' && commas == 1 && !field.contains(&b'.') {
            true => field.iter().map(|byte| if *byte == b',' { b'.' } else { *byte }).collect(),
            false => field.into(),
        }
    }

    /// Adds a defect of a value. Impossible values of a column are one.
    fn bad_value(&mut self, line: u64, place: usize, value: f64, text: &[u8]) {
        let ReadColumn { name, joint, quantity, .. } = &self.columns[place];
        let is_number = value.is_finite();
        let is_known = |defect: &Defect| {
            defect.kind == DefectKind::Units && defect.problem.starts_with(&format!("{name} "))
        };
        if is_number && self.defects.iter().any(is_known) {
            return;
        }
        let (problem, remedy) = match quantity {
            Quantity::Temperature if is_number => (
                format!("{name} is {value}, which no joint has in °C"),
                "give temperatures in °C, not in K, or rename the column",
            ),
            _ if is_number => (
                format!("{name} is {value:e}, which no joint has in any unit"),
                "cut the run before this line, or record again",
            ),
            Quantity::Velocity if text.is_empty() => (
                format!("{name} is empty"),
                "if no velocity was measured, delete the columns of qd; `model` derives them",
            ),
            _ => (
                match String::from_utf8_lossy(text) {
                    text if text.is_empty() => format!("{name} is empty"),
                    text => format!("{name} is {}, not a finite number", quoted(&text)),
                },
                match quantity {
                    Quantity::Time => DECIMAL,
                    _ => NUMBER,
                },
            ),
        };
        let kind = if is_number { DefectKind::Units } else { DefectKind::Value };
        let defect = Defect::new(self.path, Some(line), problem, remedy).of_kind(kind);
        self.defects.push(defect.of_joint(*joint));
    }
}

fn within([low, high]: [f64; 2], value: f64) -> bool {
    low <= value && value <= high
}

/// Returns a difference of times in s, to the picosecond.
fn seconds(difference: i128, per_second: i128) -> f64 {
    let picoseconds = if per_second == 1 { difference } else { difference / per_second };
    // The conversion of 64 bits is an instruction of the processor; both round to nearest.
    i64::try_from(picoseconds).map_or(picoseconds as f64, |short| short as f64) / 1e12
}
