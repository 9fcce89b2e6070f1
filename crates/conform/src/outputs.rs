//! The linear program for a system that is seen through its outputs.

use std::sync::Arc;

use crate::data::envelope::Envelope;
use crate::data::settings::{Centre, Settings};
use crate::data::shape::Shape;
use crate::error::Result;
use crate::program::block::Block;
use crate::program::program::Program;
use crate::sets::UncertaintySets;

/// What recordings with the same sample times need of the sets.
#[derive(Debug, Clone)]
pub struct OutputRows {
    /// Sample times, s.
    pub times: Arc<[f64]>,
    /// Samples x outputs x 2 (s + q): how far an output moves with the centre of each of s sets of
    /// the start and q sets that act later, then how much wider it becomes with the radius of each.
    pub coefficients: Vec<f64>,
    /// The highest and lowest deviation of the recordings at each sample and output.
    pub envelope: Envelope,
}

/// The smallest sets, as a program found them: nothing is proved of them yet.
#[derive(Debug, Clone)]
pub struct SmallestSets {
    /// Centre and radius of each set of the start (X0), and of each set that acts later (U).
    pub sets: UncertaintySets,
    /// The integral over time of Σ_i s_i width_i of the outputs.
    pub cost: f64,
    /// No sets cost less, to the tolerance of the solver.
    pub lower_bound: f64,
}

/// Finds sets of the least cost that hold all rows, up to rounding: `start` sets of the start and
/// `inputs` that act later. Each output has its weight in the cost.
///
/// # Errors
///
/// [`Error::Program`](crate::Error::Program) when the solver does not reach an optimum.
///
/// # Panics
///
/// If the coefficients do not fit.
pub fn smallest(
    [start, inputs]: [usize; 2],
    centre: Centre,
    weights: &[f64],
    rows: Vec<OutputRows>,
) -> Result<SmallestSets> {
    let settings = Settings { centre, ..Settings::default() };
    let shape = Shape { states: start, inputs, outputs: weights.len() };
    let block = |OutputRows { times, coefficients, envelope }: OutputRows| {
        assert_eq!(coefficients.len(), times.len() * shape.entries(), "coefficients of all rows");
        Block { times, coefficients: Arc::new(coefficients), scale: [].into(), envelope }
    };
    let blocks = rows.into_iter().map(block).collect();
    let program = Program::new((&settings, shape), weights, blocks);
    let solution = program.solve()?;
    let sets = program.repaired(&solution.sets);
    Ok(SmallestSets { cost: program.cost(&sets), lower_bound: solution.lower_bound, sets })
}
