//! What a command that did not fail came to.

/// What a command came to when it did not fail.
pub enum Outcome {
    /// Done; where there is a verdict, it is conformant.
    Done,
    /// Not conformant.
    NotConformant,
}

impl Outcome {
    pub fn of(conformant: bool) -> Self {
        if conformant { Self::Done } else { Self::NotConformant }
    }
}
