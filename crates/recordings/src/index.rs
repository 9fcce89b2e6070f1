//! The index of a data set, `runs.csv`.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use serde::de::Error as _;
use serde::{Deserialize, Deserializer};

use crate::defect::Defect;
use crate::order::{WrittenOrder, orders};
use crate::text::{line_of, quoted};

const REMEDY: &str =
    "runs.csv needs a header with at least the columns file and suite, then one line per run";

/// An entry of the index: one run, and one line of `runs.csv`.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct RunEntry {
    /// Path in the folder as written, or the name of a run in memory.
    pub file: String,
    /// The test suite, where the run belongs to one.
    pub suite: Option<String>,
    /// The motion that the suite is part of; suites of one motion are not independent.
    pub motion: Option<String>,
    /// Kind of the recording, as written.
    pub kind: Option<String>,
    /// Temperature in °C, if recorded.
    pub temperature: Option<f64>,
    /// SHA-256 that the file should have, in hexadecimal.
    pub sha256: Option<String>,
    /// Whether the recording is marked as simulated, and not measured.
    pub simulated: bool,
    /// Standard deviations of the sensors' noise in each state that the recording has left, 2n, rad
    /// and rad/s; where they were measured before a filter, which takes away what shows them.
    pub noise: Option<Vec<f64>>,
    /// SHA-256 of the log that the run was cut from, if it was cut from one.
    pub origin: Option<String>,
    /// Whether the robot rests in the log that the run was cut from.
    pub at_rest: bool,
    /// Whether its motion is one of the parts of a single motion.
    pub is_part: bool,
    /// Place in the order in which the runs of the suite were recorded, from 1.
    pub order: u64,
    /// Line in `runs.csv`, or number of a run in memory, from 1.
    pub line: u64,
}

#[derive(Deserialize)]
struct IndexRow {
    file: String,
    suite: Option<String>,
    motion: Option<String>,
    kind: Option<String>,
    temperature: Option<f64>,
    sha256: Option<String>,
    simulated: Option<bool>,
    #[serde(default, deserialize_with = "noise")]
    noise: Option<Vec<f64>>,
    origin: Option<String>,
    order: Option<String>,
    repeat: Option<String>,
}

/// Reads numbers between spaces, of which none is below 0.
fn noise<'de, D: Deserializer<'de>>(field: D) -> Result<Option<Vec<f64>>, D::Error> {
    let text = Option::<String>::deserialize(field)?.unwrap_or_default();
    let number = |word: &str| match word.parse::<f64>() {
        Ok(number) if number >= 0.0 && number.is_finite() => Ok(number),
        _ => Err(D::Error::custom(format!("{word:?} is no number of at least 0"))),
    };
    let numbers: Vec<f64> = text.split_whitespace().map(number).collect::<Result<_, _>>()?;
    Ok((!numbers.is_empty()).then_some(numbers))
}

impl IndexRow {
    fn entry(self, line: u64, order: u64) -> RunEntry {
        let filled = |text: Option<String>| text.filter(|text| !text.is_empty());
        RunEntry {
            file: self.file,
            suite: filled(self.suite),
            motion: filled(self.motion),
            kind: filled(self.kind),
            temperature: self.temperature,
            sha256: filled(self.sha256),
            simulated: self.simulated.unwrap_or(false),
            noise: self.noise,
            origin: filled(self.origin),
            order,
            line,
            ..RunEntry::default()
        }
    }
}

/// Reads the runs listed in `bytes`, the content of the file `index` in the folder `root`.
///
/// # Errors
///
/// Every defect of the index, with its line.
pub(crate) fn read_index(
    root: &Path,
    index: &Path,
    bytes: &[u8],
) -> Result<Vec<RunEntry>, Vec<Defect>> {
    let (rows, mut defects) = parse(index, bytes);
    let (runs, found) = ordered(index, rows);
    defects.extend(found);
    defects.extend(missing_or_repeated(root, index, &runs));
    defects.extend(two_motions(index, &runs));
    if defects.is_empty() { Ok(runs) } else { Err(defects) }
}

/// Returns the entries of these lines in the order of the file, with the defects of their order.
fn ordered(index: &Path, rows: Vec<(u64, IndexRow)>) -> (Vec<RunEntry>, Vec<Defect>) {
    fn filled(text: &Option<String>) -> Option<&str> {
        text.as_deref().filter(|text| !text.is_empty())
    }
    let written = rows.iter().map(|(line, row)| WrittenOrder {
        group: (filled(&row.suite), filled(&row.kind).filter(|_| filled(&row.suite).is_none())),
        line: *line,
        order: filled(&row.order),
        repeat: filled(&row.repeat),
    });
    let (orders, defects) = match orders(index, &written.collect::<Vec<_>>()) {
        Ok(orders) => (orders, vec![]),
        Err(defects) => (vec![1; rows.len()], defects),
    };
    let entry = |((line, row), order): ((u64, IndexRow), u64)| row.entry(line, order);
    (rows.into_iter().zip(orders).map(entry).collect(), defects)
}

/// Returns the lines with their numbers, and the defects of the lines.
fn parse(index: &Path, bytes: &[u8]) -> (Vec<(u64, IndexRow)>, Vec<Defect>) {
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let mut reader =
        csv::ReaderBuilder::new().flexible(true).trim(csv::Trim::All).from_reader(bytes);
    let defect = |line, problem: String| Defect::new(index, line, problem, REMEDY);
    let header = match reader.headers() {
        Ok(header) => header.clone(),
        Err(_) => return (vec![], vec![defect(Some(1), "the header is not UTF-8 text".into())]),
    };
    let absent = |column: &&str| !header.iter().any(|name| name == *column);
    let mut defects: Vec<Defect> = ["file", "suite"]
        .into_iter()
        .filter(absent)
        .map(|column| {
            let found = header.iter().collect::<Vec<_>>().join(",");
            let found = quoted(&found);
            defect(Some(1), format!("there is no column \"{column}\" in the header {found}"))
        })
        .collect();
    if !defects.is_empty() {
        return (vec![], defects);
    }
    let mut runs = Vec::new();
    let mut record = csv::StringRecord::new();
    loop {
        let read = reader.read_record(&mut record);
        let at = line_of(bytes, record.position());
        let line = Some(at);
        match read {
            Ok(false) => break,
            Ok(true) if record.len() != header.len() => {
                let (found, expected) = (record.len(), header.len());
                let problem = format!("the line has {found} fields, but the header has {expected}");
                defects.push(defect(line, problem));
            }
            Ok(true) => match record.deserialize::<IndexRow>(Some(&header)) {
                Ok(row) => runs.push((at, row)),
                Err(error) => defects.push(defect(line, line_problem(&error, &header))),
            },
            Err(error) => {
                let line = Some(line_of(bytes, error.position()));
                defects.push(defect(line, line_problem(&error, &header)));
            }
        }
    }
    if runs.is_empty() && defects.is_empty() {
        defects.push(defect(None, "no run is listed".into()));
    }
    (runs, defects)
}

/// Returns the problem of a line that cannot be read.
fn line_problem(error: &csv::Error, header: &csv::StringRecord) -> String {
    match error.kind() {
        csv::ErrorKind::Utf8 { .. } => "the line is not UTF-8 text".into(),
        csv::ErrorKind::Deserialize { err, .. } => {
            let column =
                err.field().and_then(|field| header.get(field as usize)).unwrap_or("a field");
            format!("{column}: {}", err.kind())
        }
        _ => error.to_string(),
    }
}

/// Returns a defect for each run whose file does not exist or is listed before.
fn missing_or_repeated(root: &Path, index: &Path, runs: &[RunEntry]) -> Vec<Defect> {
    let mut first: BTreeMap<PathBuf, u64> = BTreeMap::new();
    let mut defects = Vec::new();
    for run in runs {
        let path = root.join(&run.file);
        if !path.is_file() {
            let problem = format!("\"{}\" is not a file in {}", run.file, root.display());
            let remedy = "add the recording, or take the line out";
            defects.push(Defect::new(index, Some(run.line), problem, remedy));
        } else if let Some(line) = first.insert(path, run.line) {
            let problem = format!("\"{}\" is listed on line {line} already", run.file);
            defects.push(Defect::new(index, Some(run.line), problem, "list each run once"));
        }
    }
    defects
}

/// Returns a defect for each run whose suite has another motion before.
fn two_motions(index: &Path, runs: &[RunEntry]) -> Vec<Defect> {
    let mut first: BTreeMap<&str, (&str, u64)> = BTreeMap::new();
    let mut defects = Vec::new();
    for run in runs {
        let (Some(suite), Some(motion)) = (&run.suite, &run.motion) else { continue };
        let (known, line) = *first.entry(suite).or_insert((motion, run.line));
        if known != motion {
            let problem = format!(
                "suite {suite} has the motion {motion:?} here and {known:?} on line {line}"
            );
            let remedy =
                "a suite is part of one motion: correct one of the lines, or split the suite";
            defects.push(Defect::new(index, Some(run.line), problem, remedy));
        }
    }
    defects
}
