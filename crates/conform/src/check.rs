use serde::Serialize;

use crate::error::Result;
use crate::growth::Growth;
use crate::hulls::Hulls;
use crate::model::file::Model;
use crate::next_motion::rates::Rates;
use crate::next_motion::trust::Trust;
use crate::problem::problem::Problem;
use crate::problem::suite::{RunSummary, Suite};
use crate::settings::Notion;
use crate::verdict::Verdict;

/// The answer of a check.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Check {
    /// Whether the recordings lie in the reachable set, and where not.
    #[serde(flatten)]
    pub verdict: Verdict,
    /// What the check says about the next motion; nothing when a recording was used in the fit.
    pub trust: Option<Trust>,
    /// How often the recordings leave the set, with their spread over motions; nothing when a
    /// recording was used in the fit.
    pub rates: Option<Rates>,
    /// What would have to grow so that the recordings were enclosed; nothing where they are, or
    /// where a reachable set was lost; for the notion hull only.
    pub growth: Option<Growth>,
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
    let mut excess = vec![0.0f64; 2 * problem.joints()];
    let verdict = Verdict::new(problem, hulls, |_, _, row| {
        let largest = row.edges.iter().map(|edge| edge.excess).fold(0.0, f64::max);
        excess[row.state] = excess[row.state].max(largest);
    })?;
    let is_hull = problem.settings().notion == Notion::Hull;
    let can_grow = is_hull && !verdict.conformant && excess.iter().all(|excess| excess.is_finite());
    let growth = can_grow.then(|| Growth::new(problem, &hulls.sets, &excess)).transpose()?;
    Ok(Check { growth, ..Check::new(model, problem, verdict) })
}

impl Check {
    /// Adds to a verdict what it says about the next motion.
    #[must_use]
    pub fn new(model: &Model, problem: &Problem, verdict: Verdict) -> Self {
        let recordings = problem.recordings();
        let is_held_out = !model.was_fitted_to(recordings);
        let trust = is_held_out.then(|| Trust::of_check(recordings, &verdict));
        let rates = is_held_out.then(|| Rates::new(recordings, &verdict));
        let mut notes = recordings.notes.clone();
        notes.extend(recordings.suites.iter().filter_map(|suite| other_start_note(model, suite)));
        Self { verdict, trust, rates, growth: None, notes }
    }
}

/// Says where no recording of a suite starts near the nominal initial state that the model has for
/// a suite of that name.
fn other_start_note(model: &Model, suite: &Suite) -> Option<String> {
    let name = &suite.entry.name;
    model.data.suites.iter().find(|known| known.name == *name)?.nominal_start.as_ref()?;
    let sets = model.sets();
    let is_near = |run: &RunSummary| {
        (0..run.start.len()).all(|i| {
            let (low, high) = sets.initial_set.bounds(i);
            let reach = (high - low) + sets.noise_radius(i);
            let offset = run.start[i] - suite.nominal_start[i];
            (low - reach..=high + reach).contains(&offset)
        })
    };
    (!suite.runs.iter().any(is_near)).then(|| {
        format!(
            "suite {name}: none of its recordings starts near the nominal initial state that the \
             model has for a suite of this name; if this is another motion, give the suite \
             another name"
        )
    })
}
