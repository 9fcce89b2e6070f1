use std::path::PathBuf;

use crate::defect::Defect;
use crate::index::RunEntry;
use crate::run::Run;
use crate::source::{ReadOptions, RunSource};

/// Recordings in memory.
///
/// # Examples
///
/// ```
/// use reachtube_recordings::{MemoryRuns, ReadOptions, Run, RunSource};
///
/// let mut runs = MemoryRuns::default();
/// let run = Run::new(1, vec![0.0, 0.1], vec![0.0, 1.0, 0.1, 1.0], vec![2.0, 2.0])?;
/// runs.push("first", Some("A"), None, run);
/// assert_eq!(runs.suites()[0].runs, [0]);
/// assert_eq!(runs.read(0, &ReadOptions::default()).unwrap().len(), 2);
/// # Ok::<(), reachtube_recordings::RunError>(())
/// ```
#[derive(Debug, Clone, Default)]
pub struct MemoryRuns {
    entries: Vec<RunEntry>,
    runs: Vec<Run>,
    /// The name of the runs in messages, if it is known.
    name: Option<PathBuf>,
    notes: Vec<String>,
}

impl MemoryRuns {
    /// Returns the runs with a name for messages, such as where they were cut from.
    #[must_use]
    pub fn named(self, name: impl Into<PathBuf>) -> Self {
        Self { name: Some(name.into()), ..self }
    }

    /// Returns the runs with notes for the user, such as what was left out.
    #[must_use]
    pub fn noted(self, notes: Vec<String>) -> Self {
        Self { notes, ..self }
    }

    /// Adds a run under a name, with its suite and the motion that the suite is part of. The run's
    /// SHA-256 becomes the SHA-256 of its numbers.
    ///
    /// Returns the run's entry. The run counts as the latest of its suite unless its `order` is
    /// set there; its `temperature`, and whether it is `simulated`, can be set likewise.
    pub fn push(
        &mut self,
        name: &str,
        suite: Option<&str>,
        motion: Option<&str>,
        run: Run,
    ) -> &mut RunEntry {
        let before = self.entries.iter().filter(|entry| entry.suite.as_deref() == suite);
        let latest = before.map(|entry| entry.order).max().unwrap_or(0);
        self.entries.push(RunEntry {
            file: name.into(),
            suite: suite.map(String::from),
            motion: motion.map(String::from),
            order: latest + 1,
            line: self.entries.len() as u64 + 1,
            ..RunEntry::default()
        });
        self.runs.push(Run { sha256: String::new(), ..run }.with_digest());
        self.entries.last_mut().expect("an entry was added")
    }
}

impl RunSource for MemoryRuns {
    fn index_name(&self) -> PathBuf {
        self.name.clone().unwrap_or_else(|| "runs in memory".into())
    }

    fn runs(&self) -> &[RunEntry] {
        &self.entries
    }

    fn run_name(&self, index: usize) -> PathBuf {
        PathBuf::from(&self.entries[index].file)
    }

    fn notes(&self) -> Vec<String> {
        self.notes.clone()
    }

    fn read(&self, index: usize, options: &ReadOptions) -> Result<Run, Vec<Defect>> {
        self.runs[index].clone().checked(&self.run_name(index), options)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gap_limit::GapLimit;

    fn runs(times: &[f64]) -> MemoryRuns {
        let run = Run::new(1, times.to_vec(), vec![0.5; 2 * times.len()], vec![0.0; times.len()]);
        let mut runs = MemoryRuns::default();
        runs.push("run", Some("A"), Some("circle"), run.unwrap());
        runs
    }

    fn problem(runs: &MemoryRuns, options: &ReadOptions) -> String {
        let defects = runs.read(0, options).unwrap_err();
        assert_eq!(defects.len(), 1);
        defects[0].to_string()
    }

    #[test]
    fn runs_are_read_as_they_were_pushed() {
        let runs = runs(&[2.0, 2.1, 2.2]);
        let run = runs.read(0, &ReadOptions::default()).unwrap();
        assert_eq!((run.len(), run.start, run.sha256.len()), (3, 2.0, 64));
        assert_eq!((runs.index_name(), runs.run_name(0)), ("runs in memory".into(), "run".into()));
        let suite = &runs.suites()[0];
        assert_eq!((suite.name.as_str(), suite.motion.as_deref()), ("A", Some("circle")));
        let until = ReadOptions { until: Some(0.1), ..ReadOptions::default() };
        assert_eq!(runs.read(0, &until).unwrap().torques.len(), 2);
    }

    #[test]
    fn equal_numbers_have_equal_digests() {
        let sha256 = |times: &[f64]| runs(times).runs[0].sha256.clone();
        assert_eq!(sha256(&[0.0, 0.5]), sha256(&[1.0, 1.5]));
        assert_ne!(sha256(&[0.0, 0.5]), sha256(&[0.0, 0.25]));
    }

    #[test]
    fn the_order_and_temperature_of_a_run_can_be_set() {
        let mut runs = runs(&[0.0]);
        let run = || Run::new(1, vec![0.0], vec![0.0; 2], vec![0.0]).unwrap();
        assert_eq!(runs.push("second", Some("A"), None, run()).order, 2);
        let entry = runs.push("ninth", Some("A"), None, run());
        (entry.order, entry.temperature) = (9, Some(31.5));
        runs.push("tenth", Some("A"), None, run());
        runs.push("other", Some("B"), None, run());
        let orders: Vec<u64> = runs.runs().iter().map(|entry| entry.order).collect();
        assert_eq!((orders, runs.runs()[2].temperature), (vec![1, 2, 9, 10, 1], Some(31.5)));
    }

    #[test]
    fn another_number_of_joints_is_a_defect() {
        let options = ReadOptions::of(6);
        let problem = problem(&runs(&[0.0]), &options);
        assert!(problem.contains("1 samples of 1 joints, but the robot has 6"), "{problem}");
    }

    #[test]
    fn a_missing_sample_is_a_defect() {
        let mut times: Vec<f64> = (0..20).map(|k| 0.25 * f64::from(k)).collect();
        times.remove(7);
        let runs = runs(&times);
        let problem = problem(&runs, &ReadOptions::default());
        assert!(problem.contains("a gap of 0.500000 s before sample 7"), "{problem}");
        let gap_limit = GapLimit::Seconds(0.5);
        assert!(runs.read(0, &ReadOptions { gap_limit, ..ReadOptions::default() }).is_ok());
    }
}
