use rayon::prelude::*;
use reachtube_scalar::Interval;

use crate::linear::hulls::ReachSets;
use crate::linear::input_gains::disturbance::Disturbance;
use crate::linear::input_gains::measurable::measurable_gains;
use crate::linear::propagation::Propagation;
use crate::linear::solution::Trajectory;
use crate::linear::step::step;
use crate::sets::hyperrectangle::Hyperrectangle;
use crate::sets::interval_matrix::{IntervalMatrix, absolute, add_product, point, points, product};

/// The tube between the samples: one box per step [t_k, t_{k+1}] that contains every reachable
/// state at every time of the step.
#[derive(Debug, Clone, PartialEq)]
pub struct StepBounds {
    dimension: usize,
    bounds: Vec<Interval>,
}

impl StepBounds {
    /// Computes the tube around the solution `nominal` under the recorded `inputs` (row-major, one
    /// row of m entries per sample).
    ///
    /// `nominal` must not include the centres of the sets. All test suites on one grid can share
    /// the `radii`. The centre y solves ẏ = A y + B (u + c_u) + d and stays within h²/8 sup|ÿ| of
    /// the chord between two samples; the same bound holds for the radius.
    ///
    /// # Guarantee
    ///
    /// Outer, directed rounding, for every time of each step, not only at samples.
    pub fn new(
        propagation: &Propagation,
        nominal: &Trajectory,
        inputs: &[f64],
        sets: &ReachSets,
        input_set: &Hyperrectangle,
        radii: &StepRadii,
    ) -> Self {
        let (n, m) = (propagation.system().states(), propagation.system().inputs());
        let centre = |k: usize, i: usize| nominal.state(k)[i] + sets.centre(k, i);
        let steps = nominal.len().saturating_sub(1);
        let mut bounds = Vec::with_capacity(steps * n);
        for k in 0..steps {
            let y: Vec<Interval> = (0..n).map(|i| centre(k, i)).collect();
            let input = |j: usize| {
                Interval::point(inputs[k * m + j]) + Interval::point(input_set.centre[j])
            };
            let velocity =
                propagation.system().derivative(&y, &(0..m).map(input).collect::<Vec<_>>());
            let mut acceleration = vec![Interval::ZERO; n];
            add_product(&mut acceleration, &radii.curvature, &velocity);
            let eighth = eighth(propagation, k);
            for i in 0..n {
                let bulge = symmetric(acceleration[i].abs() * eighth);
                bounds.push(y[i].hull(centre(k + 1, i)) + bulge + symmetric(radii.radius(k, i)));
            }
        }
        Self { dimension: n, bounds }
    }

    /// Builds a tube from given boxes, row-major, steps x N.
    ///
    /// # Guarantee
    ///
    /// The guarantee of the boxes.
    ///
    /// # Panics
    ///
    /// Panics when the number of boxes is not a multiple of `dimension`.
    pub fn from_boxes(dimension: usize, bounds: Vec<Interval>) -> Self {
        assert_eq!(
            bounds.len() % dimension.max(1),
            0,
            "the number of intervals must be a multiple of {dimension}"
        );
        Self { dimension, bounds }
    }

    /// Returns the number of steps.
    pub fn len(&self) -> usize {
        self.bounds.len() / self.dimension.max(1)
    }

    /// Returns the box of step k, from sample k to k + 1, N intervals.
    pub fn bounds(&self, k: usize) -> &[Interval] {
        &self.bounds[k * self.dimension..(k + 1) * self.dimension]
    }
}

/// Radii of the tube over each step of a grid, which depend on the sets but not on the nominal
/// motion.
#[derive(Debug, Clone)]
pub struct StepRadii {
    dimension: usize,
    radius: Vec<Interval>,
    /// A e^{As} for every s up to the longest step; it maps ẏ at a sample to ÿ within the step.
    curvature: IntervalMatrix,
}

impl StepRadii {
    /// Computes the radii for the initial set X0 (N) and the input set U (m).
    ///
    /// The gain of `Measurable` also covers `Sample`, since it contains that disturbance between
    /// the samples. An entry of e^{At}, and of Γ(t) for `Constant`, stays within h²/8 sup|d²/dt²|
    /// of its chord, and the chord stays between its ends.
    ///
    /// # Guarantee
    ///
    /// Outer, directed rounding.
    pub fn new(
        propagation: &Propagation,
        disturbance: Disturbance,
        initial_set: &Hyperrectangle,
        input_set: &Hyperrectangle,
    ) -> Self {
        let system = propagation.system();
        let (a, b) = (point(system.a()), point(system.b()));
        let longest = Interval::ZERO.hull(Interval::point(propagation.grid().longest_step()));
        let curvature = product(&step(system, longest).phi, &a);
        let (second_of_initial, second_of_input) =
            (product(&curvature, &a), product(&curvature, &b));
        let variation = match disturbance {
            Disturbance::Constant => None,
            Disturbance::Sample | Disturbance::Measurable => Some(measurable_gains(propagation)),
        };
        let (initial_radius, input_radius) =
            (points(&initial_set.radius), points(&input_set.radius));
        let step_radius = |k: usize| {
            let mut radius = vec![Interval::ZERO; system.states()];
            let exponential = [k, k + 1].map(|k| propagation.exponential(k));
            let initial = over_step(propagation, k, exponential.each_ref(), &second_of_initial);
            add_product(&mut radius, &initial, &initial_radius);
            match &variation {
                Some(gains) => add_product(&mut radius, &gains[k + 1], &input_radius),
                None => {
                    let integral = [k, k + 1].map(|k| propagation.integral(k));
                    let input = over_step(propagation, k, integral, &second_of_input);
                    add_product(&mut radius, &input, &input_radius);
                }
            }
            radius
        };
        let steps = propagation.grid().len().saturating_sub(1);
        let radius = (0..steps).into_par_iter().flat_map_iter(step_radius).collect();
        Self { dimension: system.states(), radius, curvature }
    }

    fn radius(&self, k: usize, i: usize) -> Interval {
        self.radius[k * self.dimension + i]
    }
}

/// Bounds |F(t)| over step k for a matrix function F with the values `ends` at the two samples and
/// the second derivative F̈ = e^{A t_k} `second` within the step.
fn over_step(
    propagation: &Propagation,
    k: usize,
    ends: [&IntervalMatrix; 2],
    second: &IntervalMatrix,
) -> IntervalMatrix {
    let eighth = eighth(propagation, k);
    let bulge = product(&propagation.exponential(k), second).map(|x| x.abs() * eighth);
    largest(ends[0], ends[1]) + bulge
}

/// Encloses h²/8 for step k.
fn eighth(propagation: &Propagation, k: usize) -> Interval {
    propagation.grid().interval(k).sqr() * 0.125
}

/// Returns the larger absolute value of each entry, which bounds |x| on the chord between both.
fn largest(left: &IntervalMatrix, right: &IntervalMatrix) -> IntervalMatrix {
    absolute(left).zip_map(&absolute(right), |x, y| Interval::point(x.hi().max(y.hi())))
}

/// Returns [-x̄, x̄] with the upper end x̄ of x >= 0.
fn symmetric(x: Interval) -> Interval {
    Interval::centred(0.0, x.hi())
}
