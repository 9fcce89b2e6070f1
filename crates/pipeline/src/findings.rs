//! What the recordings say about themselves and the robot, as findings.

use reachtube_conform::Finding;
use reachtube_conform::result::{Code, Severity};
use reachtube_identify::Implausible;

use crate::choices::Choices;

/// Makes the finding that the recordings contradict the robot, so that no model of them is
/// acceptable.
pub(crate) fn contradiction(text: String) -> Finding {
    Finding::new(Severity::Failure, Code::Contradiction, text)
}

/// Makes the finding about an implausible result of an identification. Only columns that are wrong
/// make the model unacceptable.
pub(crate) fn implausible(result: &Implausible) -> Finding {
    let severity = if result.is_fault { Severity::Failure } else { Severity::Warning };
    Finding::new(severity, Code::Contradiction, result.text.clone())
}

/// Makes the finding that a recording was moved by whole turns.
pub(crate) fn moved(text: &str) -> Finding {
    Finding::new(Severity::Warning, Code::TurnsMoved, text)
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
