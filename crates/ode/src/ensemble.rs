//! Thousands of runs by one integrator.

use reachtube_scalar::Lanewise;

use crate::outcome::{Cause, Outcome, is_within};
use crate::run::InitialValueProblem;
use crate::runge_kutta::RungeKutta4;
use crate::vector_field::VectorField;

/// An integrator of many runs of one field with fixed steps, one run per lane of the scalar S.
///
/// The states of a run equal the states of the same run over `f64`, to the last bit, if the
/// operations of the field do. A run that diverges does not affect the others. With several
/// threads, each needs its own ensemble, field and part of the runs.
///
/// # Examples
///
/// ```
/// use reachtube_ode::{Ensemble, InitialValueProblem, VectorField};
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
/// let runs: Vec<_> = starts
///     .iter()
///     .map(|start| InitialValueProblem { start, inputs: &[0.0; 100] })
///     .collect();
/// let mut highest = 0.0_f64;
/// let mut ensemble = Ensemble::<Lanes<8>>::new(2);
/// let outcomes = ensemble.integrate(&mut Pendulum, &times, 1, &runs, |_run, _sample, x| {
///     highest = highest.max(x[0]);
/// });
/// assert!(outcomes.iter().all(|outcome| outcome.is_reached()) && highest == 0.999);
/// ```
#[derive(Clone, Debug)]
pub struct Ensemble<S> {
    method: RungeKutta4<S>,
    /// Bound on |x| of each entry.
    bound: f64,
    /// States of the runs of one block (n).
    x: Vec<S>,
    /// Inputs of the runs of one block (m).
    u: Vec<S>,
    /// The state of one run (n).
    row: Vec<f64>,
}

impl<S: Lanewise> Ensemble<S> {
    /// Returns an ensemble for states with `dimension` entries. |x| must be finite but has no other
    /// bound.
    pub fn new(dimension: usize) -> Self {
        Self {
            method: RungeKutta4::new(dimension),
            bound: f64::MAX,
            x: vec![S::zero(); dimension],
            u: Vec::new(),
            row: vec![0.0; dimension],
        }
    }

    /// Sets a bound on |x| of each entry at samples, beyond which a run counts as diverged.
    #[must_use]
    pub fn bounded_by(self, bound: f64) -> Self {
        Self { bound, ..self }
    }

    /// Integrates every run over samples at `times` \[s\] (increasing) and returns one outcome per
    /// run.
    ///
    /// Each span between two samples takes `substeps` Runge-Kutta steps. `observe` gets the indices
    /// of run and sample, both from 0, and the state (n). The samples of a run arrive in order,
    /// until the run ends or diverges.
    ///
    /// # Panics
    ///
    /// Panics if the length of a start differs from the dimension of the ensemble. It also panics
    /// if inputs differ in length, or do not form one row per sample except the last.
    pub fn integrate<F: VectorField<S> + ?Sized>(
        &mut self,
        field: &mut F,
        times: &[f64],
        substeps: usize,
        runs: &[InitialValueProblem<'_>],
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

    /// Loads the starts of a block of runs. Lanes beyond the last run repeat it.
    fn start(&mut self, runs: &[InitialValueProblem<'_>]) {
        let n = self.x.len();
        assert!(
            runs.iter().all(|run| run.start.len() == n),
            "every start needs {n} entries, the dimension of the ensemble"
        );
        for (i, x) in self.x.iter_mut().enumerate() {
            *x = S::from_lanes(|lane| runs[lane.min(runs.len() - 1)].start[i]);
        }
    }

    /// Loads the inputs from sample k on.
    fn hold(&mut self, times: &[f64], runs: &[InitialValueProblem<'_>], k: usize) {
        let m = runs[0].input_dimension(times);
        self.u.resize(m, S::zero());
        for (i, u) in self.u.iter_mut().enumerate() {
            *u = S::from_lanes(|lane| runs[lane.min(runs.len() - 1)].input(k, m)[i]);
        }
    }

    /// Calls `observe` with the state at sample k of each run that has not diverged.
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
