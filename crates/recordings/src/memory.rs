use std::path::PathBuf;

use sha2::{Digest, Sha256};

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
/// # Ok::<(), String>(())
/// ```
#[derive(Debug, Clone, Default)]
pub struct MemoryRuns {
    entries: Vec<RunEntry>,
    runs: Vec<Run>,
}

impl MemoryRuns {
    /// Adds a run under a name, with its suite and the motion that the suite is part of. The run's
    /// SHA-256 becomes that of its numbers.
    pub fn push(&mut self, name: &str, suite: Option<&str>, motion: Option<&str>, mut run: Run) {
        run.sha256 = digest(&run);
        self.entries.push(RunEntry {
            file: name.into(),
            suite: suite.map(String::from),
            motion: motion.map(String::from),
            kind: None,
            temperature: None,
            sha256: None,
            line: self.entries.len() as u64 + 1,
        });
        self.runs.push(run);
    }
}

impl RunSource for MemoryRuns {
    fn index_name(&self) -> PathBuf {
        "runs in memory".into()
    }

    fn runs(&self) -> &[RunEntry] {
        &self.entries
    }

    fn run_name(&self, index: usize) -> PathBuf {
        PathBuf::from(&self.entries[index].file)
    }

    fn read(&self, index: usize, options: &ReadOptions) -> Result<Run, Vec<Defect>> {
        let mut run = self.runs[index].clone();
        let expected = options.joints.unwrap_or(run.joints);
        if run.joints != expected {
            let problem = format!("the run has {} joints, the robot has {expected}", run.joints);
            let remedy = "give the robot of the recordings";
            return Err(vec![Defect::new(self.run_name(index), None, problem, remedy)]);
        }
        run.truncate(options.until);
        Ok(run)
    }
}

/// Returns the SHA-256 of a run's numbers, in lower-case hexadecimal.
fn digest(run: &Run) -> String {
    let mut digest = Sha256::new();
    for value in run.times.iter().chain(&run.states).chain(&run.torques) {
        digest.update(value.to_le_bytes());
    }
    reachtube_files::hex(&digest.finalize())
}
