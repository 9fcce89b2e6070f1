//! Statement of a conformant model about motions that were not recorded.
//!
//! "These sets enclose these runs" is a fact. Anything about the next motion is statistical, and
//! needs motions that are independent and alike. Several suites of one motion count once.

use std::collections::BTreeSet;

use reachtube_scalar::number::counted;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::claim::verdict::Verdict;
use crate::data::problem::Problem;
use crate::data::recordings::Recordings;
use crate::data::settings::InitialLimit;
use crate::next_motion::bounds::{clopper_pearson, scenario_bound};
use crate::next_motion::calibration::{Calibration, Gauge};
use crate::next_motion::motions::Motions;
use crate::next_motion::trust_kind::TrustKind;
use crate::tube::rows::NEGLIGIBLE_RADIUS;
use crate::tube::witness::Witness;

/// Confidence of the bounds that are reported.
pub const CONFIDENCE: f64 = 0.95;

/// A statement about the next motion.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Trust {
    /// Number of independent motions in the data.
    pub motions: usize,
    /// How many of them decide the sets (for a fitted model) or violate them (for a check).
    pub deciding: usize,
    /// Upper bound of the probability that the next motion leaves the reachable set.
    pub violation_probability: f64,
    /// The same before the calibration motions are drawn, which holds without a confidence: over
    /// their draw and the draw of the next motion together. For calibrated sets only.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub average_probability: Option<f64>,
    /// Confidence of that bound.
    pub confidence: f64,
    /// How the bound is made and what it assumes.
    pub basis: String,
    /// The kind of the bound; `None` if there is none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub kind: Option<TrustKind>,
}

impl Trust {
    /// Returns the scenario bound for sets that were fitted to `recordings` and touch `tight`: the
    /// rows of support are among the tight ones.
    ///
    /// It is an indication if a condition of the theorem is not met.
    ///
    /// At a first sample that no recording leaves, all motions touch a set without width. Motions
    /// that also touch it elsewhere give the same sets alone, so only they count; if there are
    /// none, all do.
    #[must_use]
    pub fn of_fit(problem: &Problem, tight: &[Witness]) -> Self {
        let recordings = problem.recordings();
        let motions = Motions::independent(recordings);
        if let (Some(whole), true) = (recordings.are_parts_of(), motions.count() > 1) {
            return Self::of_one("scenario", whole);
        }
        let count = |least: f64| {
            let rows = tight.iter().filter(|witness| witness.radius > least);
            motions.count_of(rows.map(|witness| witness.suite.as_str()))
        };
        let deciding = match count(NEGLIGIBLE_RADIUS) {
            0 => count(f64::NEG_INFINITY),
            some => some,
        };
        let bound = scenario_bound(motions.count(), deciding, 1.0 - CONFIDENCE);
        let of = Self::new(&motions, deciding, bound, "scenario bound (Campi and Garatti 2018)");
        match unmet(problem) {
            None => of,
            Some(condition) => {
                let basis = format!("{}; {condition}", of.basis);
                Self { basis, kind: Some(TrustKind::Indication), ..of }
            }
        }
    }

    /// Returns the statement about sets that are not the smallest, `gap` above the program's bound:
    /// there is none, because the scenario bound holds for an optimum only.
    pub(crate) fn without_optimum(recordings: &Recordings, gap: f64) -> Self {
        let motions = Motions::new(recordings);
        let basis = format!(
            "no scenario bound: it holds for the smallest sets only, and the cost of these is \
             {gap:.1e} of its lower bound above it"
        );
        Self::unknown(motions.count(), basis)
    }

    /// Returns that there is no guarantee, because the nominal model was chosen for these motions:
    /// the scenario bound counts what decides the sets only.
    pub(crate) fn of_fitted_nominal(recordings: &Recordings) -> Self {
        let basis = "no scenario bound: the nominal model was fitted to the same motions";
        Self::unknown(Motions::new(recordings).count(), basis.into())
    }

    /// Returns that there is no guarantee for sets that were widened by what motions ask for that
    /// are among the recordings.
    pub(crate) fn with_allowance(recordings: &Recordings) -> Self {
        let basis = "no scenario bound: it holds for the smallest sets only, and these were \
                     widened by an allowance for motions left out";
        Self::unknown(Motions::new(recordings).count(), basis.into())
    }

    /// Returns the bound for sets that were calibrated by motions that were held out from the fit,
    /// and that enclose them where `is_proved`.
    ///
    /// The next motion leaves the sets only if its gauge is above the gauges of all n held-out
    /// motions. Each of n + 1 exchangeable motions is that one with probability at most 1/(n + 1).
    /// For independent motions, the probability given the held-out ones is above ε with probability
    /// at most (1 - ε)^n, which is the hold-out bound without a violation.
    pub(crate) fn of_calibration(
        problem: &Problem,
        calibration: &Calibration,
        is_proved: bool,
    ) -> Self {
        let motions = Motions::new(problem.recordings());
        let [held_out, copied] = independent(problem.recordings(), calibration);
        let count = held_out.len();
        if !is_proved {
            let basis = "no calibration bound: the scaled sets were not proved to enclose the \
                         recordings";
            return Self::unknown(count, basis.into());
        }
        if count == 0 {
            return Self::unknown(0, "the robot rests in all recordings held out".into());
        }
        if !copied.is_empty() {
            let basis = format!(
                "no calibration bound: motions that were held out have copies among the others \
                 ({})",
                copied.join(", ")
            );
            return Self::unknown(count, basis);
        }
        let seen = problem.setup().drive.seen();
        let suites = problem.recordings().suites_among(seen);
        let seen = motions.among(suites.into_iter(), |motion| {
            calibration.gauges.iter().any(|gauge| gauge.motion == motion)
        });
        if !seen.is_empty() {
            let basis = format!(
                "no calibration bound: the robot was identified from recordings of motions that \
                 were held out here ({}); identify it from the others",
                seen.join(", ")
            );
            return Self::unknown(count, basis);
        }
        let largest = |gauge: &&Gauge| gauge.gauge >= calibration.factor;
        let basis = format!(
            "split conformal calibration (Vovk 2012) for exchangeable motions, and for a model \
             that was fixed before a look at the held-out ones; at confidence for independent \
             motions{}{}",
            match problem.dynamics().linear_system() {
                Some(_) => "",
                None => "; assumes that larger sets have larger computed outer sets",
            },
            motions.caveat()
        );
        let deciding = calibration.gauges.iter().filter(largest).count();
        let kind = Some(motions.kind());
        Self { deciding, kind, ..Self::unknown(count, basis) }.of_candidates(calibration.candidates)
    }

    /// Returns the calibration bound for the one of `candidates` models that was chosen after all
    /// were calibrated by the same motions: by the union of what each may miss, m/(n + 1) on
    /// average, and the bound at confidence 1 - β/m.
    #[must_use]
    pub fn of_candidates(self, candidates: usize) -> Self {
        let (count, of) = (self.motions, candidates.max(1) as f64);
        if of > count as f64 {
            let basis = format!(
                "{} calibrated {candidates} models in this folder, too many to choose one of them",
                counted(count, "held-out motion")
            );
            return Self::unknown(count, basis);
        }
        Self {
            violation_probability: clopper_pearson(count, 0, (1.0 - CONFIDENCE) / of),
            average_probability: Some(of / (count as f64 + 1.0)),
            ..self
        }
    }

    /// Returns the number of models that the calibration bound counts.
    pub(crate) fn candidates(&self) -> usize {
        let average = self.average_probability.unwrap_or_default();
        (average * (self.motions as f64 + 1.0)).round() as usize
    }

    /// Returns the bound of a model whose settings were chosen from its recordings. The theorem of
    /// the scenario bound asks for fixed settings, so that it becomes an indication.
    pub(crate) fn of_chosen_settings(self) -> Self {
        if self.kind != Some(TrustKind::Guarantee) || self.average_probability.is_some() {
            return self;
        }
        let condition = "its theorem needs fixed settings, and some were chosen from the logs";
        let basis = format!("{}; {condition}", self.basis);
        Self { basis, kind: Some(TrustKind::Indication), ..self }
    }

    pub(crate) fn of_check(recordings: &Recordings, verdict: &Verdict) -> Self {
        let motions = Motions::independent(recordings);
        if motions.count() == 0 {
            return Self::unknown(0, "the robot rests in all recordings".into());
        }
        if let (Some(whole), true) = (recordings.are_parts_of(), motions.count() > 1) {
            return Self::of_one("hold-out", whole);
        }
        let violating = verdict.suites.iter().filter(|suite| !suite.holds());
        let violating = motions.count_of(violating.map(|suite| suite.suite.as_str()));
        let bound = clopper_pearson(motions.count(), violating, 1.0 - CONFIDENCE);
        Self::new(&motions, violating, bound, "hold-out bound (Clopper and Pearson 1934)")
    }

    fn new(motions: &Motions, deciding: usize, bound: f64, name: &str) -> Self {
        let basis = format!("{name} for independent motions{}", motions.caveat());
        let kind = Some(motions.kind());
        let unknown = Self::unknown(motions.count(), basis);
        Self { deciding, violation_probability: bound, kind, ..unknown }
    }

    /// Returns that there is no bound, since motions that are parts of one log or motion are not
    /// independent.
    fn of_one(bound: &str, whole: &str) -> Self {
        let basis = format!("no {bound} bound: all motions are parts of {whole}");
        Self::unknown(1, basis)
    }

    fn unknown(motions: usize, basis: String) -> Self {
        Self {
            motions,
            deciding: 0,
            violation_probability: 1.0,
            average_probability: None,
            confidence: CONFIDENCE,
            basis,
            kind: None,
        }
    }
}

/// Returns the held-out motions that a bound may count, and which have a recording in common with
/// the other motions.
fn independent<'a>(recordings: &'a Recordings, calibration: &Calibration) -> [Vec<&'a str>; 2] {
    let (named, counted) = (Motions::new(recordings), Motions::independent(recordings));
    let is_held_out = |motion: &str| calibration.gauges.iter().any(|gauge| gauge.motion == motion);
    let (mut held_out, mut others) = (BTreeSet::new(), BTreeSet::new());
    for (index, suite) in recordings.suites.iter().enumerate() {
        let Some(motion) = counted.of_named_suite(&suite.entry.name) else { continue };
        let of = if is_held_out(named.of_suite(index)) { &mut held_out } else { &mut others };
        of.insert(motion);
    }
    let copied = held_out.intersection(&others).copied().collect();
    [held_out.into_iter().collect(), copied]
}

/// Returns the condition of the scenario bound's theorem that a problem does not meet: the sets
/// must solve a convex program in which each motion adds rows, and changes nothing else.
fn unmet(problem: &Problem) -> Option<&'static str> {
    let settings = problem.settings();
    let is_limited = settings.are_limited_by_noise() && settings.sensor_noise.is_none();
    let seen = problem.setup().drive.seen();
    let is_seen = !problem.recordings().suites_among(seen).is_empty();
    let ends_alone = || Motions::new(problem.recordings()).longest_is_one(problem.recordings());
    if problem.dynamics().linear_system().is_none() {
        Some("its theorem is proved for convex programs, and this model is not linear")
    } else if is_limited {
        Some(
            "its theorem needs fixed limits, and the limit by sensor noise was estimated from \
             the recordings",
        )
    } else if settings.initial_limit != InitialLimit::None {
        Some("its theorem needs fixed limits, and the limit of X0 depends on the recordings")
    } else if ends_alone() {
        Some(
            "its theorem needs a fixed cost, and this one counts until the end of a single \
             motion",
        )
    } else if is_seen {
        Some(
            "its theorem needs a fixed model, and this robot was identified from recordings \
              among these",
        )
    } else {
        None
    }
}
