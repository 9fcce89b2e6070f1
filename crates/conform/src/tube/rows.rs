//! The comparison of recordings with reachable sets, with directed rounding: what is reported as
//! conformant has passed it.

use reachtube_scalar::rounding::{add_down, sub_up};

use crate::data::case::Case;
use crate::data::envelope::Envelope;
use crate::data::problem::Problem;
use crate::data::settings::States;
use crate::data::side::Side;
use crate::error::Result;
use crate::sets::UncertaintySets;
use crate::tube::deviation::Deviation;
use crate::tube::strand::{HullBounds, Strand};

/// A radius that is as good as none, rad or rad/s.
pub(crate) const NEGLIGIBLE_RADIUS: f64 = 1e-9;

/// One row: the recordings of a suite (or of a run with an input of its own) at one time in one
/// state.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Row {
    pub suite: usize,
    pub strand: usize,
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
pub(crate) struct Edge {
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
    pub(crate) fn holds(&self) -> bool {
        self.edges.iter().all(|edge| edge.excess <= 0.0)
    }
}

/// Recorded values beside the sets of a strand: deviations of a linear model, states of any other.
pub(crate) struct RecordedBounds<'a> {
    pub suite: usize,
    pub strand: usize,
    /// The values; each bound is outer.
    pub envelope: &'a Envelope,
}

impl<'a> RecordedBounds<'a> {
    pub(crate) fn all(problem: &'a Problem) -> Result<Vec<Self>> {
        let of_grid = |deviation: &'a Deviation| Self {
            suite: deviation.suite,
            strand: deviation.strand,
            envelope: &deviation.envelope,
        };
        Ok(match problem.dynamics().linear_system() {
            Some(_) => problem.deviations_until()?.all.iter().map(of_grid).collect(),
            None => problem.cases()?.iter().enumerate().map(Self::of_case).collect(),
        })
    }

    pub(crate) fn of_case((strand, case): (usize, &'a Case)) -> Self {
        Self { suite: case.suite, strand, envelope: &case.measured }
    }
}

/// Returns how far the highest and the lowest value of a row reach beyond a hull that is widened by
/// the radius `noise` of V: above it and below it.
///
/// # Guarantee
///
/// Upper bounds, directed rounding.
pub(crate) fn excesses(bounds: HullBounds, noise: f64, [highest, lowest]: [f64; 2]) -> [f64; 2] {
    [(highest, bounds.upper), (-lowest, -bounds.lower)]
        .map(|(value, reach)| sub_up(value, add_down(reach, noise)))
}

/// Compares each row of recorded values with a strand and hands it to `visit`. A row that
/// [holds](Row::holds) is proved to be enclosed.
///
/// # Guarantee
///
/// Excesses are upper bounds for the hull as its bounds are given, widened by the noise set V
/// rounded inward; directed rounding.
pub(crate) fn rows(
    recorded: &RecordedBounds,
    Strand { times, hull, .. }: &Strand,
    sets: &UncertaintySets,
    states: States,
    mut visit: impl FnMut(&Row),
) {
    let &RecordedBounds { suite, strand, envelope } = recorded;
    let checked = states.rows(envelope.dimension());
    for (sample, &time) in times.times().iter().enumerate().take(envelope.len()) {
        for state in 0..checked {
            let noise = sets.noise_radius(state);
            let bounds = hull.bounds(sample, state);
            let values = [envelope.upper(sample, state), envelope.lower(sample, state)];
            let [above, below] =
                bounds.map_or([f64::INFINITY; 2], |bounds| excesses(bounds, noise, values));
            let upper =
                Edge { side: Side::Upper, run: envelope.upper_run(sample, state), excess: above };
            let lower =
                Edge { side: Side::Lower, run: envelope.lower_run(sample, state), excess: below };
            let radius = bounds.map_or(f64::INFINITY, |bounds| bounds.radius) + noise;
            let edges = [upper, lower];
            visit(&Row { suite, strand, sample, time, state, radius, edges });
        }
    }
}
