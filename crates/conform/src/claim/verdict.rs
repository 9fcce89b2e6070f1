//! The verdict: whether every recording lies in the reachable set, and where not.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::claim::notion::judged;
use crate::claim::witness::PointVerdict;
use crate::data::problem::Problem;
use crate::data::settings::States;
use crate::data::suite::Suite;
use crate::error::Result;
use crate::tube::judged::Judged;
use crate::tube::rows::Row;
use crate::tube::strand::Lost;
use crate::tube::tube::{Enclosure, Tube};
use crate::tube::witness::Witness;

/// Whether recordings lie in the interval hull of a model's reachable set, and where not. A row is
/// the recordings of one suite at one time in one state (of one run, if it has a set of its own).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Verdict {
    /// Whether every row was proved to hold.
    pub conformant: bool,
    /// The claim in words.
    pub claim: String,
    /// Which bound of the reachable set the rows were compared with.
    pub enclosure: Enclosure,
    /// Number of recordings.
    pub runs: usize,
    /// Number of rows.
    pub rows: usize,
    /// The rows that do not hold.
    pub violations: Violations,
    /// The recorded points, where the notion is not the hull.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub points: Option<PointVerdict>,
    /// The largest excess of a row that has a reachable set, rad or rad/s: not above 0 when all
    /// rows hold.
    #[schemars(with = "Option<f64>")]
    pub largest_excess: f64,
    /// Reachable sets that could not be followed to the end; the rows from there on do not hold.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub lost: Vec<Lost>,
    /// The same for each suite.
    pub suites: Vec<SuiteVerdict>,
}

/// The verdict on one suite.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SuiteVerdict {
    /// The suite.
    pub suite: String,
    /// Number of its recordings.
    pub runs: usize,
    /// Number of its rows.
    pub rows: usize,
    /// Its rows that do not hold.
    pub violations: Violations,
    /// How many of its points were not proved, where the notion is not the hull.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub points_unproved: Option<usize>,
    /// The recordings that leave the set furthest in some row.
    pub violating_runs: Vec<String>,
}

impl SuiteVerdict {
    pub(crate) fn fails(&self) -> bool {
        self.violations.count > 0 || self.points_unproved.is_some_and(|count| count > 0)
    }
}

/// Rows that do not hold.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Violations {
    /// Their number.
    pub count: usize,
    /// The one with the largest excess, among rows that have a reachable set.
    pub worst: Option<Witness>,
}

impl Violations {
    fn take(&mut self, witness: Witness) {
        if self.worst.as_ref().is_none_or(|worst| witness.excess > worst.excess) {
            self.worst = Some(witness);
        }
    }
}

impl Verdict {
    /// Compares every row with its hull.
    ///
    /// # Guarantee
    ///
    /// When `conformant`, every recorded value was proved with directed rounding to lie in the
    /// interval hull of the reachable set at its sample; of the computed outer enclosure of that
    /// set if the model is not linear. A row within rounding of the boundary (about 1e-12 relative)
    /// that could not be proved counts as violated.
    ///
    /// # Errors
    ///
    /// As [`Problem::run`]; points of a fold that other processes have and that were not asked.
    pub fn new(problem: &Problem, tube: &Tube) -> Result<Self> {
        Self::visiting(problem, tube, |_| ())
    }

    /// Does what [`new`](Self::new) does, and hands every row to `visit` as well.
    ///
    /// # Guarantee
    ///
    /// As [`new`](Self::new).
    pub(crate) fn visiting(
        problem: &Problem,
        tube: &Tube,
        mut visit: impl FnMut(&Row),
    ) -> Result<Self> {
        // Without its points, a verdict would claim less than the notion does.
        let own = judged(problem, tube)?;
        let tube = own.as_ref().unwrap_or(tube);
        let mut suites: Vec<SuiteVerdict> =
            problem.recordings().suites.iter().map(SuiteVerdict::start).collect();
        let mut largest_excess = f64::NEG_INFINITY;
        tube.for_each_row(problem, |row| {
            suites[row.suite].take(problem, row);
            let finite = row.edges.iter().map(|edge| edge.excess).filter(|x| x.is_finite());
            largest_excess = finite.fold(largest_excess, f64::max);
            visit(row);
        })?;
        let mut violations = Violations::default();
        for suite in &suites {
            violations.count += suite.violations.count;
            suite.violations.worst.iter().for_each(|worst| violations.take(worst.clone()));
        }
        let count = |judged: &Judged| count_points(problem, tube, judged, &mut suites);
        let points = tube.judged.as_ref().map(count);
        let rows = suites.iter().map(|suite| suite.rows).sum();
        let (runs, enclosure) = (problem.recordings().run_count(), tube.enclosure);
        Ok(Self {
            conformant: rows > 0 && suites.iter().all(SuiteVerdict::holds),
            claim: claim(runs, problem, enclosure),
            enclosure,
            runs,
            rows,
            violations,
            points,
            largest_excess: if largest_excess.is_finite() { largest_excess } else { 0.0 },
            lost: tube.lost(problem)?,
            suites,
        })
    }
}

impl SuiteVerdict {
    fn start(suite: &Suite) -> Self {
        let violations = Violations::default();
        Self {
            suite: suite.entry.name.clone(),
            runs: suite.run_count(),
            rows: 0,
            violations,
            points_unproved: None,
            violating_runs: Vec::new(),
        }
    }

    /// Returns whether all rows and points of the suite were proved.
    #[must_use]
    pub fn holds(&self) -> bool {
        !self.fails()
    }

    fn take(&mut self, problem: &Problem, row: &Row) {
        self.rows += 1;
        self.violations.count += usize::from(!row.holds());
        for edge in row.edges.iter().filter(|edge| edge.excess > 0.0 && edge.excess.is_finite()) {
            let witness = Witness::new(problem, row, edge);
            if !self.violating_runs.contains(&witness.run) {
                self.violating_runs.push(witness.run.clone());
            }
            self.violations.take(witness);
        }
    }
}

fn count_points(
    problem: &Problem,
    tube: &Tube,
    judged: &Judged,
    suites: &mut [SuiteVerdict],
) -> PointVerdict {
    suites.iter_mut().for_each(|suite| suite.points_unproved = Some(0));
    let mut runs: Vec<_> = judged.unproved.iter().collect();
    runs.sort_by_key(|(owner, run)| (run.first, **owner));
    for ((suite, _), run) in runs {
        let suite = &mut suites[*suite as usize];
        suite.points_unproved = suite.points_unproved.map(|count| count + run.count);
        if !suite.violating_runs.contains(&run.file) {
            suite.violating_runs.push(run.file.clone());
        }
    }
    PointVerdict::new(problem, tube, judged)
}

fn claim(runs: usize, problem: &Problem, enclosure: Enclosure) -> String {
    let settings = problem.settings();
    let states = match settings.states {
        States::All => "position and velocity",
        States::Positions => "position",
    };
    let set = enclosure.set_name();
    let how = match enclosure {
        Enclosure::Inner => "checked with directed rounding",
        Enclosure::Outer => {
            "an enclosure of the reachable set with directed rounding, for every measurable \
             disturbance in U"
        }
    };
    let lies = settings.notion.claim_words(states, set, &problem.signals().noun);
    let until = settings.until_words();
    format!(
        "for each of the {runs} recordings, at each of its samples{until}, {lies}; {how}, at \
         samples, whose times are the recorded ones to a picosecond"
    )
}
