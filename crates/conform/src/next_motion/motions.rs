use std::collections::BTreeSet;

use crate::data::recordings::Recordings;
use crate::data::suite::Suite;

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

    /// Leaves out suites in which the robot rests: a bound for motions does not hold for poses.
    pub(crate) fn moving(recordings: &'a Recordings) -> Self {
        Self::some(recordings, |suite| !suite.is_at_rest())
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

    /// Returns the motion of the suite that counts at `index`.
    pub(crate) fn of_suite(&self, index: usize) -> &'a str {
        self.of_suites[index].1
    }

    /// Returns the distinct motions, in the order of their first suites.
    pub(crate) fn distinct(&self) -> Vec<&'a str> {
        let mut seen = BTreeSet::new();
        let motions = self.of_suites.iter().map(|(_, motion)| *motion);
        motions.filter(|motion| seen.insert(*motion)).collect()
    }

    /// Returns the number of distinct motions.
    pub(crate) fn count(&self) -> usize {
        self.distinct().len()
    }

    /// Returns the number of distinct motions of some suites, named one by one.
    pub(crate) fn count_of<'s>(&self, suites: impl Iterator<Item = &'s str>) -> usize {
        let motion = |name: &str| {
            self.of_suites.iter().find(|(suite, _)| *suite == name).map(|(_, motion)| *motion)
        };
        suites.filter_map(motion).collect::<BTreeSet<_>>().len()
    }

    /// Returns the distinct motions of some suites, named one by one, that `is_asked`.
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

    /// Returns what weakens a statement that counts motions, to follow its basis.
    pub(crate) fn caveat(&self) -> &'static str {
        if self.are_named {
            ""
        } else {
            "; runs.csv has no column motion, so each suite counts as a motion of its own, which \
             is too optimistic where suites share one"
        }
    }
}
