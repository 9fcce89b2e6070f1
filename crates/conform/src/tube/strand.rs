//! The reachable sets over one sequence of sample times.

use std::sync::Arc;

use reachtube_reach::{Flowpipe, FlowpipeOutcome, ReachSets, TimeGrid};
use reachtube_recordings::State;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::data::case::Case;
use crate::data::runaway::Runaway;
use crate::sets::UncertaintySets;
use crate::tube::grids::Grid;

/// A reachable set that could not be followed to the end: the model may diverge under its
/// uncertainty or without any, or the enclosure grew too wide.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Lost {
    /// The suite, and the run if it has an input of its own.
    pub case: String,
    /// The last sample time that has a reachable set, s.
    pub time: f64,
    /// The state that grew fastest there.
    pub state: State,
    /// Whether the nominal motion itself diverges there.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub nominal: bool,
}

/// The reachable sets on one grid of a linear model, or along one case of any other.
#[derive(Debug)]
pub(crate) struct Strand {
    pub times: Arc<TimeGrid>,
    /// The number of cases whose sets these are, where U is scaled; otherwise 1.
    pub cases: usize,
    /// The sets at the samples.
    pub hull: Hull,
    /// The early end of the sets, if any.
    pub lost: Option<Lost>,
}

/// The interval hulls of reachable sets over time.
#[derive(Debug)]
pub(crate) enum Hull {
    /// Hulls of the deviation from the nominal motion, bounded from inside too.
    Deviation(ReachSets),
    /// Enclosures of the state.
    State(Flowpipe),
}

/// The interval hull of a reachable set in one state at one sample.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct HullBounds {
    /// The lower bound that a row may use, rad or rad/s.
    pub lower: f64,
    /// The upper bound that a row may use.
    pub upper: f64,
    /// The radius.
    pub radius: f64,
}

impl Strand {
    pub(crate) fn on_grid(grid: &Grid, sets: &UncertaintySets) -> Self {
        let (times, hull) = (Arc::clone(&grid.times), Hull::Deviation(grid.reach(sets)));
        Self { times, cases: 1, hull, lost: None }
    }

    pub(crate) fn along(case: &Case, flowpipe: Flowpipe) -> Self {
        let lost = match flowpipe.outcome() {
            FlowpipeOutcome::Reached => None,
            FlowpipeOutcome::Failed { time, state, .. } => {
                let state = State::from_index(*state, case.parts());
                Some(Lost { case: case.name.clone(), time: *time, state, nominal: false })
            }
        };
        Self { times: Arc::clone(&case.grid), cases: 1, hull: Hull::State(flowpipe), lost }
    }

    pub(crate) fn deviation(&self) -> Option<&ReachSets> {
        match &self.hull {
            Hull::Deviation(reach) => Some(reach),
            Hull::State(_) => None,
        }
    }

    pub(crate) fn flowpipe(&self) -> Option<&Flowpipe> {
        match &self.hull {
            Hull::Deviation(_) => None,
            Hull::State(flowpipe) => Some(flowpipe),
        }
    }

    /// Returns whether another strand is on the same grid, with U at another scale.
    pub(crate) fn shares(&self, other: &Self) -> bool {
        self.deviation().is_some() && Arc::ptr_eq(&self.times, &other.times)
    }

    /// Returns the last sample and its time, s.
    pub(crate) fn end(&self) -> (usize, f64) {
        let times = self.times.times();
        (times.len().saturating_sub(1), times.last().copied().unwrap_or(0.0))
    }
}

impl From<&Runaway> for Lost {
    fn from(Runaway { case, time, state, .. }: &Runaway) -> Self {
        Self { case: case.clone(), time: *time, state: *state, nominal: true }
    }
}

impl Hull {
    pub(crate) fn len(&self) -> usize {
        match self {
            Self::Deviation(reach) => reach.len(),
            Self::State(flowpipe) => flowpipe.len(),
        }
    }

    /// Returns the bounds at sample `k` in state `i`; `None` if the set was lost.
    ///
    /// # Guarantee
    ///
    /// Inner for a deviation: every value between the bounds is reachable in that state. Outer for
    /// a state.
    pub(crate) fn bounds(&self, k: usize, i: usize) -> Option<HullBounds> {
        match self {
            Self::Deviation(reach) => {
                let (lower, upper) = (reach.lower_inner(k, i), reach.upper_inner(k, i));
                Some(HullBounds { lower, upper, radius: reach.radius(k, i).mid() })
            }
            Self::State(flowpipe) => {
                let hull = (k < flowpipe.len()).then(|| flowpipe.sample(k)[i])?;
                Some(HullBounds { lower: hull.lo(), upper: hull.hi(), radius: hull.rad() })
            }
        }
    }
}
