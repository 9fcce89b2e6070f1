//! What sets are used for beyond what they were proved for.

use crate::data::problem::Problem;
use crate::data::settings::States;
use crate::model::file::Model;
use crate::result::code::Code;
use reachtube_finding::{Finding, Severity};

/// Recordings of another sample time may be longer than the model's own by this factor.
const LONGER: f64 = 1.01;

impl Model {
    /// Returns a warning for each reason why reachable sets along the recordings of `problem` say
    /// less of the robot than of the model: sets that were not proved to enclose the model's own
    /// recordings, velocities that nothing was asked of, and recordings that last longer.
    #[must_use]
    pub fn beyond_proof(&self, problem: &Problem) -> Vec<Finding> {
        let mut reasons = Vec::new();
        if !self.verified {
            reasons.push(
                "The model's sets were not proved to enclose its own recordings: what follows \
                 holds for the model, and not for the robot."
                    .to_string(),
            );
        }
        if self.settings.states == States::Positions {
            reasons.push(
                "The model's sets enclose recorded positions only: the robot's velocities may be \
                 far outside."
                    .into(),
            );
        }
        let runs = problem.recordings().suites.iter().flat_map(|suite| &suite.runs);
        let longest = runs.map(|run| run.duration).fold(0.0, f64::max);
        if let Some(own) = self.data.longest().filter(|own| longest > LONGER * own) {
            reasons.push(format!(
                "The model was made from recordings of up to {own:.3} s, and these last \
                 {longest:.3} s: nothing was shown of the robot that long."
            ));
        }
        let warning = |text| Finding::new(Severity::Warning, Code::BeyondProof, text);
        reasons.into_iter().map(warning).collect()
    }
}
