use crate::error::{Error, Result};

/// An observer of a long job, who may also cancel it. Every method has a default that does nothing.
pub trait Progress: Sync {
    /// Takes how many of `total` recordings have been read.
    fn recordings_read(&self, done: usize, total: usize) {
        let _ = (done, total);
    }

    /// Takes a sentence about a part of the search that is finished.
    fn finished(&self, what: &str) {
        let _ = what;
    }

    /// Returns whether the job is cancelled. It is called between recordings and between the steps
    /// of a search, and the job then ends with [`Error::Cancelled`](crate::Error::Cancelled).
    fn is_cancelled(&self) -> bool {
        false
    }
}

/// Reports no progress.
#[derive(Debug, Clone, Copy, Default)]
pub struct Silent;

impl Progress for Silent {}

impl dyn Progress + '_ {
    pub(crate) fn go_on(&self) -> Result<()> {
        if self.is_cancelled() { Err(Error::Cancelled) } else { Ok(()) }
    }
}
