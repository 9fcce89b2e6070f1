//! The weight of the pull toward the identified values, chosen by leaving one motion out.

use rayon::prelude::*;

use crate::error::Result;
use crate::fit::evaluation::FitTask;
use crate::fit::record::{PullCost, UnseenMotion};
use crate::fit::search::{Search, SearchEffort};

/// The weights that are tried, in parts of the identified model's cost per unit, the strongest
/// first.
const PULLS: [f64; 5] = [0.1, 0.03, 0.01, 0.003, 0.001];

/// Tracks of a suite that are enough to compare weights by.
const FEW: usize = 4;

/// The pull that was chosen.
pub(crate) struct PullChoice {
    pub pull: f64,
    /// Cost of the sets of all motions when one was left out of the fit.
    pub left_out: Vec<UnseenMotion>,
    /// The mean of these costs for each weight that was tried.
    pub tried: Vec<PullCost>,
}

/// Chooses among the weights, or tries `given` only: for each motion the model is fitted without
/// it, and the sets of all motions are found for that model. The weight with the least mean cost is
/// chosen.
///
/// # Errors
///
/// As [`Search::run`].
pub(crate) fn choose(fit: &FitTask, given: Option<f64>) -> Result<PullChoice> {
    let pulls = given.map_or_else(|| PULLS.to_vec(), |pull| vec![pull]);
    let of_motion = |motion: usize| leave_out(fit, motion, &pulls);
    let motions = fit.data.motions.len();
    let costs: Vec<Vec<Option<f64>>> =
        (0..motions).into_par_iter().map(of_motion).collect::<Result<_>>()?;
    let mean = |at: usize| {
        let sum: Option<f64> = costs.iter().map(|of| of[at]).sum();
        sum.map(|sum| sum / motions as f64)
    };
    let worth = |at: usize| mean(at).unwrap_or(f64::INFINITY);
    let tried: Vec<PullCost> =
        pulls.iter().enumerate().map(|(at, &pull)| PullCost { pull, cost: mean(at) }).collect();
    let best = (0..pulls.len()).min_by(|a, b| worth(*a).total_cmp(&worth(*b))).unwrap_or(0);
    let left_out = fit.data.motions.iter().zip(&costs);
    let left_out = left_out
        .map(|(motion, of)| UnseenMotion { motion: motion.clone(), cost: of[best] })
        .collect();
    Ok(PullChoice { pull: pulls[best], left_out, tried })
}

/// Fits without a motion for each weight, each from the answer before, and returns the costs of the
/// sets of all motions; `None` if a nominal motion runs away.
fn leave_out(fit: &FitTask, motion: usize, pulls: &[f64]) -> Result<Vec<Option<f64>>> {
    let tracks = fit.few_tracks(Some(motion), FEW);
    let mut numbers = fit.parameters.start();
    let identified = fit.smallest(&fit.model(&numbers, &tracks, None)?, &tracks)?.cost;
    let mut costs = Vec::new();
    for pull in pulls {
        let search = Search {
            fit,
            tracks: tracks.clone(),
            pull: pull * identified,
            held: None,
            effort: SearchEffort::QUICK,
        };
        numbers = search.run(&numbers)?.numbers;
        costs.push(fit.whole_cost(&numbers)?);
    }
    Ok(costs)
}
