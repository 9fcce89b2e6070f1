use std::collections::BTreeMap;

use reachtube_recordings::Defect;
use serde::{Deserialize, Serialize};

/// Number of recordings whose defects are kept; the others are counted.
const MOST_RECORDINGS: usize = 1000;

/// Number of defects that are kept of one recording.
const MOST_OF_ONE: usize = 20;

/// The defects of recordings that are left out, by their place in the manifest.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub(super) struct Defects {
    /// Number of recordings with defects.
    pub recordings: u64,
    of: BTreeMap<u32, Vec<Defect>>,
}

impl Defects {
    pub(super) fn take(&mut self, place: u32, mut defects: Vec<Defect>) {
        defects.truncate(MOST_OF_ONE);
        for defect in &mut defects {
            // A path that is no Unicode could not be stored.
            defect.file = defect.file.to_string_lossy().into_owned().into();
        }
        self.merge(Self { recordings: 1, of: [(place, defects)].into() });
    }

    pub(super) fn merge(&mut self, other: Self) {
        self.recordings += other.recordings;
        self.of.extend(other.of);
        while self.of.len() > MOST_RECORDINGS {
            self.of.pop_last();
        }
    }

    /// Returns the defects that were kept, in the order of the manifest.
    pub(super) fn list(&self) -> Vec<Defect> {
        self.of.values().flatten().cloned().collect()
    }
}
