//! The adaptive method of Dormand and Prince.

use crate::outcome::is_within;
use crate::runge_kutta::add_scaled;
use crate::step_control::StepControl;
use crate::{Cause, Outcome, Run, Tolerance, VectorField};

/// Where in the step each stage stands.
const NODES: [f64; 7] = [0.0, 0.2, 0.3, 0.8, 8.0 / 9.0, 1.0, 1.0];

/// Row i: weights of the slopes before stage i. The last row is the solution of order 5.
const STAGES: [[f64; 6]; 7] = [
    [0.0; 6],
    [0.2, 0.0, 0.0, 0.0, 0.0, 0.0],
    [3.0 / 40.0, 9.0 / 40.0, 0.0, 0.0, 0.0, 0.0],
    [44.0 / 45.0, -56.0 / 15.0, 32.0 / 9.0, 0.0, 0.0, 0.0],
    [19372.0 / 6561.0, -25360.0 / 2187.0, 64448.0 / 6561.0, -212.0 / 729.0, 0.0, 0.0],
    [9017.0 / 3168.0, -355.0 / 33.0, 46732.0 / 5247.0, 49.0 / 176.0, -5103.0 / 18656.0, 0.0],
    [35.0 / 384.0, 0.0, 500.0 / 1113.0, 125.0 / 192.0, -2187.0 / 6784.0, 11.0 / 84.0],
];

/// Solution of order 5 less that of order 4.
const ERROR: [f64; 7] = [
    71.0 / 57600.0,
    0.0,
    -71.0 / 16695.0,
    71.0 / 1920.0,
    -17253.0 / 339200.0,
    22.0 / 525.0,
    -1.0 / 40.0,
];

/// Highest coefficient of the interpolant.
const DENSE: [f64; 7] = [
    -12715105075.0 / 11282082432.0,
    0.0,
    87487479700.0 / 32700410799.0,
    -10690763975.0 / 1880347072.0,
    701980252875.0 / 199316789632.0,
    -1453857185.0 / 822651844.0,
    69997945.0 / 29380423.0,
];

/// The pair of orders 5 and 4 of Dormand & Prince (J. Comput. Appl. Math. 6, 1980) with step
/// control and an interpolant of order 4 (Hairer, Nørsett & Wanner, Solving Ordinary Differential
/// Equations I, 1993, sec. II.6); it does not allocate after construction.
///
/// # Examples
///
/// ```
/// use reachtube_ode::{DormandPrince, Outcome, Tolerance};
///
/// let mut oscillator = |_: f64, x: &[f64], _: &[f64], dx: &mut [f64]| (dx[0], dx[1]) = (x[1], -x[0]);
/// let mut solver = DormandPrince::new(2, Tolerance::default());
/// let mut x = [1.0, 0.0];
/// assert_eq!(solver.integrate(&mut oscillator, [0.0, 3.0], &mut x, &[]), Outcome::Reached);
/// assert!((x[0] - 3.0_f64.cos()).abs() < 1e-7);
///
/// // ẋ = x² from 1 has a pole at t = 1.
/// let mut pole = |_: f64, x: &[f64], _: &[f64], dx: &mut [f64]| dx[0] = x[0] * x[0];
/// let outcome = DormandPrince::new(1, Tolerance::default()).integrate(&mut pole, [0.0, 2.0], &mut [1.0], &[]);
/// assert!(matches!(outcome, Outcome::Diverged { time, .. } if (time - 1.0).abs() < 1e-7));
/// ```
#[derive(Clone, Debug)]
pub struct DormandPrince {
    tolerance: Tolerance,
    bound: f64,
    step_limit: usize,
    control: StepControl,
    slopes: [Vec<f64>; 7],
    /// The state at a stage, and at last that after the step.
    next: Vec<f64>,
    state: Vec<f64>,
}

/// A step that was taken, and the solution within it.
#[derive(Clone, Copy, Debug)]
pub struct DenseStep<'a> {
    start: f64,
    end: f64,
    size: f64,
    before: &'a [f64],
    after: &'a [f64],
    slopes: &'a [Vec<f64>; 7],
}

impl DormandPrince {
    /// An integrator of states of `dimension` entries; no bound on |x| but that it be finite, at
    /// most 100 000 steps a span.
    ///
    /// # Panics
    ///
    /// When the absolute tolerance is not positive, or the relative one negative: an entry of 0
    /// would never meet them.
    pub fn new(dimension: usize, tolerance: Tolerance) -> Self {
        assert!(
            tolerance.absolute > 0.0 && tolerance.relative >= 0.0,
            "a tolerance of {tolerance:?} is never met"
        );
        let zeros = || vec![0.0; dimension];
        Self {
            tolerance,
            bound: f64::MAX,
            step_limit: 100_000,
            control: StepControl::new(),
            slopes: core::array::from_fn(|_| zeros()),
            next: zeros(),
            state: zeros(),
        }
    }

    /// The same with a bound on the |x| of each entry, beyond which the solution counts as
    /// diverged.
    #[must_use]
    pub fn bounded_by(self, bound: f64) -> Self {
        Self { bound, ..self }
    }

    /// The same with a limit of steps, rejected ones included, over each span of held input.
    #[must_use]
    pub fn within_steps(self, step_limit: usize) -> Self {
        Self { step_limit, ..self }
    }

    /// Takes x (n) over [t0, t1] \[s\], t0 ≤ t1, under a held input u (m). Where the solution
    /// diverges, x is the last good state.
    ///
    /// The size of the last step is where the next call begins, so that a motion goes on over the
    /// jumps of its input.
    ///
    /// # Panics
    ///
    /// When x has another length than the integrator's dimension.
    pub fn integrate<F: VectorField<f64>>(
        &mut self,
        field: &mut F,
        span: [f64; 2],
        x: &mut [f64],
        u: &[f64],
    ) -> Outcome {
        self.integrate_dense(field, span, x, u, |_| {})
    }

    /// As [`integrate`](Self::integrate); `observe` is given each step with the solution within it.
    ///
    /// # Panics
    ///
    /// When x has another length than the integrator's dimension.
    pub fn integrate_dense<F: VectorField<f64>>(
        &mut self,
        field: &mut F,
        [mut t, end]: [f64; 2],
        x: &mut [f64],
        u: &[f64],
        mut observe: impl FnMut(&DenseStep<'_>),
    ) -> Outcome {
        assert_eq!(x.len(), self.next.len(), "the state has another length than the integrator");
        let resolution = f64::EPSILON * t.abs().max(end.abs());
        // The last slope of the span before is no use: the input may have jumped.
        field.rate(t, x, u, &mut self.slopes[0]);
        for _ in 0..self.step_limit {
            if !is_within(x, self.bound) {
                return Outcome::Diverged { time: t, cause: Cause::Bound };
            }
            if t >= end {
                return Outcome::Reached;
            }
            let proposal = match self.control.proposal {
                Some(proposal) => proposal,
                None => self.first_step(field, [t, end], x, u),
            };
            // A remainder of less than a hundredth of a step is taken along.
            let is_last = t + 1.01 * proposal >= end;
            let h = if is_last { end - t } else { proposal };
            let error = self.attempt(field, t, h, x, u);
            if error <= 1.0 {
                self.control.accept(h, error, h < proposal);
                let start = t;
                t = if is_last { end } else { start + h };
                let (after, slopes) = (&self.next, &self.slopes);
                observe(&DenseStep { start, end: t, size: h, before: x, after, slopes });
                x.copy_from_slice(&self.next);
                self.slopes.swap(0, 6);
            } else {
                self.control.reject(h, error);
                if h <= resolution {
                    self.control.proposal = None;
                    return Outcome::Diverged { time: t, cause: Cause::StepSize };
                }
            }
        }
        Outcome::Diverged { time: t, cause: Cause::StepCount }
    }

    /// Runs under an input held from sample to sample of `times` \[s\] (increasing); `observe` is
    /// given the index of each sample reached, from 0 on, and the state there. Steps end at
    /// samples, because the input jumps there.
    ///
    /// # Panics
    ///
    /// When the start has another length than the integrator's dimension, or the inputs are not a
    /// row for each sample but the last.
    pub fn follow<F: VectorField<f64>>(
        &mut self,
        field: &mut F,
        times: &[f64],
        run: Run<'_>,
        mut observe: impl FnMut(usize, &[f64]),
    ) -> Outcome {
        self.control = StepControl::new();
        let mut x = core::mem::take(&mut self.state);
        x.copy_from_slice(run.start);
        let m = run.input_dimension(times);
        observe(0, &x);
        let mut outcome = Outcome::Reached;
        for k in 0..times.len().saturating_sub(1) {
            outcome = self.integrate(field, [times[k], times[k + 1]], &mut x, run.input(k, m));
            if !outcome.is_reached() {
                break;
            }
            observe(k + 1, &x);
        }
        self.state = x;
        outcome
    }

    /// Samples the solution from x (n) at times\[0\] under one held input u (m), or one that the
    /// field generates: `observe` is given the index of each sample of `times` \[s\] (increasing)
    /// and the state there. The interpolant gives it, so that samples cost no steps. x is left at
    /// the last time.
    ///
    /// # Panics
    ///
    /// When x has another length than the integrator's dimension.
    pub fn sample<F: VectorField<f64>>(
        &mut self,
        field: &mut F,
        times: &[f64],
        x: &mut [f64],
        u: &[f64],
        mut observe: impl FnMut(usize, &[f64]),
    ) -> Outcome {
        let (Some(start), Some(end)) = (times.first(), times.last()) else {
            return Outcome::Reached;
        };
        self.control = StepControl::new();
        let mut state = core::mem::take(&mut self.state);
        observe(0, x);
        let mut sampled = 1;
        let outcome = self.integrate_dense(field, [*start, *end], x, u, |step| {
            while sampled < times.len() && times[sampled] <= step.end() {
                step.at(times[sampled], &mut state);
                observe(sampled, &state);
                sampled += 1;
            }
        });
        self.state = state;
        outcome
    }

    /// The stages of a step of h; the norm of its error.
    fn attempt<F: VectorField<f64>>(
        &mut self,
        field: &mut F,
        t: f64,
        h: f64,
        x: &[f64],
        u: &[f64],
    ) -> f64 {
        for stage in 1..7 {
            let (before, after) = self.slopes.split_at_mut(stage);
            self.next.copy_from_slice(x);
            for (slope, weight) in
                before.iter().zip(&STAGES[stage]).filter(|(_, weight)| **weight != 0.0)
            {
                add_scaled(&mut self.next, h * weight, slope);
            }
            field.rate(t + NODES[stage] * h, &self.next, u, &mut after[0]);
        }
        let error = (0..x.len()).map(|i| h * weighted(&ERROR, &self.slopes, i));
        self.tolerance.norm(error, x, &self.next)
    }

    /// A first step by a guess at the second derivative (Hairer, Nørsett & Wanner, sec. II.4).
    fn first_step<F: VectorField<f64>>(
        &mut self,
        field: &mut F,
        [t, end]: [f64; 2],
        x: &[f64],
        u: &[f64],
    ) -> f64 {
        let norm = |v: &mut dyn Iterator<Item = f64>| self.tolerance.norm(v, x, x);
        let size = norm(&mut x.iter().copied());
        let speed = norm(&mut self.slopes[0].iter().copied());
        let guess = if size < 1e-5 || speed < 1e-5 { 1e-6 } else { 0.01 * size / speed };
        let guess = guess.min(end - t);
        for (next, (x, slope)) in self.next.iter_mut().zip(x.iter().zip(&self.slopes[0])) {
            *next = x + guess * slope;
        }
        let [first, second, ..] = &mut self.slopes;
        field.rate(t + guess, &self.next, u, second);
        let bend =
            self.tolerance.norm(first.iter().zip(&*second).map(|(a, b)| b - a), x, x) / guess;
        let fastest = speed.max(bend);
        let step =
            if fastest <= 1e-15 { (1e-3 * guess).max(1e-6) } else { (0.01 / fastest).powf(0.2) };
        let step = step.min(100.0 * guess).min(end - t);
        // NaN where the rate is: any step then shows it.
        if step > 0.0 { step } else { end - t }
    }
}

/// Σ weights · slopes of entry i.
fn weighted(weights: &[f64; 7], slopes: &[Vec<f64>; 7], i: usize) -> f64 {
    weights.iter().zip(slopes).map(|(weight, slope)| weight * slope[i]).sum()
}

impl DenseStep<'_> {
    /// Time at the start of the step \[s\].
    pub fn start(&self) -> f64 {
        self.start
    }

    /// Time at its end \[s\].
    pub fn end(&self) -> f64 {
        self.end
    }

    /// The solution (n) at a time \[s\] of the step, of order 4, into `x`.
    pub fn at(&self, time: f64, x: &mut [f64]) {
        let h = self.size;
        let theta = (time - self.start) / h;
        let rest = 1.0 - theta;
        for (i, x) in x.iter_mut().enumerate() {
            let change = self.after[i] - self.before[i];
            let bend = h * self.slopes[0][i] - change;
            let twist = change - h * self.slopes[6][i] - bend;
            let last = h * weighted(&DENSE, self.slopes, i);
            *x = self.before[i] + theta * (change + rest * (bend + theta * (twist + rest * last)));
        }
    }
}
