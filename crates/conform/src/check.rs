use serde::Serialize;

use crate::error::Result;
use crate::hulls::Hulls;
use crate::model::file::Model;
use crate::problem::problem::Problem;
use crate::trust::Trust;
use crate::verdict::Verdict;

/// The answer of a check.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Check {
    /// Whether the recordings lie in the reachable set, and where not.
    #[serde(flatten)]
    pub verdict: Verdict,
    /// What the check says about the next motion; nothing when a recording was used in the fit.
    pub trust: Option<Trust>,
    /// What a user should know about the data.
    pub notes: Vec<String>,
}

/// Checks the recordings of a problem against reachable sets of `model` over them.
///
/// # Guarantee
///
/// That of [`Verdict::new`].
///
/// # Errors
///
/// As [`Problem::run`]. A violation is no error.
pub fn check(model: &Model, problem: &Problem, hulls: &Hulls) -> Result<Check> {
    let verdict = Verdict::new(problem, hulls, |_, _, _| {})?;
    Ok(Check::new(model, problem, verdict))
}

impl Check {
    /// Adds to a verdict what it says about the next motion.
    #[must_use]
    pub fn new(model: &Model, problem: &Problem, verdict: Verdict) -> Self {
        let recordings = problem.recordings();
        let is_held_out = !model.was_fitted_to(recordings);
        let trust = is_held_out.then(|| Trust::of_check(recordings, &verdict));
        Self { verdict, trust, notes: recordings.notes.clone() }
    }
}
