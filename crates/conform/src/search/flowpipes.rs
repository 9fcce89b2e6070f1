//! The reachable sets that decide: outer enclosures over each case.

use rayon::prelude::*;
use reachtube_reach::{
    Flowpipe, FlowpipeOutcome, FlowpipeSettings, PolynomialSystem, UncertainInput,
};
use reachtube_scalar::rounding::{add_down, sub_up};

use super::case::Case;
use crate::error::Result;
use crate::program::shares;
use crate::{Lost, Row, Side, States, UncertaintySets};
use reachtube_recordings::state_name;

/// Corners at which remainders are bounded, one number after the other while a set is lost: with 14
/// a step takes four times as long as with 8, with 18 a hundred times.
const CORNERS: [usize; 3] = [8, 14, 18];

/// How hard to try where a set is lost.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Effort {
    /// Once: for candidates.
    Quick,
    /// With tighter and tighter remainders: for what decides.
    Whole,
}

/// The flowpipe of each case under `sets`, on all cores.
///
/// # Guarantee
///
/// Outer, as [`Flowpipe`], for any measurable disturbance with values in U.
///
/// # Errors
///
/// Where sizes do not fit.
pub fn flowpipes(
    system: &PolynomialSystem,
    cases: &[Case],
    sets: &UncertaintySets,
    effort: Effort,
) -> Result<Vec<Flowpipe>> {
    cases.par_iter().map(|case| flowpipe(system, case, sets, effort)).collect()
}

/// That which comes furthest.
fn flowpipe(
    system: &PolynomialSystem,
    case: &Case,
    sets: &UncertaintySets,
    effort: Effort,
) -> Result<Flowpipe> {
    let input = UncertainInput { measured: &case.inputs, set: &sets.input_set };
    let with = |corners: usize| {
        let settings = FlowpipeSettings { corners, ..FlowpipeSettings::default() };
        Flowpipe::new(system, &case.grid, &case.start, &sets.initial_set, &input, &settings)
    };
    let mut furthest = with(CORNERS[0])?;
    for corners in &CORNERS[1..] {
        if furthest.is_reached() || effort == Effort::Quick {
            break;
        }
        let tighter = with(*corners)?;
        if tighter.len() > furthest.len() {
            furthest = tighter;
        }
    }
    Ok(furthest)
}

/// Where the reachable set of a case could not be followed further.
pub fn lost(case: &Case, flowpipe: &Flowpipe) -> Option<Lost> {
    match flowpipe.outcome() {
        FlowpipeOutcome::Reached => None,
        FlowpipeOutcome::Failed { time, state, .. } => {
            let (case, state) = (case.name.clone(), state_name(*state, case.joints()));
            Some(Lost { case, time: *time, state })
        }
    }
}

/// Checks every row of a case and hands each to `visit`, as
/// [`check_rows`](crate::check_rows) does for a linear system. Where there is no reachable
/// set any more, the excess is infinite.
///
/// # Guarantee
///
/// A row with `excess <= 0` is in the outer enclosure of the reachable set, widened by the noise
/// set rounded inward.
pub fn check_outer(
    case: &Case,
    flowpipe: &Flowpipe,
    sets: &UncertaintySets,
    states: States,
    mut visit: impl FnMut(Row),
) {
    for (k, &time) in case.grid.times().iter().enumerate().take(case.measured.len()) {
        for i in 0..states.rows(case.joints()) {
            let noise = sets.noise_radius(i);
            let hull = (k < flowpipe.len()).then(|| flowpipe.sample(k)[i]);
            let radius = hull.map_or(f64::INFINITY, |hull| hull.rad()) + noise;
            let row =
                |side, run, excess| Row { sample: k, time, state: i, side, run, excess, radius };
            let excess =
                |of: &dyn Fn(reachtube_scalar::Interval) -> f64| hull.map_or(f64::INFINITY, of);
            let upper =
                excess(&|hull| sub_up(case.measured.upper(k, i), add_down(hull.hi(), noise)));
            visit(row(Side::Upper, case.measured.upper_run(k, i), upper));
            let lower =
                excess(&|hull| sub_up(-case.measured.lower(k, i), add_down(-hull.lo(), noise)));
            visit(row(Side::Lower, case.measured.lower_run(k, i), lower));
        }
    }
}

/// Σ_k Σ_i s_i width_i(t_k) of the reachable sets with the noise set, cases at one time counting by
/// their mean; and Σ_k Δt Π_i width_i(t_k), eq. (2) of the paper. Infinite where a set was lost.
pub fn sums(
    cases: &[Case],
    flowpipes: &[Flowpipe],
    sets: &UncertaintySets,
    weights: &[f64],
) -> (f64, f64) {
    let shares = shares(cases.iter().map(|case| case.grid.times()));
    let (mut cost, mut volume) = (0.0, 0.0);
    for ((case, flowpipe), shares) in cases.iter().zip(flowpipes).zip(&shares) {
        let times = case.grid.times();
        for (k, share) in shares.iter().enumerate() {
            if k >= flowpipe.len() {
                return (f64::INFINITY, f64::INFINITY);
            }
            let widths = flowpipe.sample(k).iter().map(|hull| hull.width()).enumerate();
            let widths = widths.map(|(i, width)| width + 2.0 * sets.noise_radius(i));
            cost += share
                * widths.clone().zip(weights).map(|(width, weight)| weight * width).sum::<f64>();
            let next = times.get(k + 1).unwrap_or(&times[k]);
            volume += share * widths.product::<f64>() * (next - times[k]);
        }
    }
    (cost, volume)
}
