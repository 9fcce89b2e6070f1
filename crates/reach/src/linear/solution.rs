//! Enclosed solutions of a linear system under a piecewise constant input.

use reachtube_scalar::Interval;
use reachtube_scalar::rounding::add_up;

use crate::linear::propagation::Propagation;
use crate::linear::step::PropagationStep;
use crate::sets::interval_matrix::IntervalVector;
use crate::upward::dot_upward;

/// An enclosed solution at the samples of a grid.
#[derive(Debug, Clone, PartialEq)]
pub struct Trajectory {
    dimension: usize,
    states: Vec<Interval>,
}

impl Trajectory {
    /// Returns the number of samples.
    pub fn len(&self) -> usize {
        self.states.len() / self.dimension.max(1)
    }

    /// Returns the state at sample k, N intervals.
    pub fn state(&self, k: usize) -> &[Interval] {
        &self.states[k * self.dimension..(k + 1) * self.dimension]
    }
}

impl Propagation {
    /// Encloses the solution from `start` (N) under the piecewise constant input `inputs`.
    ///
    /// `inputs` is row-major with one row of m entries per sample. A row holds until the next
    /// sample; the row of the last sample has no effect. The trajectory has one state per row and
    /// at most one per sample of the grid; without inputs (m = 0), it covers the whole grid.
    ///
    /// # Guarantee
    ///
    /// Outer, directed rounding: for every initial state in `start`, the exact solution at each
    /// sample lies in the trajectory.
    pub fn solve(&self, start: &IntervalVector, inputs: &[f64]) -> Trajectory {
        let (n, m) = (self.system().states(), self.system().inputs());
        let rows = inputs.len().checked_div(m).unwrap_or(usize::MAX);
        let samples = rows.min(self.grid().len());
        let mut solution = Solution::new(start);
        let mut states = Vec::with_capacity(samples * n);
        for k in 0..samples {
            states.extend((0..n).map(|i| solution.state(i)));
            if k + 1 < samples {
                solution.advance(self, k, &inputs[k * m..(k + 1) * m]);
            }
        }
        Trajectory { dimension: n, states }
    }
}

/// An enclosed solution that advances from sample to sample, for an input that is known step by
/// step. It does not allocate after it was made.
#[derive(Debug, Clone)]
pub struct Solution {
    mid: Vec<f64>,
    error: SolutionError,
    next: Vec<Interval>,
}

impl Solution {
    /// Begins at the first sample, in a state of `start` (N).
    pub fn new(start: &IntervalVector) -> Self {
        let mid = start.iter().map(|x| x.mid()).collect();
        let next = vec![Interval::ZERO; start.len()];
        Self { mid, error: SolutionError::new(start), next }
    }

    /// Begins anew in one state (N).
    ///
    /// # Panics
    ///
    /// If the solution has another number of states.
    pub fn restart(&mut self, state: &[f64]) {
        self.mid.copy_from_slice(state);
        self.error.clear();
    }

    /// Returns the value of state i.
    ///
    /// # Guarantee
    ///
    /// Outer, as [`Propagation::solve`].
    pub fn state(&self, i: usize) -> Interval {
        Interval::centred(self.mid[i], self.error.radius[i])
    }

    /// Advances from sample `k` of the grid to the next under the input `input` (m).
    pub fn advance(&mut self, propagation: &Propagation, k: usize, input: &[f64]) {
        advance(propagation.step(k), &self.mid, input, &mut self.next);
        self.error.advance(propagation, k, &self.next);
        self.mid.iter_mut().zip(&self.next).for_each(|(mid, next)| *mid = next.mid());
    }
}

/// Encloses one step of the solution, Φ x + Γ u + γ.
fn advance(step: &PropagationStep, x: &[f64], u: &[f64], next: &mut [Interval]) {
    next.copy_from_slice(step.drift.as_slice());
    for (matrix, vector) in [(&step.phi, x), (&step.gamma, u)] {
        for (column, &value) in matrix.column_iter().zip(vector) {
            let value = Interval::point(value);
            next.iter_mut()
                .zip(column.iter())
                .filter(|(_, x)| **x != Interval::ZERO)
                .for_each(|(sum, &x)| *sum += x * value);
        }
    }
}

/// Two bounds of the error of a floating-point solution, as for the exponential in
/// [`MatrixPowers`](crate::linear::exponential::powers::Powers).
#[derive(Debug, Clone)]
struct SolutionError {
    /// Radius of the initial set.
    start: Vec<f64>,
    /// Sum of the defects of all steps so far.
    defects: Vec<f64>,
    /// Error bound carried over from the previous sample.
    carried: Vec<f64>,
    /// The smaller of the two bounds.
    radius: Vec<f64>,
}

impl SolutionError {
    fn new(start: &IntervalVector) -> Self {
        let radius: Vec<f64> = start.iter().map(|x| x.rad()).collect();
        let zero = vec![0.0; radius.len()];
        Self { start: radius.clone(), defects: zero.clone(), carried: zero, radius }
    }

    /// Returns to the first sample and an initial set of one state.
    fn clear(&mut self) {
        let Self { start, defects, carried, radius } = self;
        [start, defects, carried, radius].into_iter().for_each(|bounds| bounds.fill(0.0));
    }

    /// Advances the bounds to sample k + 1, where `next` encloses the step of the midpoint.
    fn advance(&mut self, propagation: &Propagation, k: usize, next: &[Interval]) {
        let (phi, bound) = (&propagation.step(k).phi, propagation.horizon_bound());
        // From one state, the exponential multiplies zeros.
        let is_point = self.start.iter().all(|radius| *radius == 0.0);
        let exponential = (!is_point).then(|| propagation.exponential(k + 1));
        for (i, next) in next.iter().enumerate() {
            self.defects[i] = add_up(self.defects[i], next.rad());
            self.carried[i] =
                add_up(dot_upward(phi.row(i).iter().map(|x| x.mag()), &self.radius), next.rad());
        }
        for i in 0..next.len() {
            let start = exponential.as_ref().map_or(0.0, |exponential| {
                dot_upward(exponential.row(i).iter().map(|x| x.mag()), &self.start)
            });
            let defects = dot_upward(bound.row(i).iter().copied(), &self.defects);
            self.radius[i] = self.carried[i].min(add_up(start, defects));
        }
    }
}
