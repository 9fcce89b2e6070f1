//! The program of one choice of the parameters.

use rayon::prelude::*;

use crate::envelope::Envelope;
use crate::error::Result;
use crate::fitting::data::{Data, Track};
use crate::fitting::parameters::Parameters;
use crate::grids::Grids;
use crate::linear::block::Block;
use crate::linear::layout::Limits;
use crate::linear::program::Program;
use crate::nominal::motion::Corrected;
use crate::nominal::steps::Steps;
use crate::problem::problem::Setup;
use crate::sets::UncertaintySets;
use crate::settings::Settings;

/// What does not change during a fit.
pub(crate) struct Fit<'a> {
    pub parameters: Parameters<'a>,
    pub data: Data,
    /// The weights of the states, s, 2n.
    pub weights: Vec<f64>,
    pub settings: &'a Settings,
    pub limits: Limits,
}

/// The model of one choice of the parameters beside the recordings.
pub(crate) struct Model {
    /// For each grid, the entries of E_k and R_k at the samples that are rows, as in a [`Block`].
    pub coefficients: Vec<Vec<f64>>,
    /// For each track, the nominal motion at the samples that are rows, samples x 2n.
    pub motions: Vec<Vec<f64>>,
}

/// The smallest sets of one choice of the parameters.
pub(crate) struct Smallest {
    pub sets: UncertaintySets,
    pub cost: f64,
}

impl Fit<'_> {
    /// Returns the number of joints.
    pub fn joints(&self) -> usize {
        self.weights.len() / 2
    }

    /// Returns the model with these numbers; `known` is one whose E_k and R_k are the same.
    ///
    /// # Errors
    ///
    /// A robot that is not physical, a motion that runs away.
    pub fn model(&self, numbers: &[f64], known: Option<&Model>) -> Result<Model> {
        let setup = self.parameters.apply(numbers)?;
        let coefficients = match known {
            Some(model) => model.coefficients.clone(),
            None => self.coefficients(&setup)?,
        };
        Ok(Model { coefficients, motions: self.motions(&setup)? })
    }

    fn coefficients(&self, setup: &Setup) -> Result<Vec<Vec<f64>>> {
        let system = setup.dynamics.linear_system().ok_or(crate::error::Error::NotLinear)?;
        let times = self.data.grids.iter().map(AsRef::as_ref);
        let grids = Grids::new(times, system, self.settings.disturbance)?;
        let n = self.joints();
        let blocks = Block::of_grids(grids.as_slice(), &[], n);
        let width = 2 * n * 6 * n;
        let thin = |grid: &reachtube_reach::TimeGrid| {
            let block = &blocks[grids.find(grid)];
            let samples = block.coefficients.chunks_exact(width).step_by(self.data.stride);
            samples.flatten().copied().collect()
        };
        Ok(self.data.grids.iter().map(|grid| thin(grid)).collect())
    }

    fn motions(&self, setup: &Setup) -> Result<Vec<Vec<f64>>> {
        let system = setup.dynamics.linear_system();
        let steps: Vec<Option<Steps>> = self
            .data
            .grids
            .iter()
            .map(|grid| system.map(|system| Steps::new(system, grid.times())))
            .collect();
        let origin = &setup.settings.expansion_point.qd;
        let none = crate::nominal::correction::InputCorrection::none(self.joints());
        let correction = setup.correction.as_ref().unwrap_or(&none);
        let (robot, dynamics) = (&setup.robot, &setup.dynamics);
        let corrected = Corrected { robot, dynamics, correction, origin };
        let width = 2 * self.joints();
        let of = |track: &Track| {
            let states = corrected.motion(&track.case, steps[track.grid].as_ref())?.states;
            let rows = states.chunks_exact(width).step_by(self.data.stride);
            Ok(rows.flatten().copied().collect())
        };
        self.data.tracks.par_iter().map(of).collect()
    }

    /// Returns the program of `model` for the tracks named.
    pub fn program(&self, model: &Model, tracks: &[usize]) -> Program<'_> {
        let (stride, states) = (self.data.stride, 2 * self.joints());
        let mut blocks: Vec<Block> = Vec::new();
        for (grid, coefficients) in self.data.grids.iter().zip(&model.coefficients) {
            let times = grid.times().iter().step_by(stride).copied().collect();
            let envelope = Envelope::new(states);
            blocks.push(Block { times, coefficients: coefficients.clone(), envelope });
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
        blocks.retain(|block| !block.envelope.is_empty());
        for block in &mut blocks {
            let samples = block.envelope.len();
            block.times.truncate(samples);
            block.coefficients.truncate(samples * states * 3 * states);
        }
        Program::new(self.settings, &self.weights, blocks).with_limits(self.limits.clone())
    }

    /// Returns the smallest sets of `model` for the tracks named.
    ///
    /// # Errors
    ///
    /// As [`Program::solve`].
    pub fn smallest(&self, model: &Model, tracks: &[usize]) -> Result<Smallest> {
        let program = self.program(model, tracks);
        let solution = program.solve()?;
        let sets = program.repaired(&solution.sets);
        Ok(Smallest { cost: program.cost(&sets), sets })
    }

    /// Returns the tracks of all motions but `left_out`.
    pub fn tracks(&self, left_out: Option<usize>) -> Vec<usize> {
        let tracks = self.data.tracks.iter().enumerate();
        tracks.filter(|(_, track)| Some(track.motion) != left_out).map(|(t, _)| t).collect()
    }
}
