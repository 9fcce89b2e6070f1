//! The adaptive method of Dormand and Prince.

use crate::outcome::{Cause, Outcome, is_within};
use crate::run::InitialValueProblem;
use crate::runge_kutta::add_scaled;
use crate::step_control::{StepControl, Tolerance};
use crate::tableau::{ERROR_WEIGHTS, NODES, STAGES, weighted_sum};
use crate::vector_field::VectorField;

/// The adaptive integrator of Dormand & Prince (J. Comput. Appl. Math. 6, 1980) with an embedded
/// pair of orders 5 and 4.
///
/// It has step size control (Hairer, Nørsett & Wanner, Solving Ordinary Differential Equations I,
/// 1993, sec. II.4). It does not allocate after construction.
///
/// # Examples
///
/// ```
/// use reachtube_ode::{DormandPrince, Outcome, Tolerance};
///
/// let mut oscillator = |_: f64, x: &[f64], _: &[f64], dx: &mut [f64]| {
///     (dx[0], dx[1]) = (x[1], -x[0]);
/// };
/// let mut solver = DormandPrince::new(2, Tolerance::default());
/// let mut x = [1.0, 0.0];
/// assert_eq!(solver.integrate(&mut oscillator, [0.0, 3.0], &mut x, &[]), Outcome::Reached);
/// assert!((x[0] - 3.0_f64.cos()).abs() < 1e-7);
///
/// // The solution of ẋ = x² from x = 1 has a pole at t = 1 s.
/// let mut pole = |_: f64, x: &[f64], _: &[f64], dx: &mut [f64]| dx[0] = x[0] * x[0];
/// let mut solver = DormandPrince::new(1, Tolerance::default());
/// let outcome = solver.integrate(&mut pole, [0.0, 2.0], &mut [1.0], &[]);
/// assert!(matches!(outcome, Outcome::Diverged { time, .. } if (time - 1.0).abs() < 1e-7));
/// ```
#[derive(Clone, Debug)]
pub struct DormandPrince {
    tolerance: Tolerance,
    /// Bound on |x| of each entry.
    bound: f64,
    /// Largest number of steps, including rejected ones, over one span.
    step_limit: usize,
    control: StepControl,
    /// Slopes of the stages (n each).
    slopes: [Vec<f64>; 7],
    /// The state at a stage, and finally the state after the step (n).
    next: Vec<f64>,
    /// The state of a simulated run (n).
    state: Vec<f64>,
}

impl DormandPrince {
    /// Returns an integrator for states with `dimension` entries.
    ///
    /// |x| must be finite but has no other bound. A span of held input takes at most 100 000 steps.
    ///
    /// # Panics
    ///
    /// Panics if the absolute tolerance is not positive or the relative tolerance is negative,
    /// because an entry of 0 never meets them.
    pub fn new(dimension: usize, tolerance: Tolerance) -> Self {
        assert!(
            tolerance.absolute > 0.0 && tolerance.relative >= 0.0,
            "{tolerance:?} is never met: the absolute tolerance must be positive and the relative \
             one not negative"
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

    /// Sets a bound on |x| of each entry, beyond which the solution counts as diverged.
    #[must_use]
    pub fn bounded_by(self, bound: f64) -> Self {
        Self { bound, ..self }
    }

    /// Sets the largest number of steps over each span of held input, including rejected ones.
    #[must_use]
    pub fn within_steps(self, step_limit: usize) -> Self {
        Self { step_limit, ..self }
    }

    /// Integrates x (n) in place over [t0, t1] \[s\], t0 ≤ t1, under a held input u (m).
    ///
    /// Where the solution diverges, x is the last valid state. The next call starts with the step
    /// size of this one, so that a motion continues over the jumps of its input.
    ///
    /// # Panics
    ///
    /// Panics if the length of x differs from the dimension of the integrator.
    pub fn integrate<F: VectorField<f64>>(
        &mut self,
        field: &mut F,
        [mut t, end]: [f64; 2],
        x: &mut [f64],
        u: &[f64],
    ) -> Outcome {
        assert_eq!(
            x.len(),
            self.next.len(),
            "the number of states differs from the dimension of the integrator"
        );
        let resolution = f64::EPSILON * t.abs().max(end.abs());
        // First slope. The derivative of the previous span is not valid, because the input may have
        // jumped.
        field.rate(t, x, u, &mut self.slopes[0]);
        for _ in 0..self.step_limit {
            // End of the span, or divergence.
            if !is_within(x, self.bound) {
                return Outcome::Diverged { time: t, cause: Cause::Bound };
            }
            if t >= end {
                return Outcome::Reached;
            }
            // Step size. A remainder below a hundredth of a step is merged into the last step.
            let proposal = match self.control.proposal {
                Some(proposal) => proposal,
                None => self.first_step(field, [t, end], x, u),
            };
            let is_last = t + 1.01 * proposal >= end;
            let h = if is_last { end - t } else { proposal };
            // Stages and error estimate.
            let error = self.attempt(field, t, h, x, u);
            if error <= 1.0 {
                // Acceptance. The last slope is the first one of the next step.
                self.control.accept(h, error, h < proposal);
                t = if is_last { end } else { t + h };
                x.copy_from_slice(&self.next);
                self.slopes.swap(0, 6);
            } else {
                // Rejection. A step below the resolution of t cannot be reduced further.
                self.control.reject(h, error);
                if h <= resolution {
                    self.control.proposal = None;
                    return Outcome::Diverged { time: t, cause: Cause::StepSize };
                }
            }
        }
        Outcome::Diverged { time: t, cause: Cause::StepCount }
    }

    /// Simulates a run whose input is held from sample to sample of `times` \[s\] (increasing).
    ///
    /// It calls `observe` with the index of each sample that it reaches, from 0 on, and the state
    /// there (n). Steps end at samples, because the input jumps there.
    ///
    /// # Panics
    ///
    /// Panics if the length of the start differs from the dimension of the integrator. It also
    /// panics if the inputs do not form one row per sample except the last.
    pub fn simulate<F: VectorField<f64>>(
        &mut self,
        field: &mut F,
        times: &[f64],
        run: InitialValueProblem<'_>,
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

    /// Computes the stages of a step of size h \[s\] and returns the norm of its error.
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
        let error = (0..x.len()).map(|i| h * weighted_sum(&ERROR_WEIGHTS, &self.slopes, i));
        self.tolerance.norm(error, x, &self.next)
    }

    /// Returns the size of the first step \[s\], from an estimate of the second derivative (Hairer,
    /// Nørsett & Wanner, sec. II.4).
    fn first_step<F: VectorField<f64>>(
        &mut self,
        field: &mut F,
        [t, end]: [f64; 2],
        x: &[f64],
        u: &[f64],
    ) -> f64 {
        // A guess from the norms of x and ẋ.
        let norm = |v: &mut dyn Iterator<Item = f64>| self.tolerance.norm(v, x, x);
        let size = norm(&mut x.iter().copied());
        let speed = norm(&mut self.slopes[0].iter().copied());
        let guess = if size < 1e-5 || speed < 1e-5 { 1e-6 } else { 0.01 * size / speed };
        let guess = guess.min(end - t);
        // The second derivative, from an explicit Euler step.
        for (next, (x, slope)) in self.next.iter_mut().zip(x.iter().zip(&self.slopes[0])) {
            *next = x + guess * slope;
        }
        let [first, second, ..] = &mut self.slopes;
        field.rate(t + guess, &self.next, u, second);
        let curvature =
            self.tolerance.norm(first.iter().zip(&*second).map(|(a, b)| b - a), x, x) / guess;
        // The step at which the leading error term is about 1 % of the tolerance.
        let fastest = speed.max(curvature);
        let step =
            if fastest <= 1e-15 { (1e-3 * guess).max(1e-6) } else { (0.01 / fastest).powf(0.2) };
        let step = step.min(100.0 * guess).min(end - t);
        // `step` is NaN if the rate is NaN; a step over the whole span then fails.
        if step > 0.0 { step } else { end - t }
    }
}
