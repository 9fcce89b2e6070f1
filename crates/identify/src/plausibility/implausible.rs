use reachtube_diagnose::Hypothesis;
use serde::{Deserialize, Serialize};

/// A result that is implausible.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Implausible {
    /// The implausible result, in a sentence.
    pub text: String,
    /// What is wrong with the columns, so that the identified values are worth nothing; `None` for
    /// results that may have other causes.
    pub columns: Option<Hypothesis>,
}

impl Implausible {
    pub(super) fn new(text: String) -> Self {
        Self { text, columns: None }
    }
}
