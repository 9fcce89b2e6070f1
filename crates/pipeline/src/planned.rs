//! A planned motion as a single file.

use std::path::{Path, PathBuf};

use reachtube_recordings::{Defect, ReadOptions, Run, RunEntry, RunSource, read_csv};

/// A motion in one CSV file with the columns of a recording: a planned one has the planned states
/// and the feed-forward torque. Its suite has the name of the file.
#[derive(Debug)]
pub(crate) struct Planned {
    path: PathBuf,
    runs: [RunEntry; 1],
}

impl Planned {
    pub(crate) fn of(path: &Path) -> Self {
        let name = path.file_stem().map(|stem| stem.to_string_lossy().into_owned());
        let entry = RunEntry {
            file: path.display().to_string(),
            suite: name,
            order: 1,
            line: 1,
            ..RunEntry::default()
        };
        Self { path: path.into(), runs: [entry] }
    }
}

impl RunSource for Planned {
    fn index_name(&self) -> PathBuf {
        self.path.clone()
    }

    fn runs(&self) -> &[RunEntry] {
        &self.runs
    }

    fn run_name(&self, _index: usize) -> PathBuf {
        self.path.clone()
    }

    fn read(&self, _index: usize, options: &ReadOptions) -> Result<Run, Vec<Defect>> {
        read_csv(&self.path, options)
    }
}
