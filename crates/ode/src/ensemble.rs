//! Thousands of runs by one integrator.

use crate::outcome::is_within;
use crate::{Cause, Outcome, Run, RungeKutta4, VectorField};
use reachtube_scalar::Lanewise;

/// Many runs of one field with fixed steps, as many at a time as the number S has lanes.
///
/// Each run has the states of the same run alone over `f64`, to the last bit, where the field's
/// operations do. A run that diverges does not touch the others. For several threads, give each an
/// ensemble, a field and a part of the runs.
///
/// # Examples
///
/// ```
/// use reachtube_ode::{Ensemble, Run, VectorField};
/// use reachtube_scalar::{Lanes, Lanewise};
///
/// /// A pendulum under a torque, over any number of lanes.
/// struct Pendulum;
/// impl<S: Lanewise> VectorField<S> for Pendulum {
///     fn rate(&mut self, _: f64, x: &[S], u: &[S], dx: &mut [S]) {
///         (dx[0], dx[1]) = (x[1], u[0] - x[0].map(f64::sin));
///     }
/// }
///
/// let times: Vec<f64> = (0..=100).map(|k| 0.01 * f64::from(k)).collect();
/// let starts: Vec<_> = (0..1000).map(|r| [1e-3 * f64::from(r), 0.0]).collect();
/// let runs: Vec<_> = starts.iter().map(|start| Run { start, inputs: &[0.0; 100] }).collect();
/// let mut highest = 0.0_f64;
/// let outcomes = Ensemble::<Lanes<8>>::new(2).integrate(&mut Pendulum, &times, 1, &runs, |_run, _sample, x| {
///     highest = highest.max(x[0]);
/// });
/// assert!(outcomes.iter().all(|outcome| outcome.is_reached()) && highest == 0.999);
/// ```
#[derive(Clone, Debug)]
pub struct Ensemble<S> {
    method: RungeKutta4<S>,
    bound: f64,
    x: Vec<S>,
    u: Vec<S>,
    /// The state of one run.
    row: Vec<f64>,
}

impl<S: Lanewise> Ensemble<S> {
    /// For states of `dimension` entries; no bound on |x| but that it be finite.
    pub fn new(dimension: usize) -> Self {
        Self {
            method: RungeKutta4::new(dimension),
            bound: f64::MAX,
            x: vec![S::zero(); dimension],
            u: Vec::new(),
            row: vec![0.0; dimension],
        }
    }

    /// The same with a bound on the |x| of each entry at samples, beyond which a run counts as
    /// diverged.
    #[must_use]
    pub fn bounded_by(self, bound: f64) -> Self {
        Self { bound, ..self }
    }

    /// Integrates every run over samples at `times` \[s\] (increasing), with `substeps` Runge-Kutta
    /// steps from one sample to the next. `observe` is given run, sample (both from 0) and state
    /// (n), the samples of a run in their order, until the run ends or diverges. The outcomes are
    /// those of the runs.
    ///
    /// # Panics
    ///
    /// When a start has another length than the ensemble's dimension, or inputs differ in length or
    /// are not a row for each sample but the last.
    pub fn integrate<F: VectorField<S>>(
        &mut self,
        field: &mut F,
        times: &[f64],
        substeps: usize,
        runs: &[Run<'_>],
        mut observe: impl FnMut(usize, usize, &[f64]),
    ) -> Vec<Outcome> {
        let mut outcomes = vec![Outcome::Reached; runs.len()];
        for (block, runs) in runs.chunks(S::LANES).enumerate() {
            let first = block * S::LANES;
            let outcomes = &mut outcomes[first..first + runs.len()];
            self.start(runs);
            self.report(times, 0, outcomes, &mut |lane, x| observe(first + lane, 0, x));
            for k in 1..times.len() {
                if !outcomes.iter().any(Outcome::is_reached) {
                    break;
                }
                self.hold(times, runs, k - 1);
                self.method.integrate(
                    field,
                    [times[k - 1], times[k]],
                    substeps,
                    &mut self.x,
                    &self.u,
                );
                self.report(times, k, outcomes, &mut |lane, x| observe(first + lane, k, x));
            }
        }
        outcomes
    }

    /// Lanes beyond the last run repeat it.
    fn start(&mut self, runs: &[Run<'_>]) {
        let n = self.x.len();
        assert!(
            runs.iter().all(|run| run.start.len() == n),
            "a start has another length than the ensemble's {n}"
        );
        for (i, x) in self.x.iter_mut().enumerate() {
            *x = S::from_lanes(|lane| runs[lane.min(runs.len() - 1)].start[i]);
        }
    }

    fn hold(&mut self, times: &[f64], runs: &[Run<'_>], k: usize) {
        let m = runs[0].input_dimension(times);
        self.u.resize(m, S::zero());
        for (i, u) in self.u.iter_mut().enumerate() {
            *u = S::from_lanes(|lane| runs[lane.min(runs.len() - 1)].input(k, m)[i]);
        }
    }

    /// Gives each run's state at sample k to `observe`, unless the run has diverged.
    fn report(
        &mut self,
        times: &[f64],
        k: usize,
        outcomes: &mut [Outcome],
        observe: &mut dyn FnMut(usize, &[f64]),
    ) {
        for (lane, outcome) in
            outcomes.iter_mut().enumerate().filter(|(_, outcome)| outcome.is_reached())
        {
            self.row.iter_mut().zip(&self.x).for_each(|(row, x)| *row = x.lane(lane));
            if is_within(&self.row, self.bound) {
                observe(lane, &self.row);
            } else {
                *outcome =
                    Outcome::Diverged { time: times[k.saturating_sub(1)], cause: Cause::Bound };
            }
        }
    }
}
