use reachtube_reach::{Flowpipe, FlowpipeOutcome, ReachSets, TimeGrid};
use reachtube_recordings::State;
use serde::{Deserialize, Serialize};

use crate::data::case::Case;
use crate::data::problem::Problem;
use crate::data::runaway::Runaway;
use crate::error::Result;
use crate::sets::UncertaintySets;
use crate::tube::judged::{At, Judged};
use crate::tube::rows::{Hull, Row, rows};

/// The reachable set that recordings are compared with.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Enclosure {
    /// The hull of the set, taken from inside: a value in it is reachable in that state.
    #[default]
    Inner,
    /// A computed set around the reachable set: what a formal analysis uses, and all that can be
    /// computed for a model that is not linear.
    Outer,
}

impl Enclosure {
    /// Returns the set's name for messages.
    #[must_use]
    pub fn set_name(self) -> &'static str {
        match self {
            Self::Inner => "reachable set",
            Self::Outer => "computed outer set",
        }
    }
}

/// A reachable set that could not be followed to the end: the model may run away under its
/// uncertainty or without any, or the enclosure grew too wide.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Lost {
    /// The suite, and the run where it has an input of its own.
    pub case: String,
    /// The last sample time that has a reachable set, s.
    pub time: f64,
    /// The state that grew fastest there.
    pub state: State,
    /// Whether the nominal motion itself runs away there.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub nominal: bool,
}

/// The interval hulls of the reachable sets of a problem's model under some uncertainty sets.
#[derive(Debug)]
pub struct Hulls {
    /// The uncertainty sets.
    pub sets: UncertaintySets,
    /// The hulls.
    pub(crate) kind: HullKind,
    /// What was found about the recorded points in the sets, once they were judged.
    pub(crate) judged: Option<Judged>,
}

/// Hulls by the kind of model.
#[derive(Debug)]
pub(crate) enum HullKind {
    /// Sets of the deviation of a linear model, on each of the problem's grids.
    Linear(Vec<ReachSets>),
    /// Sets of the state of any other model, for each of the problem's cases.
    Outer(Vec<Flowpipe>),
}

impl Hulls {
    /// Takes computed sets, in which no point was judged.
    pub(crate) fn of(sets: UncertaintySets, kind: HullKind) -> Self {
        Self { sets, kind, judged: None }
    }

    /// Returns whether the set at a sample was computed.
    pub(crate) fn reaches(&self, at: At) -> bool {
        match &self.kind {
            HullKind::Linear(_) => true,
            HullKind::Outer(flowpipes) => (at.1 as usize) < flowpipes[at.0 as usize].len(),
        }
    }

    /// Returns the radii of the interval hull at a sample with the noise set, 2n.
    pub(crate) fn radii(&self, at: At) -> Vec<f64> {
        let bounds = |i: usize| match &self.kind {
            HullKind::Linear(reach) => reach[at.0 as usize].bounds(at.1 as usize, i),
            HullKind::Outer(flowpipes) => flowpipes[at.0 as usize].bounds(at.1 as usize, i),
        };
        let radius = |i: usize| {
            bounds(i).map_or(f64::INFINITY, |bounds| bounds.radius) + self.sets.noise_radius(i)
        };
        (0..self.sets.initial_set.dimension()).map(radius).collect()
    }

    /// Returns the end of the longest recording, s, and the radii of the interval hull with the
    /// noise set at the end of each recording, the largest in each state, 2n; infinite where a
    /// reachable set ends early.
    ///
    /// # Errors
    ///
    /// As [`Problem::run`].
    pub(crate) fn at_end(&self, problem: &Problem) -> Result<(f64, Vec<f64>)> {
        let ends: Vec<(usize, f64)> = match &self.kind {
            HullKind::Linear(_) => {
                let grids = problem.grids()?.as_slice().iter();
                grids.map(|grid| end(grid.propagation.grid())).collect()
            }
            HullKind::Outer(_) => problem.cases()?.iter().map(|case| end(&case.grid)).collect(),
        };
        let mut all = (0.0f64, vec![0.0f64; self.sets.initial_set.dimension()]);
        for (strand, (sample, time)) in (0..).zip(ends) {
            let at = (strand, sample as u32);
            let radii =
                if self.reaches(at) { self.radii(at) } else { vec![f64::INFINITY; all.1.len()] };
            all.0 = all.0.max(time);
            all.1
                .iter_mut()
                .zip(radii)
                .for_each(|(largest, radius)| *largest = largest.max(radius));
        }
        Ok(all)
    }

    /// Returns the flowpipes of the cases of a model that is not linear; none of any other.
    pub(crate) fn flowpipes(&self) -> &[Flowpipe] {
        match &self.kind {
            HullKind::Linear(_) => &[],
            HullKind::Outer(flowpipes) => flowpipes,
        }
    }

    /// Returns the time of a sample, s.
    ///
    /// # Errors
    ///
    /// As [`Problem::run`].
    pub(crate) fn time(&self, problem: &Problem, (strand, sample): At) -> Result<f64> {
        let strand = strand as usize;
        let grid = match &self.kind {
            HullKind::Linear(_) => problem.grids()?.as_slice()[strand].propagation.grid(),
            HullKind::Outer(_) => &*problem.cases()?[strand].grid,
        };
        Ok(grid.times()[sample as usize])
    }

    /// Returns which bound of the reachable set recordings are compared with.
    #[must_use]
    pub fn enclosure(&self) -> Enclosure {
        match self.kind {
            HullKind::Linear(_) => Enclosure::Inner,
            HullKind::Outer(_) => Enclosure::Outer,
        }
    }

    /// Hands every row of every suite to `visit`, with the index of the suite and, where hulls
    /// belong to cases, of the case.
    ///
    /// # Guarantee
    ///
    /// As [`rows`]: deviations of a linear model are outer and its hulls inner; for any other model
    /// measured states are compared with the outer enclosure.
    ///
    /// # Errors
    ///
    /// As [`Problem::run`].
    pub(crate) fn for_each_row(
        &self,
        problem: &Problem,
        mut visit: impl FnMut(usize, Option<usize>, Row),
    ) -> Result<()> {
        let states = problem.settings().states;
        match &self.kind {
            HullKind::Linear(reach) => {
                let grids = problem.grids()?.as_slice();
                for deviation in &problem.deviations_until()?.all {
                    let times = grids[deviation.grid].propagation.grid().times();
                    let (suite, hull) = (deviation.suite, &reach[deviation.grid]);
                    rows(&deviation.envelope, times, hull, &self.sets, states, |row| {
                        visit(suite, None, row);
                    });
                }
            }
            HullKind::Outer(outer) => {
                for (index, (case, flowpipe)) in problem.cases()?.iter().zip(outer).enumerate() {
                    let times = case.grid.times();
                    rows(&case.measured, times, flowpipe, &self.sets, states, |row| {
                        visit(case.suite, Some(index), row);
                    });
                }
            }
        }
        Ok(())
    }

    /// Returns the cases whose reachable set, or whose nominal motion, could not be followed to the
    /// end.
    ///
    /// # Errors
    ///
    /// As [`Problem::run`].
    pub(crate) fn lost(&self, problem: &Problem) -> Result<Vec<Lost>> {
        match &self.kind {
            HullKind::Linear(_) => {
                let runaways = &problem.deviations_until()?.runaways;
                Ok(runaways.iter().map(Lost::from).collect())
            }
            HullKind::Outer(outer) => {
                let pairs = problem.cases()?.iter().zip(outer);
                Ok(pairs.filter_map(|(case, flowpipe)| Lost::new(case, flowpipe)).collect())
            }
        }
    }
}

/// Returns the last sample of a grid and its time, s.
fn end(grid: &TimeGrid) -> (usize, f64) {
    (grid.times().len().saturating_sub(1), grid.times().last().copied().unwrap_or(0.0))
}

impl From<&Runaway> for Lost {
    fn from(Runaway { case, time, state, .. }: &Runaway) -> Self {
        Self { case: case.clone(), time: *time, state: *state, nominal: true }
    }
}

impl Lost {
    /// Returns where the reachable set of a case ends, if it ends too early.
    #[must_use]
    pub(crate) fn new(case: &Case, flowpipe: &Flowpipe) -> Option<Self> {
        match flowpipe.outcome() {
            FlowpipeOutcome::Reached => None,
            FlowpipeOutcome::Failed { time, state, .. } => {
                let state = State::from_index(*state, case.joints());
                Some(Self { case: case.name.clone(), time: *time, state, nominal: false })
            }
        }
    }
}
