use std::collections::BTreeSet;
use std::fmt;
use std::path::PathBuf;

use crate::defect::Defect;
use crate::error::{Error, Result};
use crate::gap_limit::GapLimit;
use crate::index::RunEntry;
use crate::pattern::matching;
use crate::run::Run;

/// A test suite: its name and the indices of its runs, in the order of the source.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SuiteEntry {
    /// The suite's name.
    pub name: String,
    /// The motion that the suite is part of, where the source names it.
    pub motion: Option<String>,
    /// Indices into [`RunSource::runs`].
    pub runs: Vec<usize>,
}

/// Options for reading a recording.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct ReadOptions {
    /// Number of joints that the recording must have; any number where it is `None`.
    pub joints: Option<usize>,
    /// Longest time between two samples that is accepted.
    pub gap_limit: GapLimit,
    /// Time after the first sample, s, beyond which samples are not used.
    pub until: Option<f64>,
}

impl ReadOptions {
    /// Returns the options for recordings of `joints` joints, without other limits.
    #[must_use]
    pub fn of(joints: usize) -> Self {
        Self { joints: Some(joints), ..Self::default() }
    }
}

/// A source of recordings: a folder with an index ([`DataSet`](crate::DataSet)), or runs in memory
/// ([`MemoryRuns`](crate::MemoryRuns)).
///
/// A source lists its runs at once and reads the samples of a run when they are requested.
///
/// # Examples
///
/// ```
/// use reachtube_recordings::{MemoryRuns, Run, RunSource};
///
/// let mut source = MemoryRuns::default();
/// for (name, suite) in [("first", "A"), ("second", "B"), ("third", "A")] {
///     let run = Run::new(1, vec![0.0], vec![0.0; 2], vec![0.0])?;
///     source.push(name, Some(suite), None, run);
/// }
/// let chosen = source.select(&["A".into()]).unwrap();
/// assert_eq!(chosen[0].runs, [0, 2]);
/// # Ok::<(), reachtube_recordings::RunError>(())
/// ```
pub trait RunSource: fmt::Debug + Send + Sync {
    /// Returns the name of the list of runs for messages, such as the path of an index.
    fn index_name(&self) -> PathBuf;

    /// Returns all runs, in the order in which they were recorded.
    fn runs(&self) -> &[RunEntry];

    /// Returns the name of run `index` for messages, such as the path of its file.
    ///
    /// # Panics
    ///
    /// Panics if there is no run `index`.
    fn run_name(&self, index: usize) -> PathBuf;

    /// Reads run `index`.
    ///
    /// # Errors
    ///
    /// Every defect of the recording, with line and joint.
    ///
    /// # Panics
    ///
    /// Panics if there is no run `index`.
    fn read(&self, index: usize, options: &ReadOptions) -> Result<Run, Vec<Defect>>;

    /// Returns notes about where recordings are: stored with the listed ones but not used, or
    /// outside the folder.
    fn notes(&self) -> Vec<String> {
        vec![]
    }

    /// Returns all test suites, in the order in which the source first names them.
    fn suites(&self) -> Vec<SuiteEntry> {
        let mut suites: Vec<SuiteEntry> = Vec::new();
        for (index, run) in self.runs().iter().enumerate() {
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

    /// Returns the suites whose names or [patterns](matching) are given, in the order of `names`,
    /// and all suites when `names` is empty.
    ///
    /// # Errors
    ///
    /// [`Error::UnknownSuite`] when a name or pattern selects no suite or there is none at all, and
    /// [`Error::RepeatedSuite`] when a name is given more than once.
    fn select(&self, names: &[String]) -> Result<Vec<SuiteEntry>> {
        let suites = self.suites();
        let unknown = |name: &str| Error::UnknownSuite {
            index: self.index_name(),
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
        let mut selected: Vec<SuiteEntry> = Vec::new();
        for name in names {
            let matched = matching(name, suites.iter().map(|suite| suite.name.as_str()));
            if matched.is_empty() {
                return Err(unknown(name));
            }
            let is_new = |suite: &&SuiteEntry| {
                matched.contains(&suite.name.as_str())
                    && selected.iter().all(|own| own.name != suite.name)
            };
            let new: Vec<SuiteEntry> = suites.iter().filter(is_new).cloned().collect();
            selected.extend(new);
        }
        Ok(selected)
    }
}

#[cfg(test)]
mod tests {
    use super::{Error, RunSource};
    use crate::memory::MemoryRuns;
    use crate::run::Run;

    fn source(suites: &[(Option<&str>, Option<&str>)]) -> MemoryRuns {
        let mut source = MemoryRuns::default();
        for (suite, motion) in suites {
            let run = Run::new(1, vec![0.0], vec![0.0; 2], vec![0.0]).unwrap();
            source.push("run", *suite, *motion, run);
        }
        source
    }

    fn names(list: &[&str]) -> Vec<String> {
        list.iter().map(|name| (*name).into()).collect()
    }

    const THREE: [(Option<&str>, Option<&str>); 4] =
        [(Some("B"), None), (Some("A"), Some("m")), (None, None), (Some("B"), Some("m"))];

    #[test]
    fn suites_come_in_the_order_of_their_first_runs() {
        let suites = source(&THREE).suites();
        let found: Vec<_> = suites.iter().map(|s| (s.name.as_str(), &s.runs[..])).collect();
        assert_eq!(found, [("B", &[0, 3][..]), ("A", &[1][..])]);
        assert!(suites.iter().all(|suite| suite.motion.as_deref() == Some("m")));
    }

    #[test]
    fn suites_are_selected_in_the_order_asked_for() {
        let source = source(&THREE);
        let selected = |list: &[&str]| {
            let suites = source.select(&names(list)).unwrap();
            suites.into_iter().map(|suite| suite.name).collect::<Vec<_>>()
        };
        assert_eq!(selected(&[]), ["B", "A"]);
        assert_eq!(selected(&["A", "B"]), ["A", "B"]);
        assert_eq!(selected(&["A"]), ["A"]);
        assert_eq!(selected(&["?"]), ["B", "A"]);
        assert_eq!(selected(&["A", "*"]), ["A", "B"]);
    }

    #[test]
    fn unknown_repeated_and_missing_suites_are_errors() {
        let error = |suites: &[_], list: &[&str]| source(suites).select(&names(list)).unwrap_err();
        let unknown = error(&THREE, &["A", "C"]);
        assert!(matches!(&unknown, Error::UnknownSuite { name, .. } if name == "C"));
        let text = unknown.to_string();
        assert_eq!(text, "runs in memory: there is no suite \"C\"; the data set has B, A");
        let unmatched = error(&THREE, &["A", "C*"]).to_string();
        assert!(unmatched.contains("no suite \"C*\"; the data set has B, A"), "{unmatched}");
        let windows: Vec<String> = (10..40).map(|k| format!("R1_w{k}")).collect();
        let windows: Vec<_> = windows.iter().map(|name| (Some(name.as_str()), None)).collect();
        let source = source(&windows).named("windows of logs");
        let many = source.select(&names(&["R1"])).unwrap_err().to_string();
        let start = "windows of logs: there is no suite \"R1\"; the data set has R1_w10, R1_w11, ";
        assert!(many.starts_with(start), "{many}");
        let end = "R1_w29, .. (30 suites); \"R1*\" selects 30 of them";
        assert!(many.ends_with(end), "{many}");
        assert!(matches!(error(&THREE, &["A", "A"]), Error::RepeatedSuite { .. }));
        let none = error(&THREE[2..3], &[]).to_string();
        assert!(none.contains("no run has a suite"), "{none}");
    }
}
