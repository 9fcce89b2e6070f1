//! Whether the recordings contradict the robot.

use reachtube_conform::Finding;
use reachtube_conform::result::Severity;

use crate::build::Built;

impl Built {
    /// Returns all findings: the ones about the recordings first, then the findings of the model.
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
