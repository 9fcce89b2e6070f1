//! How the rows of the program change with each parameter, by differences.

use std::sync::Arc;

use rayon::prelude::*;

use crate::error::Result;
use crate::fit::evaluation::{FitModel, FitTask, NominalModel, Smallest};
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

/// The derivatives at some numbers, for the tracks that were added.
pub(crate) struct Slopes<'a> {
    fit: &'a FitTask<'a>,
    here: (NominalModel, &'a FitModel),
    /// One for each parameter; `None` for one that is held.
    moved: Vec<Option<Moved>>,
    /// One for each parameter; without motions for one that is held.
    pub list: Vec<Slope>,
}

impl<'a> Slopes<'a> {
    /// Prepares the derivatives at `numbers`, where the model is `model` and its smallest sets are
    /// `smallest`, for the parameters `free`.
    pub(crate) fn new(
        fit: &'a FitTask<'a>,
        (numbers, free): (&[f64], &[usize]),
        model: &'a FitModel,
        smallest: &Smallest,
    ) -> Result<Self> {
        let of_parameter = |p: usize| {
            if !free.contains(&p) {
                return Ok((None, None));
            }
            let moved = Moved::new(fit, numbers, p)?;
            let changes = fit.parameters.list()[p].changes_system;
            let reach = changes.then(|| moved.reach(fit, model, smallest));
            Ok((Some(moved), reach))
        };
        let all = (0..fit.parameters.len()).into_par_iter().map(of_parameter);
        let (moved, reach): (Vec<_>, Vec<_>) = all.collect::<Result<Vec<_>>>()?.into_iter().unzip();
        let none = || vec![Vec::new(); fit.data.tracks.len()];
        let list = reach.into_iter().map(|reach| Slope { motions: none(), reach }).collect();
        Ok(Self { fit, here: (fit.nominal(numbers)?, model), moved, list })
    }

    pub(crate) fn add(&mut self, tracks: &[usize]) -> Result<()> {
        let Self { fit, here: (here, model), moved, list } = self;
        let has_near = fit.parameters.has_near();
        // All parameters share what compensations near a track share, to first order.
        let of_track = |&t: &usize| -> Result<Vec<Vec<f64>>> {
            let along = |motion: Vec<f64>| here.setup.drive.near(&motion);
            let near =
                has_near.then(|| fit.motion(here, t, None).map(along)).transpose()?.flatten();
            let difference = |moved: &Option<Moved>| {
                let Some(Moved { nominal, step }) = moved else { return Ok(Vec::new()) };
                let rows = fit.rows_of(&fit.motion(nominal, t, near.as_ref())?).into_iter();
                Ok(rows.zip(&model.motions[t]).map(|(x, y)| (x - y) / step).collect())
            };
            moved.iter().map(difference).collect()
        };
        let of_tracks = tracks.par_iter().map(of_track).collect::<Result<Vec<_>>>()?;
        for (&t, of_parameters) in tracks.iter().zip(of_tracks) {
            for (slope, motion) in list.iter_mut().zip(of_parameters) {
                slope.motions[t] = motion;
            }
        }
        Ok(())
    }
}

/// A model with one number moved.
struct Moved {
    nominal: NominalModel,
    /// How far the number was moved.
    step: f64,
}

impl Moved {
    fn new(fit: &FitTask, numbers: &[f64], p: usize) -> Result<Self> {
        let mut moved = numbers.to_vec();
        let up = numbers[p] + DIFFERENCE <= fit.parameters.list()[p].bounds[1];
        let step = if up { DIFFERENCE } else { -DIFFERENCE };
        moved[p] += step;
        Ok(Self { nominal: fit.nominal(&moved)?, step })
    }

    /// Returns the slopes of E_k c and R_k r, as [`Slope`] has them.
    fn reach(&self, fit: &FitTask, model: &FitModel, smallest: &Smallest) -> Vec<Vec<[f64; 2]>> {
        let UncertaintySets { initial_set, input_set, .. } = &smallest.sets;
        let centre = [&*initial_set.centre, &input_set.centre].concat();
        let radius = [&*initial_set.radius, &input_set.radius].concat();
        let width = 2 * centre.len();
        let rows = |(other, here): (&Arc<Vec<f64>>, &Arc<Vec<f64>>)| {
            let rows = other.chunks_exact(width).zip(here.chunks_exact(width));
            rows.map(|(other, here)| reach_slope(other, here, &centre, &radius, self.step))
                .collect()
        };
        fit.coefficients(&self.nominal).iter().zip(&model.coefficients).map(rows).collect()
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
