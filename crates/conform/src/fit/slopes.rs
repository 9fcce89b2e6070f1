//! How the rows of the program change with each parameter, by differences.

use std::sync::Arc;

use rayon::prelude::*;

use crate::error::Result;
use crate::fit::evaluation::{FitModel, FitTask, NominalModel, Smallest};
use crate::fit::group::Group;
use crate::nominal::loads::LoadsNear;
use crate::sets::UncertaintySets;

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
    let of_parameter = |p: usize| -> Result<Option<Moved>> {
        let is_held = held.contains(&fit.parameters.list[p].quantity.group());
        (!is_held).then(|| Moved::new(fit, numbers, p, (model, smallest))).transpose()
    };
    let count = fit.parameters.len();
    let moved = (0..count).into_par_iter().map(of_parameter).collect::<Result<Vec<_>>>()?;
    let here = fit.nominal(numbers)?;
    let has_loads = fit.parameters.needs_loads();
    // All parameters share the loads of gravity along a track, to first order.
    let of_track = |&t: &usize| -> Result<Vec<Vec<f64>>> {
        let along = |motion: Vec<f64>| LoadsNear::along(&here.setup.robot, &motion);
        let loads = has_loads.then(|| fit.motion(&here, t, None).map(along)).transpose()?;
        let difference = |Moved { nominal, step, .. }: &Moved| {
            let rows = fit.rows_of(&fit.motion(nominal, t, loads.as_ref())?).into_iter();
            Ok(rows.zip(&model.motions[t]).map(|(x, y)| (x - y) / step).collect())
        };
        moved.iter().flatten().map(difference).collect()
    };
    let mut of_tracks: Vec<Vec<Vec<f64>>> =
        tracks.par_iter().map(of_track).collect::<Result<_>>()?;
    let mut free = 0;
    let slope = |moved: Option<Moved>| {
        let mut motions = vec![Vec::new(); fit.data.tracks.len()];
        let Some(Moved { reach, .. }) = moved else { return Slope { motions, reach: None } };
        for (&t, own) in tracks.iter().zip(&mut of_tracks) {
            motions[t] = std::mem::take(&mut own[free]);
        }
        free += 1;
        Slope { motions, reach }
    };
    Ok(moved.into_iter().map(slope).collect())
}

/// A model with one number moved.
struct Moved {
    nominal: NominalModel,
    /// How far the number was moved.
    step: f64,
    /// As [`Slope`] has it.
    reach: Option<Vec<Vec<[f64; 2]>>>,
}

impl Moved {
    /// Moves number `p` of the model `model`, whose smallest sets are `smallest`.
    fn new(
        fit: &FitTask,
        numbers: &[f64],
        p: usize,
        (model, smallest): (&FitModel, &Smallest),
    ) -> Result<Self> {
        let mut moved = numbers.to_vec();
        let up = numbers[p] + DIFFERENCE <= fit.parameters.list[p].bounds[1];
        let step = if up { DIFFERENCE } else { -DIFFERENCE };
        moved[p] += step;
        let nominal = fit.nominal(&moved)?;
        let UncertaintySets { initial_set, input_set, .. } = &smallest.sets;
        let centre = [&*initial_set.centre, &input_set.centre].concat();
        let radius = [&*initial_set.radius, &input_set.radius].concat();
        let width = 2 * centre.len();
        let rows = |(other, here): (&Arc<Vec<f64>>, &Arc<Vec<f64>>)| {
            let rows = other.chunks_exact(width).zip(here.chunks_exact(width));
            rows.map(|(other, here)| reach_slope(other, here, &centre, &radius, step)).collect()
        };
        let changed = fit.parameters.changes_model(p).then(|| fit.coefficients(&nominal));
        let reach = changed.map(|other| other.iter().zip(&model.coefficients).map(rows).collect());
        Ok(Self { nominal, step, reach })
    }
}

fn reach_slope(other: &[f64], here: &[f64], c: &[f64], r: &[f64], step: f64) -> [f64; 2] {
    let width = c.len();
    let sum = |from: usize, values: &[f64]| -> f64 {
        let rows = other[from..from + width].iter().zip(&here[from..from + width]);
        rows.zip(values).map(|((x, y), v)| (x - y) * v).sum::<f64>() / step
    };
    [sum(0, c), sum(width, r)]
}
