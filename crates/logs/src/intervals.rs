//! Runs by a list of intervals of time.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use reachtube_recordings::picoseconds;
use serde::Deserialize;

use crate::cut::Cut;
use crate::error::{Error, Result};
use crate::log::Log;

const REMEDY: &str = "the list of intervals needs a header with the columns start,end in s from \
                      the log's start, or start_stamp,end_stamp in s as the stamps, and may have \
                      suite, motion and log";

/// A list of intervals of time, each with its suite.
#[derive(Debug, Clone)]
pub struct Intervals {
    path: PathBuf,
    rows: Vec<RunInterval>,
}

/// An interval, both ends included.
#[derive(Debug, Clone)]
struct RunInterval {
    line: u64,
    /// Start and end, ps; without an end, it lasts until the log ends.
    start: i128,
    end: Option<i128>,
    /// Whether times count from the log's start.
    relative: bool,
    suite: Option<String>,
    motion: Option<String>,
    /// Name of the log's file, where the interval is of one log.
    log: Option<String>,
}

#[derive(Deserialize)]
struct IntervalRow {
    start: Option<String>,
    end: Option<String>,
    start_stamp: Option<String>,
    end_stamp: Option<String>,
    suite: Option<String>,
    motion: Option<String>,
    log: Option<String>,
}

impl Intervals {
    /// Reads a list: CSV with the columns `start` and `end`, s from the log's first sample, or
    /// `start_stamp` and `end_stamp`, s as the stamps. An empty end is the end of the log. The
    /// columns `suite`, `motion` and `log` (name of the file) may be there.
    ///
    /// # Errors
    ///
    /// [`Error::File`] where it cannot be read, and [`Error::Intervals`] for a wrong line.
    pub fn read(path: &Path) -> Result<Self> {
        let text = reachtube_files::read_text(path, REMEDY)?;
        let text = text.strip_prefix('\u{feff}').unwrap_or(&text);
        let wrong = |line, problem| Error::Intervals { path: path.into(), line, problem };
        let mut reader =
            csv::ReaderBuilder::new().trim(csv::Trim::All).from_reader(text.as_bytes());
        let header = reader.headers().map_err(|error| wrong(1, error.to_string()))?.clone();
        let has = |name: &str| header.iter().any(|column| column == name);
        if has("start") == has("start_stamp") {
            return Err(wrong(1, format!("{} is no header of it; {REMEDY}", quoted(&header))));
        }
        let mut rows = vec![];
        for record in reader.records() {
            let line = |error: &csv::Error| error.position().map_or(1, csv::Position::line);
            let record = record.map_err(|error| wrong(line(&error), error.to_string()))?;
            let line = record.position().map_or(1, csv::Position::line);
            let row = record.deserialize::<IntervalRow>(Some(&header));
            let row = row.map_err(|error| wrong(line, error.to_string()))?;
            rows.push(RunInterval::of(row, line).map_err(|problem| wrong(line, problem))?);
        }
        if rows.is_empty() {
            return Err(wrong(1, "no interval is listed; add one per line".into()));
        }
        let intervals = Self { path: path.into(), rows };
        intervals.check_motions()?;
        Ok(intervals)
    }

    /// Checks that a suite is part of one motion.
    fn check_motions(&self) -> Result<()> {
        let mut motions: BTreeMap<&str, (&Option<String>, u64)> = BTreeMap::new();
        for row in &self.rows {
            let Some(suite) = &row.suite else { continue };
            let (motion, line) = *motions.entry(suite).or_insert((&row.motion, row.line));
            if *motion != row.motion {
                let problem = format!(
                    "suite {suite} has another motion than on line {line}; a suite is part of one \
                     motion"
                );
                return Err(self.wrong(row.line, problem));
            }
        }
        Ok(())
    }

    fn wrong(&self, line: u64, problem: String) -> Error {
        Error::Intervals { path: self.path.clone(), line, problem }
    }

    /// Returns the runs in the logs, in the order of the list.
    ///
    /// # Errors
    ///
    /// [`Error::Intervals`] for an interval that is in no log, holds no sample, or ends after its
    /// log.
    pub fn runs(&self, logs: &[Log]) -> Result<Vec<Cut>> {
        let mut cuts = vec![];
        for row in &self.rows {
            let before = cuts.len();
            for (number, log) in logs.iter().enumerate() {
                if row.is_of(log) {
                    cuts.extend(self.run(row, number, log)?);
                }
            }
            if cuts.len() == before {
                let problem = "the interval is in no log; compare its times and its log with \
                               those printed";
                return Err(self.wrong(row.line, problem.into()));
            }
        }
        Ok(cuts)
    }

    /// Returns the run of an interval in a log.
    fn run(&self, row: &RunInterval, number: usize, log: &Log) -> Result<Option<Cut>> {
        let [Some(first), Some(last)] = [log.samples.first(), log.samples.last()] else {
            return Ok(None);
        };
        let time = |nanoseconds: i64| {
            let zero = if row.relative { i128::from(first.time) } else { 0 };
            1000 * (i128::from(nanoseconds) - zero)
        };
        // A stamp alone determines its log.
        if !row.relative && !(time(first.time)..=time(last.time)).contains(&row.start) {
            return Ok(None);
        }
        let (start, end) = (row.start, row.end.unwrap_or(time(last.time)));
        if end > time(last.time) || start > time(last.time) {
            let (late, at) = (start.max(end), time(last.time));
            let problem = format!(
                "the interval reaches {} s, but the last sample of {} is at {} s",
                late as f64 / 1e12,
                log.path.display(),
                at as f64 / 1e12
            );
            return Err(self.wrong(row.line, problem + "; shorten the interval"));
        }
        let inside = |index: &usize| (start..=end).contains(&time(log.samples[*index].time));
        let mut indices = (0..log.len()).filter(inside);
        let samples = match (indices.next(), indices.next_back()) {
            (Some(first), last) => first..last.unwrap_or(first) + 1,
            (None, _) => {
                let problem = format!("no sample of {} is in the interval", log.path.display());
                return Err(self.wrong(row.line, problem + "; make it longer"));
            }
        };
        let (suite, motion) = (row.suite.clone(), row.motion.clone());
        Ok(Some(Cut { log: number, samples, suite, motion }))
    }
}

impl RunInterval {
    fn of(row: IntervalRow, line: u64) -> Result<Self, String> {
        let filled = |text: Option<String>| text.filter(|text| !text.is_empty());
        let relative = row.start.is_some();
        let (start, end) =
            if relative { (row.start, row.end) } else { (row.start_stamp, row.end_stamp) };
        let time = |text: &String| {
            picoseconds(text).ok_or_else(|| format!("\"{text}\" is not a number of seconds"))
        };
        let start = time(&start.unwrap_or_default())?;
        let end = filled(end).as_ref().map(time).transpose()?;
        if end.is_some_and(|end| end <= start) {
            return Err("the interval ends before it starts; give start and end in s".into());
        }
        let [suite, motion, log] = [row.suite, row.motion, row.log].map(filled);
        Ok(Self { line, start, end, relative, suite, motion, log })
    }

    fn is_of(&self, log: &Log) -> bool {
        let name = log.path.file_name().map(|name| name.to_string_lossy());
        self.log.as_ref().is_none_or(|wanted| name.is_some_and(|name| name == wanted.as_str()))
    }
}

fn quoted(header: &csv::StringRecord) -> String {
    format!("{:?}", header.iter().collect::<Vec<_>>().join(","))
}
