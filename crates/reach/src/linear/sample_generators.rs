//! The generators of the reachable set of the deviation at the samples of a grid.

use std::borrow::Cow;

use reachtube_scalar::Interval;
use reachtube_scalar::rounding::{add_up, mul_up};

use crate::error::ReachError;
use crate::linear::exponential::powers::{MatrixPowers, bound_within_step};
use crate::linear::input_gains::Disturbance;
use crate::linear::propagation::Propagation;
use crate::linear::step::PropagationStep;
use crate::sets::interval_matrix::{IntervalMatrix, product};
use crate::sets::membership::GeneratorRows;
use crate::upward::{UNDERFLOW, relative_error, round_up_sum};

/// The generators of the reachable set of the deviation δẋ = A δx + B δu at the samples of a grid:
/// the columns of e^{A t_k} for the initial set, and the columns of Γ(t_k - t_j) - Γ(t_k - t_{j+1})
/// for the disturbance over each earlier step; the columns of Γ(t_k) for one that is constant.
#[derive(Debug)]
pub struct SampleGenerators<'a> {
    /// The propagation on the grid whose steps the disturbance is held over.
    propagation: Cow<'a, Propagation>,
    /// How many steps of that grid there are between two samples.
    parts: usize,
    is_constant: bool,
    /// On a uniform grid, the generators at the last sample; any other sample has the first of
    /// them.
    shared: Option<UnitGenerators>,
}

/// Generators for radii of 1, as midpoints and radii.
#[derive(Debug, Clone)]
struct UnitGenerators {
    states: usize,
    inputs: usize,
    /// Number of generators of the input.
    count: usize,
    /// State by state: the entries of all generators of the input, step by step.
    input: Vec<f64>,
    /// For each number of steps, bounds of the errors of the entries of all steps up to it, in sum:
    /// states x inputs, column by column.
    error: Vec<Vec<f64>>,
}

impl<'a> SampleGenerators<'a> {
    /// Prepares the generators for one class of disturbances. A measurable disturbance is taken as
    /// one that is held over each of `parts` equal parts of a step, 1 or more.
    ///
    /// # Errors
    ///
    /// As [`Propagation::new`].
    pub fn new(
        propagation: &'a Propagation,
        disturbance: Disturbance,
        parts: usize,
    ) -> Result<Self, ReachError> {
        let (propagation, parts) = match disturbance {
            Disturbance::Measurable if parts > 1 => {
                let grid = propagation.grid().refined(parts);
                (Cow::Owned(Propagation::new(propagation.system(), &grid)?), parts)
            }
            _ => (Cow::Borrowed(propagation), 1),
        };
        let is_constant = disturbance == Disturbance::Constant;
        let is_shared = propagation.grid().step().is_some() && !is_constant;
        let shared = is_shared.then(|| {
            let steps = propagation.grid().len().saturating_sub(1);
            UnitGenerators::new(propagation.system().states(), propagation.system().inputs(), {
                (0..steps).map(|j| propagation.increment(j))
            })
        });
        Ok(Self { propagation, parts, is_constant, shared })
    }

    /// Returns the generators at sample `k` for sets of these radii: the radii of X0 (N), of U (m)
    /// and of a noise that is added (N), in the entries `states` of the state. `held` is the number
    /// of steps in a row over which the disturbance is held: 1, or more for fewer generators.
    ///
    /// # Guarantee
    ///
    /// Outer bounds of the errors: the exact generators lie within the errors of the rows. Their
    /// zonotope is the reachable set of the deviation from the sets' centres. It is an inner
    /// approximation of that set for a measurable disturbance, and where `held` is above 1.
    #[must_use]
    pub fn at(
        &self,
        k: usize,
        [initial, input, noise]: [&[f64]; 3],
        states: &[usize],
        held: usize,
    ) -> GeneratorRows {
        let steps = k * self.parts;
        let exponential = self.propagation.exponential(steps);
        let unit = self.unit(steps);
        let (used, inputs) = (if self.is_constant { 1 } else { steps }, unit.inputs);
        let columns = initial.len() + used.div_ceil(held) * inputs + states.len();
        let mut rows = GeneratorRows::new(states.len(), columns);
        for (at, &i) in states.iter().enumerate() {
            let (row, mut error, mut size) = (rows.row_mut(at), 0.0, 0.0);
            let (of_start, rest) = row.split_at_mut(initial.len());
            let (of_input, of_noise) = rest.split_at_mut(used.div_ceil(held) * inputs);
            for (j, (entry, radius)) in of_start.iter_mut().zip(initial).enumerate() {
                *entry = exponential[(i, j)].mid() * radius;
                size += entry.abs();
                error = add_up(error, mul_up(exponential[(i, j)].rad(), *radius));
            }
            let entries = &unit.input[i * unit.count..][..used * inputs];
            for (step, entries) in entries.chunks_exact(inputs.max(1)).enumerate() {
                let sums = of_input[step / held * inputs..].iter_mut();
                for (sum, (value, radius)) in sums.zip(entries.iter().zip(input)) {
                    *sum += value * radius;
                    size += (value * radius).abs();
                }
            }
            of_noise[at] = noise[i];
            for (j, radius) in input.iter().enumerate() {
                let of_input = &unit.error[used][j * unit.states + i];
                error = add_up(error, mul_up(*of_input, *radius));
            }
            // Rounding of the products with the radii, and of the sums of held steps.
            let rounding = relative_error(held.min(used) + 1);
            error = add_up(error, mul_up(rounding, round_up_sum(size, columns * held)));
            error = add_up(error, UNDERFLOW);
            rows.set_error(at, error);
        }
        rows
    }

    /// Returns by how much radii of 1 reach along `direction` (N entries) at sample `k`: |lᵀ e^{A
    /// t_k}| for each state of X0, and Σ |lᵀ g| over the generators of each entry of U.
    ///
    /// # Guarantee
    ///
    /// None: floating point.
    #[must_use]
    pub fn gains(&self, k: usize, direction: &[f64]) -> (Vec<f64>, Vec<f64>) {
        let steps = k * self.parts;
        let exponential = self.propagation.exponential(steps);
        let unit = self.unit(steps);
        let along = |j: usize| {
            let column = exponential.column(j);
            direction.iter().zip(column.iter()).map(|(l, x)| l * x.mid()).sum::<f64>().abs()
        };
        let initial = (0..direction.len()).map(along).collect();
        let used = if self.is_constant { 1 } else { steps } * unit.inputs;
        let mut values = vec![0.0; used];
        for (i, l) in direction.iter().enumerate().filter(|(_, l)| **l != 0.0) {
            let row = &unit.input[i * unit.count..][..used];
            values.iter_mut().zip(row).for_each(|(value, x)| *value += l * x);
        }
        let mut input = vec![0.0; unit.inputs];
        for step in values.chunks_exact(unit.inputs.max(1)) {
            input.iter_mut().zip(step).for_each(|(sum, value)| *sum += value.abs());
        }
        (initial, input)
    }

    /// The generators of the input after `steps` steps, and possibly of later steps.
    fn unit(&self, steps: usize) -> Cow<'_, UnitGenerators> {
        match &self.shared {
            Some(shared) => Cow::Borrowed(shared),
            None => Cow::Owned(self.own(steps)),
        }
    }

    /// The generators of the input after `steps` steps of a grid that is not uniform, or of a
    /// constant input.
    fn own(&self, steps: usize) -> UnitGenerators {
        let system = self.propagation.system();
        let (states, inputs) = (system.states(), system.inputs());
        if self.is_constant {
            let integral = self.propagation.integral(steps).clone();
            return UnitGenerators::new(states, inputs, std::iter::once(integral));
        }
        // From the last step back to the first, so that each product continues from the one before.
        let backward: Vec<PropagationStep> =
            (0..steps).rev().map(|j| self.propagation.step(j).clone()).collect();
        let within = bound_within_step(system, self.propagation.grid().longest_step());
        let powers = MatrixPowers::of_steps(&backward, &within);
        let increment = |(j, step): (usize, &PropagationStep)| product(&powers.at(j), &step.gamma);
        UnitGenerators::new(states, inputs, backward.iter().enumerate().map(increment))
    }
}

impl UnitGenerators {
    fn new(
        states: usize,
        inputs: usize,
        increments: impl ExactSizeIterator<Item = IntervalMatrix>,
    ) -> Self {
        let count = increments.len() * inputs;
        let mut input = vec![0.0; states * count];
        let mut error = vec![vec![0.0; states * inputs]];
        for (step, increment) in increments.enumerate() {
            for (j, column) in increment.column_iter().enumerate() {
                for (i, entry) in column.iter().enumerate() {
                    input[i * count + step * inputs + j] = entry.mid();
                }
            }
            let sum = |(x, sum): (&Interval, &f64)| add_up(*sum, x.rad());
            error.push(increment.iter().zip(&error[step]).map(sum).collect());
        }
        Self { states, inputs, count, input, error }
    }
}
