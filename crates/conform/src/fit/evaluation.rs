//! The program of one choice of the parameters.

use std::sync::Arc;

use rayon::prelude::*;
use reachtube_reach::{Disturbance, TimeGrid};

use crate::data::envelope::Envelope;
use crate::data::settings::Settings;
use crate::data::setup::{Near, Parameters, Setup};
use crate::data::shape::Shape;
use crate::data::side::Side;
use crate::error::{Error, Result};
use crate::fit::data::{Data, Track};
use crate::nominal::motion::motion;
use crate::nominal::steps::LinearSteps;
use crate::program::block::Block;
use crate::program::layout::Limits;
use crate::program::program::{CLOSE, Program, RowIndex};
use crate::progress::Progress;
use crate::sets::UncertaintySets;

/// Track, sample among the rows, state, side.
pub(crate) type StepRow = (usize, usize, usize, Side);

/// The constants of a fit.
#[derive(Clone)]
pub(crate) struct FitTask<'a> {
    pub parameters: &'a dyn Parameters,
    pub data: &'a Data,
    /// Every how many samples rows are taken.
    pub stride: usize,
    /// The weights of the states, s, 2n.
    pub weights: Vec<f64>,
    pub settings: &'a Settings,
    pub limits: Limits,
    /// Who observes the fit, and may cancel it.
    pub progress: &'a dyn Progress,
}

/// The model of one choice of the parameters beside the recordings.
pub(crate) struct FitModel {
    /// For each grid, the entries of E_k and R_k at the samples that have rows, as in a [`Block`].
    pub coefficients: Vec<Arc<Vec<f64>>>,
    /// For each track, the nominal motion at the samples that have rows, samples x 2n; empty for a
    /// track that was not selected.
    pub motions: Vec<Vec<f64>>,
}

/// The model of one choice of the parameters, discretised over each grid.
pub(crate) struct NominalModel {
    pub setup: Setup,
    steps: Vec<LinearSteps>,
}

/// The smallest sets of one choice of the parameters.
#[derive(Clone)]
pub(crate) struct Smallest {
    pub sets: UncertaintySets,
    /// The cost in mean steps, in which searches compare.
    pub cost: f64,
    /// The cost, an integral over time.
    pub cost_by_time: f64,
    pub deciding: Vec<StepRow>,
}

impl FitTask<'_> {
    pub(crate) fn states(&self) -> usize {
        self.weights.len()
    }

    pub(crate) fn inputs(&self) -> usize {
        self.weights.len() / 2
    }

    /// Returns the model with these numbers and its nominal motions of `tracks`.
    ///
    /// # Errors
    ///
    /// A robot that is not physical, a model that is not linear.
    pub(crate) fn model(&self, numbers: &[f64], tracks: &[usize]) -> Result<FitModel> {
        let nominal = self.nominal(numbers)?;
        let coefficients = self.coefficients(&nominal);
        let of = |&t: &usize| Ok((t, self.motion(&nominal, t, None)?));
        let found: Vec<(usize, Vec<f64>)> = tracks.par_iter().map(of).collect::<Result<_>>()?;
        let mut motions = vec![Vec::new(); self.data.tracks.len()];
        for (t, motion) in found {
            motions[t] = self.rows_of(&motion);
        }
        Ok(FitModel { coefficients, motions })
    }

    pub(crate) fn nominal(&self, numbers: &[f64]) -> Result<NominalModel> {
        let setup = self.parameters.apply(numbers)?;
        let system = setup.dynamics.linear_system().ok_or(Error::NotLinear)?;
        let grids = self.data.grids.iter();
        let steps = grids.map(|grid| LinearSteps::new(system, grid.times())).collect();
        Ok(NominalModel { setup, steps })
    }

    /// Returns the entries of E_k and R_k of each grid, as [`FitModel`] has them.
    pub(crate) fn coefficients(&self, nominal: &NominalModel) -> Vec<Arc<Vec<f64>>> {
        let constant = self.settings.disturbance == Disturbance::Constant;
        let of = |(steps, grid): (&LinearSteps, &Arc<TimeGrid>)| {
            Arc::new(steps.coefficients(grid.len(), self.stride, constant))
        };
        nominal.steps.iter().zip(&self.data.grids).map(of).collect()
    }

    /// Returns the nominal motion of a track at every sample, samples x N; `near` is what
    /// compensations near it share, if that is known.
    pub(crate) fn motion(
        &self,
        NominalModel { setup, steps }: &NominalModel,
        track: usize,
        near: Option<&Near>,
    ) -> Result<Vec<f64>> {
        let Setup { drive, dynamics, .. } = setup;
        let Track { case, grid, .. } = &self.data.tracks[track];
        let compensation = drive.compensation(dynamics, &case.condition, near)?;
        Ok(motion(dynamics, case, Some(&steps[*grid]), compensation)?.states)
    }

    pub(crate) fn rows_of(&self, motion: &[f64]) -> Vec<f64> {
        motion.chunks_exact(self.states()).step_by(self.stride).flatten().copied().collect()
    }

    /// Returns the program of `model` for the tracks named. Its cost is over the samples of all
    /// recordings.
    pub(crate) fn program(&self, model: &FitModel, tracks: &[usize]) -> Program<'_> {
        let (stride, states) = (self.stride, self.states());
        let mut blocks: Vec<Block> = Vec::new();
        for (grid, coefficients) in self.data.grids.iter().zip(model.coefficients.iter()) {
            let times = grid.times().iter().step_by(stride).copied().collect();
            let envelope = Envelope::new(states);
            let (coefficients, scale) = (Arc::clone(coefficients), [].into());
            blocks.push(Block { times, coefficients, scale, envelope });
        }
        for &t in tracks {
            let (track, motion) = (&self.data.tracks[t], &model.motions[t]);
            let off = |bound: fn(&Envelope, usize, usize) -> f64| -> Vec<f64> {
                track
                    .samples(stride)
                    .flat_map(|k| {
                        let row = &motion[k / stride * states..][..states];
                        let value = move |i| bound(&track.case.measured, k, i) - row[i];
                        (0..states).map(value)
                    })
                    .collect()
            };
            let (lower, upper) = (off(Envelope::lower), off(Envelope::upper));
            blocks[track.grid].envelope.include_bounds(t as u32, &lower, &upper);
        }
        let shape = Shape::of_states(states, self.inputs());
        Program::new((self.settings, shape), &self.weights, blocks).with_limits(self.limits.clone())
    }

    pub(crate) fn smallest(&self, model: &FitModel, tracks: &[usize]) -> Result<Smallest> {
        self.smallest_from(model, tracks, &mut Vec::new())
    }

    /// Returns the smallest sets as [`smallest`](Self::smallest) does, with the rows `rows` first;
    /// they become the rows that nearly decide the sets.
    pub(crate) fn smallest_from(
        &self,
        model: &FitModel,
        tracks: &[usize],
        rows: &mut Vec<RowIndex>,
    ) -> Result<Smallest> {
        let program = self.program(model, tracks);
        if rows.is_empty() {
            *rows = program.first_rows();
        }
        let solution = program.solve_from(rows)?;
        let sets = program.repaired(&solution.sets);
        program.keep_close(rows, &sets, CLOSE);
        let tight = program.tight_among(rows.iter().copied(), &sets).into_iter();
        let deciding = tight.map(|row| (program.run(row) as usize, row.1, row.2, row.3)).collect();
        let (cost, cost_by_time) = (program.cost_in_steps(&sets), program.cost(&sets));
        Ok(Smallest { sets, cost, cost_by_time, deciding })
    }

    /// Returns what a row must reach in `model`: the deviation, less the known noise.
    pub(crate) fn deviation(&self, model: &FitModel, (t, k, i, side): StepRow) -> f64 {
        let track = &self.data.tracks[t];
        let (sample, states) = (k * self.stride, self.states());
        let nominal = model.motions[t][k * states + i];
        let known = self.settings.noise.known(i);
        match side {
            Side::Upper => track.case.measured.upper(sample, i) - nominal - known,
            Side::Lower => nominal - track.case.measured.lower(sample, i) - known,
        }
    }

    /// Returns the cost of the smallest sets of all tracks, as a sum over the samples of the fit.
    pub(crate) fn cost(&self, numbers: &[f64]) -> Result<f64> {
        let tracks = self.tracks(None);
        Ok(self.smallest(&self.model(numbers, &tracks)?, &tracks)?.cost)
    }

    /// Returns the cost of the smallest sets of all tracks at every sample; `None` if a nominal
    /// motion diverges.
    pub(crate) fn whole_cost(&self, numbers: &[f64]) -> Result<Option<f64>> {
        let whole = Self { stride: 1, ..self.clone() };
        let tracks = whole.tracks(None);
        match whole.model(numbers, &tracks) {
            Ok(model) => Ok(Some(whole.smallest(&model, &tracks)?.cost_by_time)),
            Err(Error::RunsAway { .. }) => Ok(None),
            Err(error) => Err(error),
        }
    }

    pub(crate) fn tracks(&self, left_out: Option<usize>) -> Vec<usize> {
        let tracks = self.data.tracks.iter().enumerate();
        tracks.filter(|(_, track)| Some(track.motion) != left_out).map(|(t, _)| t).collect()
    }
}
