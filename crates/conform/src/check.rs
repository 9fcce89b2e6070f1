//! Whether other recordings lie in the hull of the reachable set of a model, and where not: the
//! answer comes with a witness.

use serde::{Deserialize, Serialize};

use super::recordings::{Progress, Recordings, Suite};
use super::rows::every_row;
use super::verify::Row;
use super::{Lost, Settings, Side, Trust};
use crate::error::Result;
use crate::model::Model;
use reachtube_recordings::{DataSet, state_name};

/// The answer of a check.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Check {
    /// Whether every recording was proved to lie in the interval hull of the reachable set at every
    /// sample.
    pub conformant: bool,
    /// Where not.
    pub violations: Violations,
    /// Where a reachable set could not be followed to the end; what is recorded later counts as
    /// violated.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub lost: Vec<Lost>,
    /// The same for each suite.
    pub suites: Vec<SuiteCheck>,
    /// Recordings checked.
    pub runs: usize,
    /// (suite, time, state) rows checked.
    pub rows: usize,
    /// What this says of the next motion; nothing when a recording was used in the fit.
    pub trust: Option<Trust>,
    /// What a user should know about the data.
    pub notes: Vec<String>,
}

/// Rows that are not enclosed.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Violations {
    /// Violated (suite, time, state) rows.
    pub count: usize,
    /// The row with the largest excess, rad or rad/s, among those that have a reachable set.
    pub worst: Option<Place>,
}

/// The check of one suite.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SuiteCheck {
    /// The suite.
    pub suite: String,
    /// Its recordings.
    pub runs: usize,
    /// (time, state) rows checked.
    pub rows: usize,
    /// Where it leaves the reachable set.
    pub violations: Violations,
    /// The recordings that leave it furthest in some row.
    pub violating_runs: Vec<String>,
}

/// A row in the words of the recordings: a witness.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Place {
    /// The suite.
    pub suite: String,
    /// The recording.
    pub run: String,
    /// Sample, from 0.
    pub sample: usize,
    /// Time since the first sample, s.
    pub time: f64,
    /// Joint, from 1.
    pub joint: usize,
    /// The column of the recording: q3, qd1, ...
    pub state: String,
    /// Above or below the set.
    pub side: Side,
    /// How far outside the reachable set, rad or rad/s; an upper bound.
    pub excess: f64,
    /// Radius of the reachable set there, rad or rad/s.
    pub radius: f64,
}

impl Place {
    /// The row `row` of a suite in words.
    pub fn new(data: &DataSet, suite: &Suite, row: &Row, joints: usize) -> Self {
        Self {
            suite: suite.entry.name.clone(),
            run: data.runs()[row.run as usize].file.clone(),
            sample: row.sample,
            time: row.time,
            joint: row.state % joints + 1,
            state: state_name(row.state, joints),
            side: row.side,
            excess: row.excess,
            radius: row.radius,
        }
    }
}

impl Violations {
    fn none() -> Self {
        Self { count: 0, worst: None }
    }

    fn take(&mut self, place: Place) {
        if self.worst.as_ref().is_none_or(|worst| place.excess > worst.excess) {
            self.worst = Some(place);
        }
    }
}

/// Checks the suites `names` of `data` (all when none is named) against the reachable set of
/// `model`. `settings` say how the recordings are read; they are those of the model but for what
/// the torques are, and what part of the recordings is used.
///
/// # Guarantee
///
/// When `conformant`, every recorded value was proved with directed rounding to lie in the interval
/// hull of the reachable set, at samples; of the computed outer enclosure of that set where the
/// model is not linear. A row within rounding of the boundary (about 1e-12 relative) that could not
/// be proved counts as violated.
///
/// # Errors
///
/// Defects of the recordings, or an unknown suite. A violation is no error.
pub fn check(
    model: &Model,
    data: &DataSet,
    names: &[String],
    settings: &Settings,
    progress: Progress,
) -> Result<Check> {
    let (robot, sets) = (model.robot()?, model.sets());
    let recordings = Recordings::read(data, names, &robot, settings, progress)?;
    let mut suites: Vec<(SuiteCheck, Sides)> =
        recordings.suites.iter().map(SuiteCheck::start).collect();
    let visit = |index: usize, row: Row| {
        let (result, sides) = &mut suites[index];
        sides.take(row, result, data, &recordings.suites[index], robot.joint_count());
    };
    let lost = every_row(&model.dynamics()?, data, &robot, settings, &sets, &recordings, visit)?;
    let suites = suites.into_iter().map(|(suite, _)| suite).collect();
    Ok(summary(&recordings, suites, lost, model))
}

impl SuiteCheck {
    /// Before any row.
    fn start(suite: &Suite) -> (Self, Sides) {
        let (name, runs) = (suite.entry.name.clone(), suite.runs.len());
        let violations = Violations::none();
        (
            Self { suite: name, runs, rows: 0, violations, violating_runs: Vec::new() },
            Sides::default(),
        )
    }
}

/// The two sides of a (time, state) row come one after the other and count once.
#[derive(Default)]
struct Sides {
    violated: bool,
}

impl Sides {
    fn take(
        &mut self,
        row: Row,
        result: &mut SuiteCheck,
        data: &DataSet,
        suite: &Suite,
        joints: usize,
    ) {
        if row.side == Side::Upper {
            result.rows += 1;
            self.violated = false;
        }
        if row.excess <= 0.0 {
            return;
        }
        result.violations.count += usize::from(!self.violated);
        self.violated = true;
        if !row.excess.is_finite() {
            return;
        }
        let place = Place::new(data, suite, &row, joints);
        if !result.violating_runs.contains(&place.run) {
            result.violating_runs.push(place.run.clone());
        }
        result.violations.take(place);
    }
}

fn summary(
    recordings: &Recordings,
    suites: Vec<SuiteCheck>,
    lost: Vec<Lost>,
    model: &Model,
) -> Check {
    let mut violations = Violations::none();
    for suite in &suites {
        violations.count += suite.violations.count;
        if let Some(place) = &suite.violations.worst {
            violations.take(place.clone());
        }
    }
    let rows = suites.iter().map(|suite| suite.rows).sum();
    let known = recordings.suites.iter().all(|suite| suite.entry.motion.is_some());
    let motion = |name: &str| {
        let suite = recordings.suites.iter().find(|suite| suite.entry.name == name);
        suite.and_then(|suite| suite.entry.motion.clone()).unwrap_or_else(|| name.to_string())
    };
    let distinct = |violating: bool| {
        let chosen = suites.iter().filter(|suite| !violating || suite.violations.count > 0);
        chosen.map(|suite| motion(&suite.suite)).collect::<std::collections::BTreeSet<_>>().len()
    };
    let held_out = !model.was_fitted_to(recordings);
    Check {
        conformant: violations.count == 0 && rows > 0,
        trust: held_out.then(|| Trust::of_check(distinct(false), distinct(true), known)),
        runs: recordings.run_count(),
        notes: recordings.notes.clone(),
        lost,
        violations,
        suites,
        rows,
    }
}
