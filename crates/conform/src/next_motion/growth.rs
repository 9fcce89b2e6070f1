use std::slice::from_ref;

use schemars::JsonSchema;
use serde::Serialize;

use crate::data::problem::Problem;
use crate::error::Result;
use crate::program::program::Program;
use crate::sets::UncertaintySets;

/// Factors by which each set alone must grow, so that a model encloses recordings that leave its
/// sets. Not proved: to rounding, with the centres where they are.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct Growth {
    /// Factor of all radii of X0, for a linear model. `None` if no factor suffices.
    pub initial_set: Option<f64>,
    /// Factor of all radii of U, for a linear model. `None` if no factor suffices.
    pub input_set: Option<f64>,
    /// Factor of all radii of X0 and U, for a linear model. `None` if no factor suffices.
    pub both_sets: Option<f64>,
    /// For each part, the factor by which its set of positions at the end becomes wider so that the
    /// values of the part are enclosed: once X0 has grown in each state as first samples need it,
    /// and then U by a factor, or both sets by one factor, whichever is less; of a linear model.
    /// `None` if no factors suffice.
    pub parts: Vec<Option<f64>>,
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
        let linear = problem.dynamics().linear_system();
        let program = linear.map(|_| Program::of_problem(problem)).transpose()?;
        let factors = program.as_ref().map(|program| program.growth_factors(sets));
        let [initial_set, input_set, both_sets] = factors.unwrap_or([None; 3]);
        let (n, input_only) = (problem.inputs(), problem.settings().nominal.is_measured());
        let wider = |program: &Program, part: usize| {
            let is_own = |state: usize| state % n == part;
            program.wider(from_ref(program), sets, input_only, is_own).map(|wider| wider[part])
        };
        let least = |part: usize| {
            let own = program.as_ref().and_then(|program| wider(program, part));
            [own, both_sets].into_iter().flatten().reduce(f64::min)
        };
        let parts = (0..n).map(least).collect();
        let (noise_position, noise_velocity) = (largest(positions), largest(velocities));
        Ok(Self { initial_set, input_set, both_sets, parts, noise_position, noise_velocity })
    }
}
