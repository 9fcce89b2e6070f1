//! The program of a linear model and its recordings.

use crate::data::problem::Problem;
use crate::error::Result;
use crate::program::block::Block;
use crate::program::program::Program;

impl<'a> Program<'a> {
    /// Returns the program of a linear model and its recordings.
    pub(crate) fn of_problem(problem: &'a Problem) -> Result<Self> {
        let (settings, shape) = (problem.settings(), problem.shape());
        let (grids, deviations) = (problem.grids()?, problem.deviations()?);
        let weights = settings.weights.of_states(shape.states);
        let blocks = Block::of_places(grids.as_slice(), &problem.places()?, deviations);
        Ok(Self::new((settings, shape), &weights, blocks).with_limits(problem.limits()))
    }
}
