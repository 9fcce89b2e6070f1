//! Cost of sets in a program.

use crate::program::program::Program;
use crate::sets::UncertaintySets;

impl Program<'_> {
    pub(crate) fn cost(&self, sets: &UncertaintySets) -> f64 {
        self.step * self.cost_in_steps(sets)
    }

    /// Returns the cost of widths of 1e-9 rad or rad/s throughout, which are as good as none.
    pub(crate) fn negligible_cost(&self) -> f64 {
        self.step * self.negligible_in_steps()
    }

    /// Returns the [cost](Self::cost) in mean steps. On uniform grids it is the sum over samples.
    pub(crate) fn cost_in_steps(&self, sets: &UncertaintySets) -> f64 {
        let radii = sets.initial_set.radius.iter().chain(&sets.input_set.radius);
        let noise = (0..self.shape.outputs).map(|i| self.noise_cost[i] * sets.noise_radius(i));
        radii.zip(&self.cost).map(|(r, w)| r * w).sum::<f64>() + noise.sum::<f64>()
    }

    pub(crate) fn negligible_in_steps(&self) -> f64 {
        1e-9 * 0.5 * self.noise_cost.iter().sum::<f64>()
    }
}
