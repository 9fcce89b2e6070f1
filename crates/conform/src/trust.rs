//! What a conformant model says about motions that were not recorded.
//!
//! "These sets enclose these runs" is a fact. Anything about the next motion is statistical, and
//! needs motions that are independent and alike. Several suites of one motion count once.

use std::collections::BTreeSet;

use serde::{Deserialize, Serialize};

use crate::bounds::{clopper_pearson, scenario_bound};
use crate::problem::recordings::Recordings;
use crate::verdict::{Verdict, Witness};

/// Confidence of the bounds that are reported.
pub const CONFIDENCE: f64 = 0.95;

/// A bound above this probability says nothing.
const LARGEST_BOUND: f64 = 0.999;

/// A statement about the next motion.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Trust {
    /// Number of independent motions in the data.
    pub motions: usize,
    /// How many of them decide the sets (for a fitted model) or violate them (for a check).
    pub deciding: usize,
    /// Upper bound of the probability that the next motion leaves the reachable set.
    pub violation_probability: f64,
    /// Confidence of that bound.
    pub confidence: f64,
    /// How the bound is made and what it assumes.
    pub basis: String,
}

impl Trust {
    /// Returns the scenario bound for sets that were fitted to `recordings` and touch `tight`: the
    /// rows of support are among the tight ones.
    #[must_use]
    pub fn of_fit(recordings: &Recordings, tight: &[Witness]) -> Self {
        let motions = Motions::of(recordings);
        let deciding = motions.count(tight.iter().map(|witness| witness.suite.as_str()));
        let bound = scenario_bound(motions.all(), deciding, 1.0 - CONFIDENCE);
        Self::new(&motions, deciding, bound, "scenario bound (Campi and Garatti 2018)")
    }

    /// Returns the statement about sets that are not the smallest, `gap` above the program's bound:
    /// there is none, because the scenario bound holds for an optimum only.
    #[must_use]
    pub fn without_optimum(recordings: &Recordings, gap: f64) -> Self {
        let motions = Motions::of(recordings);
        let basis = format!(
            "no scenario bound: it holds for the smallest sets only, and the program was solved to \
             a relative gap of {gap:.1e}"
        );
        let (motions, deciding) = (motions.all(), 0);
        let (violation_probability, confidence) = (1.0, CONFIDENCE);
        Self { motions, deciding, violation_probability, confidence, basis }
    }

    /// Returns the hold-out bound for a check on `recordings` that were not used in the fit.
    #[must_use]
    pub fn of_check(recordings: &Recordings, verdict: &Verdict) -> Self {
        let motions = Motions::of(recordings);
        let violating = verdict.suites.iter().filter(|suite| suite.violations.count > 0);
        let violating = motions.count(violating.map(|suite| suite.suite.as_str()));
        let bound = clopper_pearson(motions.all(), violating, 1.0 - CONFIDENCE);
        Self::new(&motions, violating, bound, "hold-out bound (Clopper and Pearson 1934)")
    }

    /// Says in words what is known of the next motion, for people; `set` names the set and `role`
    /// says what the deciding motions did.
    #[must_use]
    pub fn words(&self, set: &str, role: &str) -> String {
        let Self { motions, deciding, violation_probability: bound, confidence, basis } = self;
        let plural = if *motions == 1 { "motion" } else { "motions" };
        if *bound > LARGEST_BOUND && *deciding == 0 {
            return format!("nothing is known of the next motion: {basis}");
        }
        let counted = format!("{deciding} of {motions} independent {plural} {role}");
        if *bound > LARGEST_BOUND {
            return format!(
                "nothing is known of the next motion: these recordings give no bound below 99.9 % \
                 for the probability that it leaves the {set} ({counted}); more motions may give \
                 one, more runs of the same motions do not; basis: {basis}"
            );
        }
        format!(
            "the next motion leaves the {set} with probability at most {bound:.3}, at confidence \
             {:.0} %: {counted}; basis: {basis}",
            100.0 * confidence
        )
    }

    fn new(motions: &Motions, deciding: usize, bound: f64, name: &str) -> Self {
        Self {
            motions: motions.all(),
            deciding,
            violation_probability: bound,
            confidence: CONFIDENCE,
            basis: format!("{name} for independent motions{}", motions.caveat()),
        }
    }
}

/// The motion of each suite; its own name where the source names none.
struct Motions<'a> {
    of_suite: Vec<(&'a str, &'a str)>,
    /// Whether the source names a motion for every suite.
    are_named: bool,
}

impl<'a> Motions<'a> {
    fn of(recordings: &'a Recordings) -> Self {
        let entries = || recordings.suites.iter().map(|suite| &suite.entry);
        let motion = |entry: &'a reachtube_recordings::SuiteEntry| {
            (entry.name.as_str(), entry.motion.as_deref().unwrap_or(&entry.name))
        };
        let are_named = entries().all(|entry| entry.motion.is_some());
        Self { of_suite: entries().map(motion).collect(), are_named }
    }

    fn all(&self) -> usize {
        self.count(self.of_suite.iter().map(|(suite, _)| *suite))
    }

    /// Returns the number of distinct motions of some suites.
    fn count<'s>(&self, suites: impl Iterator<Item = &'s str>) -> usize {
        let motion = |name: &str| {
            self.of_suite.iter().find(|(suite, _)| *suite == name).map(|(_, motion)| *motion)
        };
        suites.filter_map(motion).collect::<BTreeSet<_>>().len()
    }

    fn caveat(&self) -> &'static str {
        if self.are_named {
            ""
        } else {
            "; runs.csv has no column motion, so each suite counts as a motion of its own, which \
             is too optimistic where suites share one"
        }
    }
}
