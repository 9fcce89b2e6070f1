use schemars::JsonSchema;
use serde::Serialize;

use crate::data::problem::Problem;
use crate::error::Result;
use crate::program::program::Program;
use crate::sets::UncertaintySets;

/// Factors by which each set alone must grow, so that a model encloses recordings that leave its
/// sets. Not proved: to rounding, with the centres where they are.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, JsonSchema)]
pub struct Growth {
    /// Factor of all radii of X0, for a linear model. `None` if no factor suffices.
    pub initial_set: Option<f64>,
    /// Factor of all radii of U, for a linear model. `None` if no factor suffices.
    pub input_set: Option<f64>,
    /// Factor of all radii of X0 and U, for a linear model. `None` if no factor suffices.
    pub both_sets: Option<f64>,
    /// What the radii of V in all positions would have to grow by, rad or m.
    pub noise_position: f64,
    /// What the radii of V in all velocities would have to grow by, rad/s or m/s.
    pub noise_velocity: f64,
}

impl Growth {
    /// Computes the growth for rows whose largest excess in each state is `excess`, 2n.
    pub(crate) fn new(problem: &Problem, sets: &UncertaintySets, excess: &[f64]) -> Result<Self> {
        let (positions, velocities) = excess.split_at(problem.inputs());
        let largest = |excess: &[f64]| excess.iter().copied().fold(0.0, f64::max);
        let [initial_set, input_set, both_sets] = match problem.dynamics().linear_system() {
            None => [None; 3],
            Some(_) => Program::of_problem(problem)?.growth_factors(sets),
        };
        let (noise_position, noise_velocity) = (largest(positions), largest(velocities));
        Ok(Self { initial_set, input_set, both_sets, noise_position, noise_velocity })
    }
}
