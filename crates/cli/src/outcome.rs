//! The result of a command that did not fail, as its exit code reports it.

use reachtube::conform::Model;

/// The result of a command that did not fail.
pub(crate) enum Outcome {
    /// The command is done, and a verdict, if there is one, is conformant.
    Done,
    /// The verdict is not conformant.
    NotConformant,
    /// The verdict is conformant, but the sets do not limit some joint.
    Vacuous,
    /// A link comes too close to an obstacle.
    Unsafe,
    /// It is not known whether the links stay clear.
    Undecided,
}

impl Outcome {
    pub(crate) fn of(conformant: bool) -> Self {
        if conformant { Self::Done } else { Self::NotConformant }
    }

    /// Returns the outcome of a verdict about recordings and `model`.
    pub(crate) fn of_model(conformant: bool, model: &Model) -> Self {
        match Self::of(conformant) {
            Self::Done if model.is_vacuous() => Self::Vacuous,
            outcome => outcome,
        }
    }
}
