//! What the recordings say about themselves and the robot, as findings.

use reachtube_conform::Finding;
use reachtube_conform::result::{Code, Severity};
use reachtube_identify::Implausible;

use crate::build::Built;

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

/// Makes contradictions warnings: a user who gives the factors of the torques states that the
/// torques are right.
pub(crate) fn accepted(findings: &mut [Finding]) {
    findings.iter_mut().for_each(|finding| finding.severity = Severity::Warning);
}

impl Built {
    /// Returns everything that is to be said: about the recordings first, then the findings of the
    /// model.
    #[must_use]
    pub fn all_findings(&self) -> Vec<Finding> {
        self.findings.iter().cloned().chain(self.answer.findings()).collect()
    }

    /// Returns the contradiction for which the model is not acceptable, if there is one.
    #[must_use]
    pub fn contradiction(&self) -> Option<&Finding> {
        self.findings.iter().find(|finding| finding.severity == Severity::Failure)
    }
}
