use reachtube_diagnose::Hypothesis;
use serde::{Deserialize, Serialize};

/// A result that is implausible.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Implausible {
    /// The implausible result, in a sentence.
    pub text: String,
    /// What is wrong with the columns, so that the identified values are worth nothing; `None` for
    /// results that may have other causes.
    pub columns: Option<WrongColumns>,
}

/// Faults of the columns of recordings.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum WrongColumns {
    /// Columns of a joint have the wrong sign.
    Sign,
    /// Columns of two joints are exchanged.
    Swapped,
    /// Columns are in a wrong unit.
    Unit,
}

impl WrongColumns {
    /// Returns what is wrong with the columns. It is `None` for offsets and lags, because zeros and
    /// clocks of robots are off a little.
    pub(super) fn of(fault: &Hypothesis) -> Option<Self> {
        match fault {
            Hypothesis::Sign(..) => Some(Self::Sign),
            Hypothesis::Swap(..) => Some(Self::Swapped),
            Hypothesis::Degrees => Some(Self::Unit),
            _ => None,
        }
    }
}
