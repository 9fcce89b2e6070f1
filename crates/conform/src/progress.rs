/// An observer of a long job. Every method has a default that does nothing.
pub trait Progress: Sync {
    /// Takes how many of `total` recordings have been read.
    fn recordings_read(&self, done: usize, total: usize) {
        let _ = (done, total);
    }

    /// Takes a sentence about a part of the search that is finished.
    fn finished(&self, what: &str) {
        let _ = what;
    }
}

/// Reports no progress.
#[derive(Debug, Clone, Copy, Default)]
pub struct Silent;

impl Progress for Silent {}
