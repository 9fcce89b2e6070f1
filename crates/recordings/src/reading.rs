//! Reading of a recording's file, which finds all of its defects at once.

use std::path::Path;

use reachtube_files::hex;
use sha2::{Digest, Sha256};

use crate::defect::{Defect, DefectKind};
use crate::gap_limit::GapLimit;
use crate::header::{is_numbered, temperature};
use crate::lines::{PlainHeader, end_of_line, is_plain, number, plain_header};
use crate::other_format::{HEADER, other_format};
use crate::row::{Row, field, time};
use crate::run::{Run, column_names};
use crate::source::ReadOptions;
use crate::text::{line_of, quoted};

const TEMPERATURES: &str = "give one temperature per joint, temp1..tempn in °C, one after another, \
                            or give the column another name";

/// Temperatures that a joint can have, °C. Values in kelvin are beyond them.
const JOINT_TEMPERATURES: std::ops::RangeInclusive<f64> = -100.0..=250.0;

/// Number of defects after which a file is not read on.
const MOST_DEFECTS: usize = 1000;

/// Largest number of joints of a recording; a header with more is a mistake.
const MOST_JOINTS: usize = 100;

/// Reads the recording in the CSV file `path`.
///
/// # Errors
///
/// Every defect of the file, with its line and joint.
pub fn read_csv(path: &Path, options: &ReadOptions) -> Result<Run, Vec<Defect>> {
    let bytes = reachtube_files::bytes(path).map_err(|source| {
        let problem = format!("cannot read: {source}");
        let defect = Defect::new(path, None, problem, "check the path and its permissions");
        vec![defect.of_kind(DefectKind::File)]
    })?;
    parse_csv(path, &bytes, options)
}

/// Reads the recording in the content of a CSV file, which messages call `name`.
///
/// # Errors
///
/// Every defect of the content, with its line and joint.
///
/// # Examples
///
/// ```
/// use reachtube_recordings::{ReadOptions, parse_csv};
///
/// let content = b"t,q1,qd1,tau1\n0.0,0.1,0.0,2.0\n0.1,0.1,0.0,2.0\n";
/// let run = parse_csv("run.csv".as_ref(), content, &ReadOptions::default()).unwrap();
/// assert_eq!((run.joints, run.len()), (1, 2));
/// ```
pub fn parse_csv(name: &Path, content: &[u8], options: &ReadOptions) -> Result<Run, Vec<Defect>> {
    let mut run = read_samples(name, content, options.joints, options.gap_limit)?;
    run.sha256 = hex(&Sha256::digest(content));
    run.truncate(options.until);
    Ok(run)
}

/// Reads the samples in `bytes`, the content of the file `path`. Another number of joints than
/// `joints` is a defect. The SHA-256 of the result is empty.
fn read_samples(
    path: &Path,
    bytes: &[u8],
    joints: Option<usize>,
    gap_limit: GapLimit,
) -> Result<Run, Vec<Defect>> {
    let mut reading = Reading {
        path,
        run: Run::empty(0),
        temperatures_at: None,
        rows: Vec::new(),
        defects: Vec::new(),
    };
    reading.header_and_rows(bytes, joints);
    reading.gaps(gap_limit);
    reading.defects.sort_by_key(|defect| defect.line);
    if reading.defects.is_empty() { Ok(reading.run) } else { Err(reading.defects) }
}

/// A line with a sample.
struct CsvRow {
    /// Line in the file, from 1.
    line: u64,
    /// Time in picoseconds, where it is a number.
    time: Option<i128>,
}

/// The state of reading a file.
struct Reading<'a> {
    path: &'a Path,
    run: Run,
    /// Column of `temp1`, from 0, where there is one.
    temperatures_at: Option<usize>,
    rows: Vec<CsvRow>,
    defects: Vec<Defect>,
}

impl Reading<'_> {
    fn defect(&mut self, kind: DefectKind, line: Option<u64>, problem: String, remedy: &str) {
        self.defects.push(Defect::new(self.path, line, problem, remedy).of_kind(kind));
    }

    fn header_and_rows(&mut self, bytes: &[u8], joints: Option<usize>) {
        let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
        if let Some((problem, remedy)) = other_format(bytes) {
            return self.defect(DefectKind::File, Some(1), problem, remedy);
        }
        match plain_header(bytes) {
            Some(header) => {
                let Some(mut row) = self.columns(&header.fields, joints) else { return };
                if !self.plain_rows(bytes, &header, &mut row) {
                    let joints = self.run.joints;
                    (self.run, self.rows, self.defects) = (Run::empty(joints), vec![], vec![]);
                    self.quoted_rows(bytes, &mut csv_reader(bytes), &mut row);
                }
            }
            None => {
                let mut reader = csv_reader(bytes);
                let header = match reader.byte_headers() {
                    Ok(header) => header.clone(),
                    Err(error) => {
                        let (kind, remedy) = (DefectKind::File, "write the file as UTF-8 CSV");
                        return self.defect(kind, Some(1), error.to_string(), remedy);
                    }
                };
                let fields = header.iter().collect::<Vec<_>>();
                let Some(mut row) = self.columns(&fields, joints) else { return };
                self.quoted_rows(bytes, &mut reader, &mut row);
            }
        }
        if self.rows.is_empty() && self.defects.is_empty() {
            let remedy = "record at least one sample, or leave the run out of runs.csv";
            let problem = "there is no sample after the header".into();
            self.defect(DefectKind::Empty, None, problem, remedy);
        }
    }

    /// Reads the rows of text without quotes; returns false if it has some.
    fn plain_rows(&mut self, bytes: &[u8], header: &PlainHeader, row: &mut Row) -> bool {
        let (mut at, mut line) = (header.end, header.lines);
        self.reserve(bytes.get(at..).unwrap_or_default(), row.fields());
        let (mut fields, mut is_known_as_plain) = (Vec::with_capacity(row.fields()), false);
        while at < bytes.len() && !self.has_too_many_defects() {
            let rest = &bytes[at..];
            line += 1;
            if let Some(length) = row.read(rest) {
                at += length;
                self.numbers(line, Some(row.time), rest, &row.values);
                continue;
            }
            // Something else than numbers is left to the careful reader of one line.
            is_known_as_plain = is_known_as_plain || is_plain(bytes);
            if !is_known_as_plain {
                return false;
            }
            let end = end_of_line(rest);
            let text = rest[..end].strip_suffix(b"\r").unwrap_or(&rest[..end]);
            if !text.is_empty() {
                fields.clear();
                fields.extend(text.split(|byte| *byte == b',').map(<[u8]>::trim_ascii));
                self.row(line, &fields, row);
            }
            at += end + 1;
        }
        true
    }

    /// Reserves memory for lines as long as the first one of `text`, and for no more values than
    /// the text can hold.
    fn reserve(&mut self, text: &[u8], fields: usize) {
        let samples = (text.len() / (end_of_line(text) + 1)).min(text.len() / (2 * fields)) + 1;
        self.rows.reserve(samples);
        self.run.times.reserve(samples);
        self.run.states.reserve(samples * 2 * self.run.joints);
        self.run.torques.reserve(samples * self.run.joints);
    }

    /// Reads the rows of any other text.
    fn quoted_rows(&mut self, bytes: &[u8], reader: &mut csv::Reader<&[u8]>, row: &mut Row) {
        let mut record = csv::ByteRecord::new();
        while !self.has_too_many_defects() {
            match reader.read_byte_record(&mut record) {
                Ok(true) => {
                    let line = line_of(bytes, record.position());
                    self.row(line, &record.iter().collect::<Vec<_>>(), row);
                }
                Ok(false) => return,
                Err(error) => {
                    let line = line_of(bytes, error.position());
                    let problem = error.to_string();
                    return self.defect(DefectKind::File, Some(line), problem, "correct the line");
                }
            }
        }
    }

    /// Returns whether reading ends here, and adds a defect that says so.
    fn has_too_many_defects(&mut self) -> bool {
        let is_over = self.defects.len() >= MOST_DEFECTS;
        if is_over {
            // On the last line, so that the defects before come first.
            let line = self.rows.last().map(|row| row.line);
            let problem = format!("reading stopped after {MOST_DEFECTS} defects");
            self.defect(DefectKind::Other, line, problem, "correct the defects before");
        }
        is_over
    }

    /// Returns a row of the columns that are read: time, positions, velocities, torques,
    /// temperatures. `None` if the header is wrong.
    fn columns(&mut self, header: &[&[u8]], joints: Option<usize>) -> Option<Row> {
        let names = header.iter().map(|name| String::from_utf8_lossy(name).into_owned());
        if !self.header(&names.collect::<Vec<_>>(), joints) {
            return None;
        }
        let n = self.run.joints;
        let temperatures = self.temperatures_at.map_or(0..0, |first| first..first + n);
        Some(Row::new(header.len(), &(0..=3 * n).chain(temperatures).collect::<Vec<_>>()))
    }

    /// Returns whether the header is `t,q1..qn,qd1..qdn,tau1..taun`, with any columns after these.
    /// `temp1` among them is the first of n temperatures.
    fn header(&mut self, header: &[String], joints: Option<usize>) -> bool {
        let n = header.iter().skip(1).take_while(|name| is_numbered(name, "q")).count();
        if n > MOST_JOINTS {
            let problem = format!("the header has {n} joints, but at most {MOST_JOINTS} are read");
            self.defect(DefectKind::Header, Some(1), problem, HEADER);
            return false;
        }
        let expected: Vec<String> =
            std::iter::once("t".into()).chain(column_names(n.max(1))).collect();
        let wrong = expected.iter().enumerate().find(|(i, name)| header.get(*i) != Some(name));
        if let Some((i, name)) = wrong {
            let found = header.get(i).map_or("missing".into(), |found| quoted(found));
            let problem = format!("column {} of the header is {found}, expected \"{name}\"", i + 1);
            self.defect(DefectKind::Header, Some(1), problem, HEADER);
            return false;
        }
        if let Some(robot) = joints.filter(|robot| *robot != n) {
            let problem = format!("the recording has {n} joints, but the robot has {robot}");
            self.defect(
                DefectKind::Joints,
                Some(1),
                problem,
                "give the robot that was recorded, or the right data set",
            );
            return false;
        }
        self.run = Run::empty(n);
        self.temperatures_at = header.iter().position(|name| name == "temp1");
        let Some(first) = self.temperatures_at else { return true };
        let wrong =
            (1..=n).find(|joint| header.get(first + joint - 1) != Some(&temperature(*joint)));
        if let Some(joint) = wrong {
            let at = first + joint - 1;
            let found = header.get(at).map_or("missing".into(), |found| quoted(found));
            let name = temperature(joint);
            let problem =
                format!("column {} of the header is {found}, expected \"{name}\"", at + 1);
            self.defect(DefectKind::Header, Some(1), problem, TEMPERATURES);
        }
        wrong.is_none()
    }

    /// Reads the fields of one line, and keeps its sample where it has no defect.
    fn row(&mut self, line: u64, fields: &[&[u8]], row: &mut Row) {
        if fields.len() != row.fields() {
            self.rows.push(CsvRow { line, time: None });
            let (found, expected) = (fields.len(), row.fields());
            let problem = format!("the line has {found} fields, but the header has {expected}");
            let remedy =
                "the line is cut short or has a stray comma or quote: correct it or record again";
            return self.defect(DefectKind::Fields, Some(line), problem, remedy);
        }
        let mut sound = true;
        let columns: Vec<usize> = row.columns().collect();
        for (at, (value, column)) in row.values.iter_mut().zip(columns).enumerate() {
            *value = number(fields[column]).unwrap_or_else(|| {
                sound = false;
                self.bad_number(line, at, &String::from_utf8_lossy(fields[column]));
                f64::NAN
            });
        }
        let time = row.values[0].is_finite().then(|| time(fields[0], row.values[0]));
        match sound {
            true => self.numbers(line, time, fields[0], &row.values),
            false => _ = self.time(line, time, fields[0]),
        }
    }

    /// Takes the numbers of a line whose time is in the first field of `text`, and keeps its sample
    /// where it has no defect.
    fn numbers(&mut self, line: u64, time: Option<i128>, text: &[u8], values: &[f64]) {
        if let Some(time) = self.time(line, time, text) {
            self.impossible_temperatures(line, &values[1 + 3 * self.run.joints..]);
            self.sample(time, values);
        }
    }

    /// Adds a defect for each joint whose temperature is impossible for the first time.
    fn impossible_temperatures(&mut self, line: u64, temperatures: &[f64]) {
        for (joint, value) in (1..).zip(temperatures) {
            let known =
                |defect: &Defect| defect.kind == DefectKind::Units && defect.joint == Some(joint);
            if JOINT_TEMPERATURES.contains(value) || self.defects.iter().any(known) {
                continue;
            }
            let problem = format!("{} is {value}, which no joint has in °C", temperature(joint));
            let remedy = "give temperatures in °C, not in K, or rename the column";
            let defect = Defect::new(self.path, Some(line), problem, remedy);
            self.defects.push(defect.of_kind(DefectKind::Units).of_joint(Some(joint)));
        }
    }

    /// Adds a defect for value `at` of a line, in the order of [`Self::columns`].
    fn bad_number(&mut self, line: u64, at: usize, text: &str) {
        let (n, joint) = (self.run.joints, at.checked_sub(1).map(|i| i % self.run.joints + 1));
        let mut names =
            std::iter::once("t".into()).chain(column_names(n)).chain((1..=n).map(temperature));
        let name = names.nth(at).unwrap_or_default();
        let problem = match text.is_empty() {
            true => format!("{name} is empty"),
            false => format!("{name} is {}, not a finite number", quoted(text)),
        };
        let remedy = match text.is_empty() && (n + 1..=2 * n).contains(&at) {
            true => "if no velocity was measured, delete the columns of qd; `model` derives them",
            false => "every value must be a number: cut the run before this line, or record again",
        };
        let defect = Defect::new(self.path, Some(line), problem, remedy).of_kind(DefectKind::Value);
        self.defects.push(defect.of_joint(joint));
    }

    /// Returns the time of a line in picoseconds, where it is a number and later than the time of
    /// the line above. The first field of `text` holds it.
    fn time(&mut self, line: u64, time: Option<i128>, text: &[u8]) -> Option<i128> {
        let above = self.rows.last().and_then(|row| row.time);
        self.rows.push(CsvRow { line, time });
        let follows = above.zip(time).is_none_or(|(above, time)| time > above);
        if !follows {
            let what = if above == time {
                "the time of the line above"
            } else {
                "earlier than the line above"
            };
            let text = String::from_utf8_lossy(field(text));
            let remedy = "times must increase strictly: sort the samples and drop duplicates";
            let problem = format!("t = {text} s is {what}");
            self.defect(DefectKind::Time, Some(line), problem, remedy);
        }
        time.filter(|_| follows)
    }

    /// Adds a sample to the run.
    fn sample(&mut self, time: i128, values: &[f64]) {
        let n = self.run.joints;
        let first = self.rows.iter().find_map(|row| row.time).unwrap_or(time);
        if self.run.times.is_empty() {
            self.run.start = values[0];
        }
        self.run.times.push(seconds(time.saturating_sub(first)));
        self.run.states.extend_from_slice(&values[1..1 + 2 * n]);
        self.run.torques.extend_from_slice(&values[1 + 2 * n..1 + 3 * n]);
        self.run.temperatures.extend_from_slice(&values[1 + 3 * n..]);
    }

    /// Finds steps that are too long. Steps to and from a line whose time is unknown are not known.
    fn gaps(&mut self, limit: GapLimit) {
        let step = |pair: &[CsvRow]| {
            let step = seconds(pair[1].time?.saturating_sub(pair[0].time?));
            (step > 0.0).then_some((pair[1].line, step))
        };
        let steps: Vec<(u64, f64)> = self.rows.windows(2).filter_map(step).collect();
        let longest = limit.longest_step(steps.iter().map(|(_, step)| *step).collect());
        for (line, step) in steps.into_iter().filter(|(_, step)| *step > longest) {
            let problem = format!(
                "there is a gap of {step:.6} s before this sample, but the limit is {longest:.6} s"
            );
            let remedy = "samples are missing and the input there is unknown: record again, cut \
                          the run, or accept it with --max-gap SECONDS";
            self.defect(DefectKind::gap(step), Some(line), problem, remedy);
        }
    }
}

/// Returns the reader of text with quotes.
fn csv_reader(bytes: &[u8]) -> csv::Reader<&[u8]> {
    csv::ReaderBuilder::new().flexible(true).trim(csv::Trim::All).from_reader(bytes)
}

fn seconds(picoseconds: i128) -> f64 {
    // The conversion of 64 bits is an instruction of the processor; both round to nearest.
    i64::try_from(picoseconds).map_or(picoseconds as f64, |short| short as f64) / 1e12
}
