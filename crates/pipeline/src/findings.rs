//! What the recordings say about themselves and the robot, as findings.

use reachtube_conform::Finding;
use reachtube_conform::result::{Code, Severity};
use reachtube_identify::Implausible;

use crate::choices::Choices;

/// Makes the finding that the recordings contradict the robot, so that no model of them is
/// acceptable.
pub(crate) fn contradiction(text: &str) -> Finding {
    Finding::new(Severity::Failure, Code::Contradiction, sentence(text))
}

/// Makes the finding about an implausible result of an identification. Only columns that are wrong
/// make the model unacceptable.
pub(crate) fn implausible(result: &Implausible) -> Finding {
    let severity = if result.columns.is_some() { Severity::Failure } else { Severity::Warning };
    Finding { severity, ..contradiction(&result.text) }
}

/// Makes a warning of a clause.
pub(crate) fn warning(code: Code, text: &str) -> Finding {
    Finding::new(Severity::Warning, code, sentence(text))
}

/// Ends a clause about recordings, whose first word may be a path, as a sentence.
fn sentence(text: &str) -> String {
    let first = text.chars().next().map_or(0, char::len_utf8);
    let is_path = text.split(' ').next().is_some_and(|word| word.contains(['/', '\\', '.']));
    let (first, rest) = text.split_at(if is_path { 0 } else { first });
    format!("{}{rest}.", first.to_uppercase())
}

/// Makes contradictions warnings if factors of the torques are given: they state that the torques
/// are right.
pub(crate) fn unless_accepted(findings: Vec<Finding>, given: &Choices) -> Vec<Finding> {
    if given.gains.is_empty() {
        return findings;
    }
    let accepted = |finding| Finding { severity: Severity::Warning, ..finding };
    findings.into_iter().map(accepted).collect()
}
