use std::collections::BTreeMap;
use std::fmt;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::code::Code;
use crate::front_end::FrontEnd;
use crate::remedy::Remedy;

/// How much a finding matters.
#[derive(
    Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize, JsonSchema,
)]
#[serde(rename_all = "lowercase")]
pub enum Severity {
    /// A fact.
    Info,
    /// The answer is implausible, or weaker than it could be.
    Warning,
    /// The recordings were not proved to be enclosed.
    Failure,
}

/// One statement about an answer: a fact, a warning or a failure, with its numbers and, if one is
/// known, a remedy.
///
/// # Examples
///
/// ```
/// use reachtube_finding::{Code, Finding, FrontEnd, Remedy, Severity};
///
/// let remedy = Remedy {
///     setting: "until".into(),
///     value: "1.204".into(),
///     effect: "uses only the samples before.".into(),
/// };
/// let lost = Code::new("set-lost");
/// let finding = Finding {
///     place: Some("suite A".into()),
///     remedy: Some(remedy),
///     ..Finding::new(Severity::Failure, lost, "The reachable set ends at 1.204 s.")
/// };
/// assert_eq!(
///     finding.to_string(),
///     "The reachable set ends at 1.204 s. `--until 1.204` uses only the samples before."
/// );
/// assert!(finding.written_for(FrontEnd::Python).contains("`until=1.204` uses only"));
/// ```
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Finding {
    /// How much it matters.
    pub severity: Severity,
    /// What it is about.
    pub code: Code,
    /// The suite, recording, joint or motion that it is about, if it is about one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub place: Option<String>,
    /// The numbers of the finding by their names, in SI units.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub numbers: BTreeMap<String, f64>,
    /// The finding as a sentence, without the remedy.
    pub text: String,
    /// The remedy.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub remedy: Option<Remedy>,
}

impl Finding {
    /// Makes a finding without place, numbers and remedy.
    #[must_use]
    pub fn new(severity: Severity, code: impl Into<Code>, text: impl Into<String>) -> Self {
        let (code, text) = (code.into(), text.into());
        Self { severity, code, place: None, numbers: BTreeMap::new(), text, remedy: None }
    }

    /// Adds a number; a number that is not finite, which JSON does not have, is left out.
    #[must_use]
    pub fn with(mut self, name: &str, value: f64) -> Self {
        if value.is_finite() {
            self.numbers.insert(name.into(), value);
        }
        self
    }

    /// Sets the place.
    #[must_use]
    pub fn at(self, place: impl Into<String>) -> Self {
        Self { place: Some(place.into()), ..self }
    }

    /// Sets the remedy.
    #[must_use]
    pub fn remedied_by(self, remedy: impl Into<Option<Remedy>>) -> Self {
        Self { remedy: remedy.into(), ..self }
    }

    /// Returns sentence and remedy as users of a front end write settings. A setting that a file of
    /// choices does not have is left out there.
    #[must_use]
    pub fn written_for(&self, front_end: FrontEnd) -> String {
        match self.remedy.as_ref().filter(|remedy| front_end.has(&remedy.setting)) {
            Some(remedy) => format!("{} {}", self.text, remedy.written_for(front_end)),
            None => self.text.clone(),
        }
    }
}

impl fmt::Display for Finding {
    /// Writes the finding for the command line.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.written_for(FrontEnd::CommandLine))
    }
}
