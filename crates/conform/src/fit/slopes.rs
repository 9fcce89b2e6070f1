//! How the rows of the program change with each parameter, by differences.

use std::sync::Arc;

use rayon::prelude::*;

use crate::error::Result;
use crate::fit::evaluation::{FitModel, FitTask, Smallest};
use crate::fit::group::Group;

/// The step of a difference, in the numbers of the parameters.
const DIFFERENCE: f64 = 1e-4;

/// The derivatives with respect to one parameter.
pub(crate) struct Slope {
    /// Slopes of each track's nominal motion, samples x 2n.
    pub motions: Vec<Vec<f64>>,
    /// Slopes of E_k c and R_k r, for each grid samples x 2n pairs; `None` if they do not change.
    pub reach: Option<Vec<Vec<[f64; 2]>>>,
}

/// Returns the derivatives for `tracks` at `numbers`, where the model is `model` and its smallest
/// sets are `smallest`, one for each parameter; none for parameters of the groups `held`.
///
/// # Errors
///
/// As [`FitTask::model`].
pub(crate) fn slopes(
    fit: &FitTask,
    (numbers, held): (&[f64], &[Group]),
    tracks: &[usize],
    model: &FitModel,
    smallest: &Smallest,
) -> Result<Vec<Slope>> {
    let n = fit.joints();
    let set = |pick: fn(&reachtube_reach::Hyperrectangle) -> &Vec<f64>| -> Vec<f64> {
        let sets = &smallest.sets;
        pick(&sets.initial_set).iter().chain(pick(&sets.input_set)).copied().collect()
    };
    let (centre, radius) = (set(|s| &s.centre), set(|s| &s.radius));
    let of = |p: usize| {
        if held.contains(&fit.parameters.list[p].quantity.group()) {
            return Ok(Slope { motions: Vec::new(), reach: None });
        }
        let mut moved = numbers.to_vec();
        let up = numbers[p] + DIFFERENCE <= fit.parameters.list[p].bounds[1];
        let step = if up { DIFFERENCE } else { -DIFFERENCE };
        moved[p] += step;
        let changes = fit.parameters.changes_model(p);
        let other = fit.model(&moved, tracks, (!changes).then_some(model))?;
        let pairs = other.motions.iter().zip(&model.motions);
        let difference = |(other, here): (&Vec<f64>, &Vec<f64>)| {
            other.iter().zip(here).map(|(x, y)| (x - y) / step).collect()
        };
        let motions = pairs.map(difference).collect();
        let rows = |(other, here): (&Arc<Vec<f64>>, &Arc<Vec<f64>>)| {
            let rows = other.chunks_exact(6 * n).zip(here.chunks_exact(6 * n));
            rows.map(|(other, here)| reach_slope(other, here, &centre, &radius, step)).collect()
        };
        let reach = changes
            .then(|| other.coefficients.iter().zip(model.coefficients.iter()).map(rows).collect());
        Ok(Slope { motions, reach })
    };
    (0..fit.parameters.len()).into_par_iter().map(of).collect()
}

fn reach_slope(other: &[f64], here: &[f64], c: &[f64], r: &[f64], step: f64) -> [f64; 2] {
    let width = c.len();
    let sum = |from: usize, values: &[f64]| -> f64 {
        let rows = other[from..from + width].iter().zip(&here[from..from + width]);
        rows.zip(values).map(|((x, y), v)| (x - y) * v).sum::<f64>() / step
    };
    [sum(0, c), sum(width, r)]
}
