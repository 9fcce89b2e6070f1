//! The check with directed rounding: what is reported as conformant has passed it.

use reachtube_reach::ReachSets;
use reachtube_scalar::rounding::{add_down, sub_up};

use super::deviation::{Deviation, Grid};
use super::{Side, States, UncertaintySets};

/// One row of the check: a suite's deviations at one time in one state, upward or downward.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Row {
    /// Sample index on its grid.
    pub sample: usize,
    /// Time since the first sample, s.
    pub time: f64,
    /// State, from 0: q1..qn, qd1..qdn.
    pub state: usize,
    /// Which side of the set.
    pub side: Side,
    /// The run (index in the data set) that reaches furthest.
    pub run: u32,
    /// How far the run reaches beyond the reachable set; negative inside. An upper bound, rad or
    /// rad/s.
    pub excess: f64,
    /// The radius of the reachable set there, rad or rad/s.
    pub radius: f64,
}

/// Checks every row of a deviation and hands each to `visit`. A row with `excess <= 0` is proved to
/// be enclosed.
///
/// # Guarantee
///
/// The reachable set is taken from inside and the deviation from outside, both with directed
/// rounding.
pub fn check_rows(
    grid: &Grid,
    reach: &ReachSets,
    sets: &UncertaintySets,
    states: States,
    deviation: &Deviation,
    mut visit: impl FnMut(Row),
) {
    let envelope = &deviation.envelope;
    let times = grid.propagation.grid().times();
    let checked = states.rows(envelope.dimension() / 2);
    for (k, &time) in times.iter().enumerate().take(envelope.len()) {
        for i in 0..checked {
            let noise = sets.noise_radius(i);
            let radius = reach.radius(k, i).mid() + noise;
            let row =
                |side, run, excess| Row { sample: k, time, state: i, side, run, excess, radius };
            let highest = add_down(reach.upper_inner(k, i), noise);
            visit(row(
                Side::Upper,
                envelope.upper_run(k, i),
                sub_up(envelope.upper(k, i), highest),
            ));
            let lowest = add_down(-reach.lower_inner(k, i), noise);
            visit(row(
                Side::Lower,
                envelope.lower_run(k, i),
                sub_up(-envelope.lower(k, i), lowest),
            ));
        }
    }
}
