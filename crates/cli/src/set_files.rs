//! The files of reachable sets.

use std::path::{Path, PathBuf};

use reachtube::conform::SuiteReach;

use crate::file_names;

/// The reachable set of a suite, run or plan, and the files that hold it.
pub(crate) struct Written<'a> {
    pub reach: &'a SuiteReach,
    /// The set at samples.
    pub samples: PathBuf,
    /// The set over each step.
    pub tube: PathBuf,
}

impl<'a> Written<'a> {
    /// Returns the files of some sets in a folder.
    pub(crate) fn all(reach: &'a [SuiteReach], out: &Path) -> Vec<Self> {
        let file = |(reach, name): (&'a SuiteReach, String)| Self {
            reach,
            samples: out.join(format!("{name}.csv")),
            tube: out.join(format!("{name}_tube.csv")),
        };
        reach.iter().zip(file_names::of_reach(reach)).map(file).collect()
    }

    /// Returns the names of the two CSV files with their contents.
    pub(crate) fn contents(&self) -> [(String, Vec<u8>); 2] {
        let name =
            |path: &Path| path.file_name().expect("it was joined").to_string_lossy().into_owned();
        let (mut samples, mut tube) = (Vec::new(), Vec::new());
        let in_memory = "memory takes all that is written";
        self.reach.write_samples(&mut samples).expect(in_memory);
        self.reach.write_tube(&mut tube).expect(in_memory);
        [(name(&self.samples), samples), (name(&self.tube), tube)]
    }
}
