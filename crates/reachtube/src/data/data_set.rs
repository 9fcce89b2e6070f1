use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use serde::Deserialize;

use super::{Defect, GapLimit, Run};
use crate::error::{Error, Result};

/// A folder of recordings: what its index `runs.csv` says.
#[derive(Debug, Clone)]
pub struct DataSet {
    root: PathBuf,
    runs: Vec<RunEntry>,
    /// CSV files in the folder that the index does not name.
    unlisted: Vec<PathBuf>,
}

/// One line of `runs.csv`.
#[derive(Debug, Clone, PartialEq)]
pub struct RunEntry {
    /// Path in the folder, as written.
    pub file: String,
    /// The test suite, if it belongs to one.
    pub suite: Option<String>,
    /// The motion that the suite is part of; suites of one motion are not independent.
    pub motion: Option<String>,
    /// What kind of recording it is, as written.
    pub kind: Option<String>,
    /// Temperature in °C, where recorded.
    pub temperature: Option<f64>,
    /// SHA-256 the file should have.
    pub sha256: Option<String>,
    /// Line in `runs.csv`, from 1.
    pub line: u64,
}

impl RunEntry {
    /// What a user should know when the file is not the one that was listed.
    pub(crate) fn changed_note(&self, sha256: &str) -> Option<String> {
        let listed = self.sha256.as_ref()?;
        (!listed.eq_ignore_ascii_case(sha256)).then(|| {
            let (file, line) = (&self.file, self.line);
            format!("{file}: its SHA-256 is not the one in runs.csv (line {line}): it was changed after it was listed")
        })
    }
}

/// A test suite: its name and the indices of its runs, in the order of the index.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SuiteEntry {
    /// Its name.
    pub name: String,
    /// The motion it is part of, where the index says so.
    pub motion: Option<String>,
    /// Indices into [`DataSet::runs`].
    pub runs: Vec<usize>,
}

#[derive(Deserialize)]
struct IndexRow {
    file: String,
    suite: Option<String>,
    motion: Option<String>,
    kind: Option<String>,
    temperature: Option<f64>,
    sha256: Option<String>,
}

impl DataSet {
    /// Reads the index of the folder `root`. The runs themselves are read one by one, when they are used.
    ///
    /// # Errors
    ///
    /// [`Error::Read`] when there is no index, [`Error::Defects`] for a missing column, a file that is named twice or not there.
    pub fn open(root: impl Into<PathBuf>) -> Result<Self> {
        let root = root.into();
        let index = root.join("runs.csv");
        let bytes = std::fs::read(&index).map_err(|source| Error::Read { path: index.clone(), source })?;
        let (runs, mut defects) = read_index(&index, &bytes);
        defects.extend(missing_or_repeated(&root, &index, &runs));
        if !defects.is_empty() {
            return Err(Error::Defects(defects));
        }
        let listed: BTreeSet<PathBuf> = runs.iter().map(|run| root.join(&run.file)).collect();
        let unlisted = csv_files(&root).into_iter().filter(|path| *path != index && !listed.contains(path)).collect();
        Ok(Self { root, runs, unlisted })
    }

    /// The folder.
    pub fn root(&self) -> &Path {
        &self.root
    }

    /// All runs of the index.
    pub fn runs(&self) -> &[RunEntry] {
        &self.runs
    }

    /// CSV files in the folder that the index does not name.
    pub fn unlisted(&self) -> &[PathBuf] {
        &self.unlisted
    }

    /// What a user should know about files that the index leaves out.
    pub(crate) fn unlisted_note(&self) -> Option<String> {
        let first = self.unlisted.first()?;
        let (count, root) = (self.unlisted.len(), self.root.display());
        Some(format!("{count} CSV files in {root} are not in runs.csv and are not used, {} the first", first.display()))
    }

    /// All test suites, in the order in which the index first names them.
    pub fn suites(&self) -> Vec<SuiteEntry> {
        let mut suites: Vec<SuiteEntry> = Vec::new();
        for (index, run) in self.runs.iter().enumerate() {
            let Some(name) = &run.suite else { continue };
            match suites.iter_mut().find(|suite| suite.name == *name) {
                Some(suite) => suite.runs.push(index),
                None => suites.push(SuiteEntry { name: name.clone(), motion: run.motion.clone(), runs: vec![index] }),
            }
        }
        suites
    }

    /// The suites named, in that order; all of them when none is named.
    ///
    /// # Errors
    ///
    /// [`Error::UnknownSuite`] when there is no such suite, or none at all.
    pub fn select(&self, names: &[String]) -> Result<Vec<SuiteEntry>> {
        let suites = self.suites();
        let unknown = |name: &str| Error::UnknownSuite {
            index: self.root.join("runs.csv"),
            name: name.into(),
            available: suites.iter().map(|suite| suite.name.clone()).collect(),
        };
        if names.is_empty() {
            return if suites.is_empty() { Err(unknown("")) } else { Ok(suites) };
        }
        let distinct: BTreeSet<&String> = names.iter().collect();
        if distinct.len() < names.len() {
            return Err(Error::Setting(format!("a suite is named twice in {}; name each once", names.join(","))));
        }
        let find = |name: &String| suites.iter().find(|suite| suite.name == *name).cloned().ok_or_else(|| unknown(name));
        names.iter().map(find).collect()
    }

    /// Where run `index` is.
    pub fn path(&self, index: usize) -> PathBuf {
        self.root.join(&self.runs[index].file)
    }

    /// Reads run `index`.
    ///
    /// # Errors
    ///
    /// Every defect of the file.
    pub fn read(
        &self,
        index: usize,
        joints: Option<usize>,
        gap_limit: GapLimit,
        until: Option<f64>,
    ) -> Result<Run, Vec<Defect>> {
        Run::read(&self.path(index), joints, gap_limit, until)
    }
}

fn read_index(index: &Path, bytes: &[u8]) -> (Vec<RunEntry>, Vec<Defect>) {
    let remedy = "runs.csv has a header with at least file and suite, then one line a run";
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let mut reader = csv::ReaderBuilder::new().trim(csv::Trim::All).from_reader(bytes);
    let (mut runs, mut defects) = (Vec::new(), Vec::new());
    let header: Vec<String> =
        reader.headers().map(|header| header.iter().map(String::from).collect()).unwrap_or_default();
    for column in ["file", "suite"] {
        if !header.iter().any(|name| name == column) {
            defects.push(Defect::new(index, Some(1), format!("no column \"{column}\""), remedy));
        }
    }
    if !defects.is_empty() {
        return (runs, defects);
    }
    for (row, result) in reader.deserialize::<IndexRow>().enumerate() {
        let line = row as u64 + 2;
        match result {
            Ok(row) => runs.push(row.entry(line)),
            Err(error) => {
                let line = error.position().map_or(line, |position| position.line());
                defects.push(Defect::new(index, Some(line), error.to_string(), remedy));
            }
        }
    }
    if runs.is_empty() && defects.is_empty() {
        defects.push(Defect::new(index, None, "no run is listed", remedy));
    }
    (runs, defects)
}

impl IndexRow {
    fn entry(self, line: u64) -> RunEntry {
        let filled = |text: Option<String>| text.filter(|text| !text.is_empty());
        RunEntry {
            file: self.file,
            suite: filled(self.suite),
            motion: filled(self.motion),
            kind: filled(self.kind),
            temperature: self.temperature,
            sha256: filled(self.sha256),
            line,
        }
    }
}

fn missing_or_repeated(root: &Path, index: &Path, runs: &[RunEntry]) -> Vec<Defect> {
    let mut first: BTreeMap<&str, u64> = BTreeMap::new();
    let mut defects = Vec::new();
    for run in runs {
        if let Some(line) = first.insert(&run.file, run.line) {
            let problem = format!("\"{}\" is listed on line {line} already", run.file);
            defects.push(Defect::new(index, Some(run.line), problem, "list each run once"));
        } else if !root.join(&run.file).is_file() {
            let problem = format!("\"{}\" is not a file in {}", run.file, root.display());
            defects.push(Defect::new(index, Some(run.line), problem, "add the recording or take the line out"));
        }
    }
    defects
}

fn csv_files(folder: &Path) -> Vec<PathBuf> {
    let Ok(entries) = std::fs::read_dir(folder) else { return Vec::new() };
    let mut files: Vec<PathBuf> = entries
        .flatten()
        .flat_map(|entry| {
            let path = entry.path();
            match entry.file_type() {
                Ok(kind) if kind.is_dir() => csv_files(&path),
                Ok(_) if path.extension().is_some_and(|extension| extension == "csv") => vec![path],
                _ => Vec::new(),
            }
        })
        .collect();
    files.sort();
    files
}
