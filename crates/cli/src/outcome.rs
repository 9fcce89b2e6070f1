//! The result of a command that did not fail, as its exit code reports it.

/// The result of a command that did not fail.
pub(crate) enum Outcome {
    /// The command is done, and a verdict, if there is one, is conformant.
    Done,
    /// The verdict is not conformant.
    NotConformant,
}

impl Outcome {
    /// Returns the outcome of a verdict.
    pub(crate) fn of(conformant: bool) -> Self {
        if conformant { Self::Done } else { Self::NotConformant }
    }
}
