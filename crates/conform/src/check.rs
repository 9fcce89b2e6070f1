use serde::Serialize;

use crate::data::problem::Problem;
use crate::data::settings::Notion;
use crate::data::suite::Suite;
use crate::data::summary::RunSummary;
use crate::error::Result;
use crate::growth::Growth;
use crate::hulls::Hulls;
use crate::model::file::Model;
use crate::next_motion::rates::Rates;
use crate::next_motion::trust::Trust;
use crate::verdict::{Verdict, Witness};

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
    /// For each state in which a recording leaves the set, the value that leaves it furthest, among
    /// those that have a reachable set.
    pub worst_by_state: Vec<Witness>,
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
    let mut worst: Vec<Option<Witness>> = vec![None; 2 * problem.joints()];
    let verdict = Verdict::new(problem, hulls, |suite, _, row| {
        let largest = row.edges.iter().map(|edge| edge.excess).fold(0.0, f64::max);
        excess[row.state] = excess[row.state].max(largest);
        for edge in row.edges.iter().filter(|edge| edge.excess > 0.0 && edge.excess.is_finite()) {
            let worst = &mut worst[row.state];
            if worst.as_ref().is_none_or(|worst| edge.excess > worst.excess) {
                *worst = Some(Witness::new(problem, suite, row, edge));
            }
        }
    })?;
    let worst_by_state = worst.into_iter().flatten().collect();
    let is_hull = problem.settings().notion == Notion::Hull;
    let can_grow = is_hull && !verdict.conformant && excess.iter().all(|excess| excess.is_finite());
    let growth = can_grow.then(|| Growth::new(problem, &hulls.sets, &excess)).transpose()?;
    Ok(Check { worst_by_state, growth, ..Check::new(model, problem, verdict) })
}

impl Check {
    /// Adds to a verdict what it says about the next motion.
    #[must_use]
    pub fn new(model: &Model, problem: &Problem, verdict: Verdict) -> Self {
        let recordings = problem.recordings();
        let is_used = model.knows_of(recordings);
        let is_held_out = is_used == Some(false);
        let trust = is_held_out.then(|| Trust::of_check(recordings, &verdict));
        let rates = is_held_out.then(|| Rates::new(recordings, &verdict));
        let mut notes = recordings.notes.clone();
        notes.extend(is_used.is_none().then(|| unknown_use(model)));
        notes.extend(recordings.suites.iter().filter_map(|suite| other_start_note(model, suite)));
        let worst_by_state = Vec::new();
        Self { verdict, trust, rates, worst_by_state, growth: None, notes }
    }
}

/// Says why nobody knows whether the recordings were used in the fit.
fn unknown_use(model: &Model) -> String {
    let why = if model.data.are_listed() {
        "the fold does not have the SHA-256 of each; fold them to check this model"
    } else {
        "its file counts its recordings and does not list them; fit it to fewer to have them listed"
    };
    format!(
        "whether a recording was used in the fit of the model cannot be known, so they count as \
         used and nothing is said of the next motion: {why}"
    )
}

/// Says where no recording of a suite starts near the nominal initial state that the model has for
/// a suite of that name.
fn other_start_note(model: &Model, suite: &Suite) -> Option<String> {
    let name = &suite.entry.name;
    model.data.suites.iter().find(|known| known.name == *name)?.nominal_start.as_ref()?;
    let sets = model.sets();
    let near = |i: usize| {
        let (low, high) = sets.initial_set.bounds(i);
        let reach = (high - low) + sets.noise_radius(i);
        [low - reach, high + reach]
    };
    let is_near = |run: &RunSummary| {
        (0..run.start.len()).all(|i| {
            let ([low, high], offset) = (near(i), run.start[i] - suite.nominal_start[i]);
            (low..=high).contains(&offset)
        })
    };
    // Of a large suite only the bounds of all starts are known.
    let may_be_near = || {
        suite.totals.start_bounds.iter().enumerate().all(|(i, [first, last])| {
            let ([low, high], nominal) = (near(i), suite.nominal_start[i]);
            last - nominal >= low && first - nominal <= high
        })
    };
    let any_near = if suite.is_small() { suite.runs.iter().any(is_near) } else { may_be_near() };
    (!any_near).then(|| {
        format!(
            "suite {name}: none of its recordings starts near the nominal initial state that the \
             model has for a suite of this name; if this is another motion, give the suite \
             another name"
        )
    })
}
