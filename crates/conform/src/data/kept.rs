use std::collections::HashMap;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};

use reachtube_recordings::Run;

/// Bytes of samples that are kept at most; runs beyond them are read again when they are needed.
pub(crate) const MOST_BYTES: usize = 256 << 20;

/// Runs that stay in memory because a later step needs them one by one.
#[derive(Debug, Default)]
pub(super) struct KeptRuns {
    runs: Mutex<HashMap<usize, Run>>,
    bytes: AtomicUsize,
}

impl KeptRuns {
    pub(super) fn keep(&self, index: usize, run: Run) {
        let values = run.times.len() + run.states.len() + run.torques.len();
        let bytes = values * size_of::<f64>();
        if self.bytes.fetch_add(bytes, Ordering::Relaxed) + bytes <= MOST_BYTES {
            self.runs.lock().unwrap_or_else(PoisonError::into_inner).insert(index, run);
        }
    }

    pub(super) fn into_runs(self) -> HashMap<usize, Run> {
        self.runs.into_inner().unwrap_or_else(PoisonError::into_inner)
    }
}
