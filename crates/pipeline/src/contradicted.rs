//! Whether the recordings contradict the robot.

use reachtube_finding::{Finding, Severity};

use crate::build::Built;

impl Built {
    /// Returns all findings: the ones about the recordings first, then the findings of the model
    /// and what would help.
    #[must_use]
    pub fn all_findings(&self) -> Vec<Finding> {
        [self.findings.clone(), self.answer.findings(), self.remedies.clone()].concat()
    }

    /// Returns whether the recordings contradict the robot, so that the model is not acceptable.
    #[must_use]
    pub fn is_contradicted(&self) -> bool {
        self.contradiction().is_some()
    }

    /// Returns the contradiction for which the model is not acceptable, if there is one.
    #[must_use]
    pub(crate) fn contradiction(&self) -> Option<&Finding> {
        self.findings.iter().find(|finding| finding.severity == Severity::Failure)
    }
}
