use schemars::JsonSchema;
use serde::Serialize;

use crate::claim::notion::judged;
use crate::claim::verdict::Verdict;
use crate::data::problem::Problem;
use crate::data::suite::Suite;
use crate::data::summary::RunSummary;
use crate::error::Result;
use crate::model::file::Model;
use crate::model::provenance::Provenance;
use crate::next_motion::growth::Growth;
use crate::next_motion::trust::Trust;
use crate::plausibility::friction_warning;
use crate::result::code::Code;
use crate::result::findings;
use crate::tube::tube::Tube;
use crate::tube::witness::Witness;
use reachtube_finding::Finding;

/// Findings about the recordings, which come last.
const NOTED: [Code; 5] = [
    Code::OtherRecordings,
    Code::Recordings,
    Code::UseUnknown,
    Code::FrictionRange,
    Code::OtherStart,
];

/// The answer of a check.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct Check {
    /// Whether the recordings lie in the reachable set, and where not.
    #[serde(flatten)]
    pub verdict: Verdict,
    /// Result of the check about the next motion; `None` if a recording was used in the fit.
    pub trust: Option<Trust>,
    /// For each state in which a recording leaves the set, the value that leaves it furthest, among
    /// states that have a reachable set.
    pub worst_by_state: Vec<Witness>,
    /// What would have to grow so that the recordings were enclosed; `None` if they are, or
    /// where a reachable set was lost; for the notion hull only.
    pub growth: Option<Growth>,
    /// What a user should know about the data.
    pub notes: Vec<String>,
    /// What the verdict is about: model, settings in force, and recordings.
    #[serde(flatten)]
    pub provenance: Provenance,
    /// What the answer says, statement by statement: the verdict first.
    pub findings: Vec<Finding>,
}

/// Checks the recordings of a problem against reachable sets of `model` over them.
///
/// # Guarantee
///
/// As [`Verdict::new`].
///
/// # Errors
///
/// As [`Problem::run`]. A violation is no error.
pub fn check(model: &Model, problem: &Problem, tube: &Tube) -> Result<Check> {
    let judged = judged(problem, tube)?;
    let tube = judged.as_ref().unwrap_or(tube);
    let mut excess = vec![0.0f64; problem.states()];
    let mut worst: Vec<Option<Witness>> = vec![None; problem.states()];
    let verdict = Verdict::visiting(problem, tube, |row| {
        let largest = row.edges.iter().map(|edge| edge.excess).fold(0.0, f64::max);
        excess[row.state] = excess[row.state].max(largest);
        for edge in row.edges.iter().filter(|edge| edge.excess > 0.0 && edge.excess.is_finite()) {
            let worst = &mut worst[row.state];
            if worst.as_ref().is_none_or(|worst| edge.excess > worst.excess) {
                *worst = Some(Witness::new(problem, row, edge));
            }
        }
    })?;
    let worst_by_state = worst.into_iter().flatten().collect();
    let can_grow = !problem.settings().notion.asks_points()
        && !verdict.conformant
        && excess.iter().all(|excess| excess.is_finite());
    let growth = can_grow.then(|| Growth::new(problem, &tube.sets, &excess)).transpose()?;
    Ok(Check { worst_by_state, growth, ..Check::new(model, problem, verdict) }.with_findings(model))
}

impl Check {
    /// Adds to a verdict what it says about the next motion.
    #[must_use]
    pub fn new(model: &Model, problem: &Problem, verdict: Verdict) -> Self {
        let (recordings, provenance) = (problem.recordings(), model.provenance(problem));
        let other = model.other_data(problem, &provenance.data);
        let is_used = match &other {
            Some(other) if other.starts_alike => Some(true),
            _ => model.knows_of(recordings),
        };
        let is_held_out = is_used == Some(false);
        let trust = is_held_out.then(|| Trust::of_check(recordings, &verdict));
        let mut noted: Vec<Finding> =
            recordings.notes.iter().map(|note| findings::note(note)).collect();
        noted.extend(findings::at_rest(recordings));
        noted.extend(is_used.is_none().then(|| findings::use_unknown(model.data.are_listed())));
        noted.extend(friction_warning(problem));
        let starts_elsewhere =
            recordings.suites.iter().filter(|suite| !may_start_near(model, suite));
        let other = other.as_ref().map(findings::other_recordings);
        noted.extend(starts_elsewhere.map(|suite| findings::other_start(&suite.entry.name)));
        Self {
            notes: noted.iter().map(|finding| finding.text.clone()).collect(),
            verdict,
            trust,
            worst_by_state: Vec::new(),
            growth: None,
            provenance,
            findings: noted.into_iter().chain(other).collect(),
        }
        .with_findings(model)
    }

    /// Adds what the recordings show to be the cause of values that leave the sets.
    #[must_use]
    pub fn explained_by(mut self, causes: Vec<Finding>) -> Self {
        self.findings.extend(causes);
        self
    }

    /// Returns whether the model was proved to enclose all recordings.
    #[must_use]
    pub fn holds(&self) -> bool {
        self.verdict.conformant
    }

    fn with_findings(mut self, model: &Model) -> Self {
        let (verdict, signals) = (&self.verdict, &model.signals);
        let set = verdict.enclosure.set_name();
        let mut findings = vec![findings::verdict_of_check(verdict, &self.provenance.settings)];
        findings.extend(findings::vacuous(model));
        findings.extend(findings::points(verdict, model.settings.states));
        let furthest = verdict.points.as_ref().and_then(|points| points.worst.as_ref());
        findings.extend(furthest.map(|worst| findings::furthest_point(worst, signals)));
        let worst = verdict.violations.worst.as_ref();
        findings.extend(worst.map(|worst| findings::furthest_value(worst, signals)));
        findings.extend(verdict.lost.iter().map(Finding::from));
        findings
            .extend(self.growth.as_ref().map(|growth| findings::growth_needed(growth, signals)));
        findings.push(match &self.trust {
            Some(held_out) => findings::next_motion(held_out, set, "left it"),
            None => findings::fitted_to_these(),
        });
        findings.extend(findings::reach_of_proof(
            verdict,
            model.settings.states,
            &model.signals.noun,
        ));
        let is_noted =
            |found: &Finding| Code::of(&found.code).is_some_and(|code| NOTED.contains(&code));
        findings.extend(self.findings.into_iter().filter(is_noted));
        self.findings = findings;
        self
    }
}

/// Returns whether some recording of a suite may start near the nominal initial state that the
/// model has for a suite of that name, if it has one.
fn may_start_near(model: &Model, suite: &Suite) -> bool {
    let known = model.data.suites.iter().find(|known| known.name == suite.entry.name);
    if known.is_none_or(|known| known.nominal_start.is_none()) {
        return true;
    }
    let sets = model.sets();
    let near = |i: usize| {
        let (low, high) = sets.initial_set.bounds(i);
        let reach = (high - low) + sets.noise_radius(i);
        [low - reach, high + reach]
    };
    let asked = || 0..model.settings.states.rows(suite.nominal_start.len());
    let is_near = |run: &RunSummary| {
        asked().all(|i| {
            let ([low, high], offset) = (near(i), run.start[i] - suite.nominal_start[i]);
            (low..=high).contains(&offset)
        })
    };
    // A large suite keeps only the bounds of all starts.
    let may_be_near = || {
        let bounds = suite.totals.start_bounds.iter().zip(asked());
        bounds.into_iter().all(|([first, last], i)| {
            let ([low, high], nominal) = (near(i), suite.nominal_start[i]);
            last - nominal >= low && first - nominal <= high
        })
    };
    if suite.is_small() { suite.runs.iter().any(is_near) } else { may_be_near() }
}
