use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use super::index::read_index;
use super::{Defect, GapLimit, Run, RunEntry};
use crate::error::{Error, Result};

/// A folder of recordings: what its index `runs.csv` says.
#[derive(Debug, Clone)]
pub struct DataSet {
    root: PathBuf,
    runs: Vec<RunEntry>,
    /// CSV files in the folder that the index does not name.
    unlisted: Vec<PathBuf>,
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

impl DataSet {
    /// Reads the index of the folder `root`. The runs themselves are read one by one, when they are
    /// used.
    ///
    /// # Errors
    ///
    /// [`Error::File`] when there is no index, [`Error::Defects`] for a missing column, a file that
    /// is named twice or not there.
    pub fn open(root: impl Into<PathBuf>) -> Result<Self> {
        let root = root.into();
        let index = root.join("runs.csv");
        let remedy = "give the folder that holds the recordings and their index runs.csv, a line a recording with its file and suite";
        let bytes = reachtube_files::read(&index, remedy)?;
        let runs = read_index(&root, &index, &bytes).map_err(Error::Defects)?;
        let listed: BTreeSet<PathBuf> = runs.iter().map(|run| root.join(&run.file)).collect();
        let unlisted = csv_files(&root)
            .into_iter()
            .filter(|path| *path != index && !listed.contains(path))
            .collect();
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

    /// All test suites, in the order in which the index first names them.
    pub fn suites(&self) -> Vec<SuiteEntry> {
        let mut suites: Vec<SuiteEntry> = Vec::new();
        for (index, run) in self.runs.iter().enumerate() {
            let Some(name) = &run.suite else { continue };
            match suites.iter_mut().find(|suite| suite.name == *name) {
                Some(suite) => {
                    suite.runs.push(index);
                    suite.motion = suite.motion.take().or_else(|| run.motion.clone());
                }
                None => suites.push(SuiteEntry {
                    name: name.clone(),
                    motion: run.motion.clone(),
                    runs: vec![index],
                }),
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
            return Err(Error::RepeatedSuite { names: names.to_vec() });
        }
        let find = |name: &String| {
            suites.iter().find(|suite| suite.name == *name).cloned().ok_or_else(|| unknown(name))
        };
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
