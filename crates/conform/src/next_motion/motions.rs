use std::collections::{BTreeSet, HashMap};

use crate::data::recordings::Recordings;
use crate::data::suite::Suite;
use crate::next_motion::trust_kind::TrustKind;

/// Durations are the same up to this part.
const SAME_END: f64 = 1e-6;

/// The motion of each suite: its own name where the source names none.
pub(crate) struct Motions<'a> {
    /// Suite and motion, in the order of the suites that count.
    of_suites: Vec<(&'a str, &'a str)>,
    /// Whether the source names a motion for every suite.
    are_named: bool,
}

impl<'a> Motions<'a> {
    pub(crate) fn new(recordings: &'a Recordings) -> Self {
        Self::some(recordings, |_| true)
    }

    /// Takes what a bound may count: suites in which the robot moves, since a bound for motions
    /// does not hold for poses. Motions that share a recording are one.
    pub(crate) fn independent(recordings: &'a Recordings) -> Self {
        let mut moving = Self::some(recordings, |suite| !suite.is_at_rest());
        let mut known: HashMap<&str, &str> = HashMap::new();
        let mut same: HashMap<&str, &str> = HashMap::new();
        let suites = recordings.suites.iter().filter(|suite| !suite.is_at_rest());
        for (suite, (_, motion)) in suites.zip(&moving.of_suites) {
            for run in suite.runs.iter().filter(|run| !run.sha256.is_empty()) {
                let first = *known.entry(&run.sha256).or_insert(motion);
                let (first, own) = (followed(&same, first), followed(&same, motion));
                if first != own {
                    same.insert(own, first);
                }
            }
        }
        moving.of_suites.iter_mut().for_each(|(_, motion)| *motion = followed(&same, motion));
        moving
    }

    pub(crate) fn of_named_suite(&self, suite: &str) -> Option<&'a str> {
        self.of_suites.iter().find(|(name, _)| *name == suite).map(|(_, motion)| *motion)
    }

    fn some(recordings: &'a Recordings, takes: impl Fn(&Suite) -> bool) -> Self {
        let suites = || recordings.suites.iter().filter(|suite| takes(suite));
        let entries = || suites().map(|suite| &suite.entry);
        let motion = |entry: &'a reachtube_recordings::SuiteEntry| {
            (entry.name.as_str(), entry.motion.as_deref().unwrap_or(&entry.name))
        };
        let are_named = entries().all(|entry| entry.motion.is_some());
        Self { of_suites: entries().map(motion).collect(), are_named }
    }

    pub(crate) fn of_suite(&self, index: usize) -> &'a str {
        self.of_suites[index].1
    }

    /// Returns the distinct motions, in the order of their first suites.
    pub(crate) fn distinct(&self) -> Vec<&'a str> {
        let mut seen = BTreeSet::new();
        let motions = self.of_suites.iter().map(|(_, motion)| *motion);
        motions.filter(|motion| seen.insert(*motion)).collect()
    }

    pub(crate) fn count(&self) -> usize {
        self.distinct().len()
    }

    pub(crate) fn count_of<'s>(&self, suites: impl Iterator<Item = &'s str>) -> usize {
        suites.filter_map(|suite| self.of_named_suite(suite)).collect::<BTreeSet<_>>().len()
    }

    pub(crate) fn among<'s>(
        &self,
        suites: impl Iterator<Item = &'s str>,
        is_asked: impl Fn(&str) -> bool,
    ) -> Vec<&'a str> {
        let names: BTreeSet<&str> = suites.collect();
        let of = self.of_suites.iter().filter(|(suite, _)| names.contains(suite));
        let motions: BTreeSet<&str> = of.map(|(_, motion)| *motion).collect();
        motions.into_iter().filter(|motion| is_asked(motion)).collect()
    }

    /// Returns whether one motion lasts longer than all others, so that it alone decides how long
    /// the cost counts.
    pub(crate) fn longest_is_one(&self, recordings: &Recordings) -> bool {
        let ends = |suite: &Suite| suite.runs.iter().map(|run| run.duration).fold(0.0, f64::max);
        let all: Vec<f64> = recordings.suites.iter().map(ends).collect();
        let longest = all.iter().copied().fold(0.0, f64::max);
        let longest = (0..all.len()).filter(|suite| all[*suite] >= (1.0 - SAME_END) * longest);
        let motions: BTreeSet<&str> = longest.map(|suite| self.of_suite(suite)).collect();
        motions.len() == 1 && self.count() > 1
    }

    /// Returns the kind of a statement that counts motions: a guarantee, unless suites are counted
    /// as motions because the source names none.
    pub(crate) fn kind(&self) -> TrustKind {
        match self.are_named || self.count() < 2 {
            true => TrustKind::Guarantee,
            false => TrustKind::Indication,
        }
    }

    /// Returns what weakens a statement that counts motions, to follow its basis.
    pub(crate) fn caveat(&self) -> &'static str {
        if self.are_named {
            ""
        } else {
            "; runs.csv has no column motion, so each suite counts as a motion of its own, which \
             is too optimistic if suites share one"
        }
    }
}

/// Returns the first motion that shares a recording with a motion.
fn followed<'a>(same: &HashMap<&'a str, &'a str>, motion: &'a str) -> &'a str {
    let mut motion = motion;
    while let Some(first) = same.get(motion) {
        motion = first;
    }
    motion
}
