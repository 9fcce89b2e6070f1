//! The comparison of recordings with reachable sets, with directed rounding: what is reported as
//! conformant has passed it.

use reachtube_reach::{Flowpipe, ReachSets};
use reachtube_scalar::rounding::{add_down, sub_up};

use crate::data::envelope::Envelope;
use crate::data::settings::States;
use crate::data::side::Side;
use crate::sets::UncertaintySets;

/// A radius that is as good as none, rad or rad/s.
pub(crate) const NEGLIGIBLE_RADIUS: f64 = 1e-9;

/// One row: the recordings of a suite (or of a run with an input of its own) at one time in one
/// state.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Row {
    /// Sample index on its grid.
    pub sample: usize,
    /// Time since the first sample, s.
    pub time: f64,
    /// State, from 0: q1..qn, q̇1..q̇n.
    pub state: usize,
    /// The radius of the reachable set there, rad or rad/s; infinite without one.
    pub radius: f64,
    /// The upper side, then the lower one.
    pub edges: [Edge; 2],
}

/// One side of a row.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Edge {
    /// The side.
    pub side: Side,
    /// The run (index in the source) that reaches furthest.
    pub run: u32,
    /// How far that run reaches beyond the reachable set, rad or rad/s; negative inside, infinite
    /// without a set. An upper bound.
    pub excess: f64,
}

impl Row {
    /// Returns whether both sides are proved to be enclosed. An excess that is not a number proves
    /// nothing.
    #[must_use]
    pub fn holds(&self) -> bool {
        self.edges.iter().all(|edge| edge.excess <= 0.0)
    }
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

/// The hull of a reachable set over time, as rows are compared with it.
pub(crate) trait Hull {
    /// Returns the bounds at sample `k` in state `i`; `None` if the set was lost.
    fn bounds(&self, k: usize, i: usize) -> Option<HullBounds>;
}

impl Hull for ReachSets {
    /// Inner bounds: every value between them is reachable in that state.
    fn bounds(&self, k: usize, i: usize) -> Option<HullBounds> {
        let (lower, upper) = (self.lower_inner(k, i), self.upper_inner(k, i));
        Some(HullBounds { lower, upper, radius: self.radius(k, i).mid() })
    }
}

impl Hull for Flowpipe {
    /// Outer bounds of the computed set.
    fn bounds(&self, k: usize, i: usize) -> Option<HullBounds> {
        let hull = (k < self.len()).then(|| self.sample(k)[i])?;
        Some(HullBounds { lower: hull.lo(), upper: hull.hi(), radius: hull.rad() })
    }
}

/// Compares each row of an envelope with a hull and hands it to `visit`. A row that
/// [holds](Row::holds) is proved to be enclosed.
///
/// # Guarantee
///
/// Excesses are upper bounds for the hull as its bounds are given, widened by the noise set V
/// rounded inward; directed rounding.
pub(crate) fn rows(
    envelope: &Envelope,
    times: &[f64],
    hull: &impl Hull,
    sets: &UncertaintySets,
    states: States,
    mut visit: impl FnMut(Row),
) {
    let checked = states.rows(envelope.dimension() / 2);
    for (sample, &time) in times.iter().enumerate().take(envelope.len()) {
        for state in 0..checked {
            let noise = sets.noise_radius(state);
            let bounds = hull.bounds(sample, state);
            let excess = |value: f64, reach: fn(HullBounds) -> f64| {
                bounds.map_or(f64::INFINITY, |b| sub_up(value, add_down(reach(b), noise)))
            };
            let upper = Edge {
                side: Side::Upper,
                run: envelope.upper_run(sample, state),
                excess: excess(envelope.upper(sample, state), |bounds| bounds.upper),
            };
            let lower = Edge {
                side: Side::Lower,
                run: envelope.lower_run(sample, state),
                excess: excess(-envelope.lower(sample, state), |bounds| -bounds.lower),
            };
            let radius = bounds.map_or(f64::INFINITY, |bounds| bounds.radius) + noise;
            visit(Row { sample, time, state, radius, edges: [upper, lower] });
        }
    }
}
