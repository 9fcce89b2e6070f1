use reachtube_arm::ArmModel;
use std::collections::{BTreeMap, BTreeSet};

use reachtube_conform::next_motion::next_motion_of_held_out;
use reachtube_conform::{Answer, Check, CheckJob, Silent};
use reachtube_finding::Finding;
use reachtube_recordings::{MemoryRuns, RunSource};
use schemars::JsonSchema;
use serde::Serialize;

use crate::choices::Choices;
use crate::error::{Error, Result};
use crate::findings::warning;
use crate::windows::Prepared;

/// Windows on a page, besides the deciding ones.
const MOST_SHOWN: usize = 12;

/// Windows on a page that decide the sets.
const MOST_DECIDING: usize = 10;

/// A model beside motions that were held out from every choice.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct HeldOut {
    /// Number of windows.
    pub windows: usize,
    /// Number of rows (window, sample, state).
    pub rows: usize,
    /// How many of them lie outside the reachable set.
    pub outside: usize,
    /// The factor by which the set of each joint at the horizon would have to become wider, n; 1
    /// where nothing lies outside.
    #[serde(skip)]
    pub growth: Vec<f64>,
    /// Number of motions that are as long as a window; `None` where a motion was held out in part
    /// only.
    pub motions: Option<usize>,
    /// The factor by which the radii of X0 and U would have to grow so that the sets enclose all
    /// motions that were held out, 1 where they do; `None` where none suffices.
    pub factor: Option<f64>,
    /// Whether the robot was identified from what is held out.
    #[serde(skip)]
    is_seen: bool,
    /// Why the motions could not be compared, such as a nominal motion that runs away.
    pub failure: Option<String>,
}

/// A model beside motions that were held out, and windows for pages.
pub(crate) struct Compared {
    pub held_out: HeldOut,
    pub shown: MemoryRuns,
    pub shown_held_out: MemoryRuns,
}

impl Compared {
    /// Compares a model with the recordings that were held out, and chooses windows for pages: the
    /// windows that decide the sets or leave them, and others evenly spread. `are_whole` says
    /// whether motions were held out as a whole.
    pub(crate) fn new(
        answer: &Answer,
        recordings: &Prepared,
        held_back: &Prepared,
        horizon: f64,
        are_whole: bool,
    ) -> Result<Self> {
        let (held_out, outside) = HeldOut::new(answer, held_back, horizon, are_whole)?;
        let deciding = most_deciding(answer);
        let shown = some_windows(recordings, horizon, &deciding)?;
        let shown_held_out = some_windows(held_back, horizon, &outside)?;
        Ok(Self { held_out, shown, shown_held_out })
    }
}

/// Returns the ten windows that decide the most rows.
fn most_deciding(answer: &Answer) -> BTreeSet<String> {
    let mut counts: BTreeMap<&str, usize> = BTreeMap::new();
    answer.found.tight.iter().for_each(|place| *counts.entry(&place.run).or_insert(0) += 1);
    let mut most: Vec<(&str, usize)> = counts.into_iter().collect();
    most.sort_by_key(|(_, values)| std::cmp::Reverse(*values));
    most.into_iter().take(MOST_DECIDING).map(|(file, _)| file.into()).collect()
}

impl HeldOut {
    #[must_use]
    pub(crate) fn part_outside(&self) -> f64 {
        self.outside as f64 / self.rows.max(1) as f64
    }

    /// Returns what follows for the next motion, in a few words, from one of `models` models that
    /// were compared with the same motions.
    #[must_use]
    pub(crate) fn next_motion(&self, models: usize) -> String {
        match (&self.failure, self.is_seen) {
            (Some(_), _) => "no guarantee: what was held out could not be compared".into(),
            (None, true) => "no guarantee: the robot was identified from what is held out".into(),
            (None, false) => next_motion_of_held_out(self.motions, self.factor, models),
        }
    }

    /// Returns a finding where the sets do not carry over to what was held out.
    pub(crate) fn finding(&self, choices: &Choices) -> Option<Finding> {
        let part = self.part_outside();
        let text = match &self.failure {
            Some(failure) => format!("what was held out could not be compared: {failure}"),
            None if part > choices.largest_outside() => format!(
                "{:.1} % of the rows that were held out lie outside the sets: the other \
                 recordings do not cover them; record more motions, and faster ones",
                100.0 * part
            ),
            None => return None,
        };
        let numbers = [("part".to_string(), part)].into();
        Some(Finding { numbers, ..warning(reachtube_conform::Code::HeldOutRates, &text) })
    }

    /// Compares a model with prepared recordings. Returns the runs that leave its sets furthest,
    /// too.
    fn new(
        answer: &Answer,
        recordings: &Prepared,
        horizon: f64,
        are_whole: bool,
    ) -> Result<(Self, BTreeSet<String>)> {
        let n = answer.model.inputs();
        let none = BTreeSet::new();
        let windows = match recordings.cut(horizon, usize::MAX) {
            Err(Error::NoWindow { .. }) => {
                return Ok((Self::failed(n, 0, "no window is as long"), none));
            }
            other => other?,
        };
        let count = windows.runs().len();
        let motions: BTreeSet<_> = windows.runs().iter().map(|run| run.motion.clone()).collect();
        let motions = are_whole.then_some(motions.len());
        let model = &answer.model;
        match CheckJob::new(model.clone(), model.setup()?, windows).run(&Silent) {
            Ok(check) => {
                let verdict = &check.verdict;
                let worst =
                    verdict.suites.iter().filter_map(|suite| suite.violations.worst.as_ref());
                let mut worst: Vec<_> = worst.collect();
                worst.sort_by(|a, b| b.excess.total_cmp(&a.excess));
                let outside =
                    worst.iter().map(|worst| worst.run.clone()).take(MOST_SHOWN).collect();
                let held_out = Self {
                    windows: count,
                    rows: verdict.rows,
                    outside: verdict.violations.count,
                    growth: growth(&check, n),
                    motions,
                    factor: check.factor_of_sets(),
                    is_seen: check.trust.is_none() && are_whole,
                    failure: None,
                };
                Ok((held_out, outside))
            }
            Err(error) => Ok((Self::failed(n, count, &error.to_string()), none)),
        }
    }

    fn failed(joints: usize, windows: usize, why: &str) -> Self {
        Self {
            windows,
            rows: 0,
            outside: 0,
            growth: vec![f64::INFINITY; joints],
            motions: None,
            factor: None,
            is_seen: false,
            failure: Some(why.into()),
        }
    }
}

/// Returns the factor by which the set of each joint would have to become wider.
fn growth(check: &Check, joints: usize) -> Vec<f64> {
    match &check.growth {
        None if check.holds() => vec![1.0; joints],
        // No factor encloses what follows a nominal motion that ran away.
        None => vec![f64::INFINITY; joints],
        Some(growth) => growth.parts.iter().map(|own| own.unwrap_or(f64::INFINITY)).collect(),
    }
}

/// Returns the windows that `first` names and others, evenly spread; none where no recording is as
/// long as a window.
fn some_windows(
    recordings: &Prepared,
    horizon: f64,
    first: &BTreeSet<String>,
) -> Result<MemoryRuns> {
    let all = match recordings.cut(horizon, usize::MAX) {
        Err(Error::NoWindow { .. }) => return Ok(MemoryRuns::default()),
        other => other?,
    };
    let stride = all.runs().len().div_ceil(MOST_SHOWN).max(1);
    let spread: BTreeSet<&str> =
        all.runs().iter().step_by(stride).map(|run| run.file.as_str()).collect();
    let is_wanted = |name: &str| first.contains(name) || spread.contains(name);
    recordings.cut_some(horizon, usize::MAX, is_wanted)
}
