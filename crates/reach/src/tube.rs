use reachtube_scalar::Interval;

use crate::exponential::{derivative, step};
use crate::matrix::{IntervalMatrix, IntervalVector, absolute, point};
use crate::variation::measurable_gains;
use crate::{Disturbance, Hyperrectangle, Propagation, ReachSets, Trajectory};

/// The continuous-time tube: one box for each step [t_k, t_{k+1}] that contains every reachable state at every time of the step.
#[derive(Debug, Clone, PartialEq)]
pub struct Tube {
    dimension: usize,
    bounds: Vec<Interval>,
}

impl Tube {
    /// The tube around the solution `nominal` (without the centres of the sets) of the system with the recorded `inputs`
    /// (row-major, one row of m a sample). `radii` are shared by all suites of one grid.
    ///
    /// The centre y solves ẏ = A y + B (u + c_u) + d and stays within h²/8 sup|ÿ| of the chord between two samples; the radius likewise.
    ///
    /// # Guarantee
    ///
    /// Outer, directed rounding, for every t of the step, not only at samples.
    pub fn new(
        propagation: &Propagation,
        nominal: &Trajectory,
        inputs: &[f64],
        sets: &ReachSets,
        input_set: &Hyperrectangle,
        radii: &TubeRadii,
    ) -> Self {
        let system = propagation.system();
        let (n, m) = (system.states(), system.inputs());
        let center = |k: usize| {
            IntervalVector::from_iterator(n, (0..n).map(|i| nominal.state(k)[i] + sets.center(k, i)))
        };
        let mut bounds = Vec::new();
        for k in 0..nominal.len().saturating_sub(1) {
            let (y, next) = (center(k), center(k + 1));
            let u = IntervalVector::from_iterator(
                m,
                (0..m).map(|j| Interval::point(inputs[k * m + j]) + Interval::point(input_set.center[j])),
            );
            let velocity = derivative(system, &y, &u);
            let acceleration = point(system.a()) * (&radii.within(k).phi * velocity);
            let eighth = radii.within(k).eighth;
            for i in 0..n {
                let bulge = symmetric(acceleration[i].abs() * eighth);
                bounds.push(y[i].hull(next[i]) + bulge + symmetric(radii.radius(k, i)));
            }
        }
        Self { dimension: n, bounds }
    }

    /// Number of steps.
    pub fn len(&self) -> usize {
        self.bounds.len() / self.dimension.max(1)
    }

    /// Whether there is no step.
    pub fn is_empty(&self) -> bool {
        self.bounds.is_empty()
    }

    /// The box of step k (from sample k to k + 1), N entries.
    pub fn bounds(&self, k: usize) -> &[Interval] {
        &self.bounds[k * self.dimension..(k + 1) * self.dimension]
    }
}

/// Radii of the tube over each step of a grid: they depend on the sets, not on the nominal solution.
#[derive(Debug, Clone)]
pub struct TubeRadii {
    dimension: usize,
    radius: Vec<Interval>,
    within: Vec<WithinStep>,
    uniform: bool,
}

#[derive(Debug, Clone)]
struct WithinStep {
    /// e^{As} for every s of the step.
    phi: IntervalMatrix,
    /// h²/8.
    eighth: Interval,
}

impl TubeRadii {
    /// The radii for the initial set X0 and the input set U. The disturbance `Sample` is covered by the gain of `Measurable`, which contains it
    /// between the samples too.
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
        let grid = propagation.grid();
        let dimension = propagation.system().states();
        let uniform = grid.step().is_some();
        let steps = grid.len().saturating_sub(1);
        let within: Vec<_> =
            (0..if uniform { steps.min(1) } else { steps }).map(|k| within_step(propagation, k)).collect();
        let mut radii = Self { dimension, radius: Vec::new(), within, uniform };
        let variation = match disturbance {
            Disturbance::Constant => None,
            Disturbance::Sample | Disturbance::Measurable => Some(measurable_gains(propagation)),
        };
        for k in 0..steps {
            let radius = radii.step_radius(propagation, k, variation.as_deref(), initial_set, input_set);
            radii.radius.extend(radius);
        }
        radii
    }

    fn within(&self, k: usize) -> &WithinStep {
        &self.within[if self.uniform { 0 } else { k }]
    }

    fn radius(&self, k: usize, i: usize) -> Interval {
        self.radius[k * self.dimension + i]
    }

    fn step_radius(
        &self,
        propagation: &Propagation,
        k: usize,
        variation: Option<&[IntervalMatrix]>,
        initial_set: &Hyperrectangle,
        input_set: &Hyperrectangle,
    ) -> impl Iterator<Item = Interval> + use<> {
        let system = propagation.system();
        let within = self.within(k);
        let rate = propagation.exponential(k) * &within.phi * point(system.a());
        let curvature = (&rate * point(system.a())).map(|x| x.abs() * within.eighth);
        let initial = largest(propagation.exponential(k), propagation.exponential(k + 1)) + curvature;
        let input = match variation {
            Some(gains) => gains[k + 1].clone(),
            None => {
                let curvature = (rate * point(system.b())).map(|x| x.abs() * within.eighth);
                largest(propagation.integral(k), propagation.integral(k + 1)) + curvature
            }
        };
        let vector = |x: &[f64]| IntervalVector::from_iterator(x.len(), x.iter().map(|&r| Interval::point(r)));
        let radius = initial * vector(&initial_set.radius) + input * vector(&input_set.radius);
        radius.data.as_vec().clone().into_iter()
    }
}

fn within_step(propagation: &Propagation, k: usize) -> WithinStep {
    let h = propagation.grid().interval(k);
    let phi = step(propagation.system(), Interval::ZERO.hull(h)).phi;
    WithinStep { phi, eighth: h * h * 0.125 }
}

/// |x| on a chord between two matrices is at most the larger of the two ends.
fn largest(left: &IntervalMatrix, right: &IntervalMatrix) -> IntervalMatrix {
    absolute(left).zip_map(&absolute(right), |x, y| Interval::point(x.hi().max(y.hi())))
}

/// [-x̄, x̄] with x̄ the upper end of x >= 0.
fn symmetric(x: Interval) -> Interval {
    Interval::centered(0.0, x.hi())
}
