//! The motion of a model under known inputs, in floating point.

use reachtube_ode::{Ensemble, InitialValueProblem, Outcome};
use reachtube_reach::{Nonlinear, Slopes};

use crate::data::case::Case;
use crate::error::{Error, Result};

/// Bound of h |A| for a Runge-Kutta step of length h: its error is then below 1e-7 of the change.
pub(crate) const STEP_NORM: f64 = 0.1;

/// Beyond this |x| a motion counts as having diverged, rad or rad/s.
pub(crate) const BOUND: f64 = 1e4;

/// Simulates a model along a case from its start under its inputs, without any uncertainty: samples
/// x N, unrounded.
pub(crate) fn nominal(system: &dyn Nonlinear, case: &Case) -> Result<Vec<f64>> {
    let start = case.start.clone();
    let substeps = substeps(&mut *system.slopes(), case, &start);
    simulate(system, case.grid.times(), substeps, &start, &case.inputs)
        .map_err(|time| runs_away(case, time))
}

/// Returns the number of Runge-Kutta steps from one sample to the next.
pub(crate) fn substeps(slopes: &mut dyn Slopes, case: &Case, start: &[f64]) -> usize {
    let rest = vec![0.0; case.parts()];
    let (a, _) = slopes.at(start, case.inputs.get(..case.parts()).unwrap_or(&rest));
    let norm = a.row_iter().map(|row| row.lp_norm(1)).fold(0.0, f64::max);
    (norm * case.grid.longest_step() / STEP_NORM).ceil().clamp(1.0, 1e3) as usize
}

pub(crate) fn runs_away(case: &Case, time: f64) -> Error {
    Error::RunsAway { case: case.name.clone(), time }
}

/// Simulates the state at all samples under `inputs` from `start`, samples x N.
///
/// # Errors
///
/// The time, s, up to which the model could be followed, where it diverges.
pub(crate) fn simulate(
    system: &dyn Nonlinear,
    times: &[f64],
    substeps: usize,
    start: &[f64],
    inputs: &[f64],
) -> Result<Vec<f64>, f64> {
    let dimension = system.states();
    let start = system.lift(start);
    let inputs = &inputs[..system.inputs() * times.len().saturating_sub(1)];
    let mut states = Vec::with_capacity(times.len() * dimension);
    let run = [InitialValueProblem { start: &start, inputs }];
    let mut ensemble = Ensemble::<f64>::new(start.len()).bounded_by(BOUND);
    let outcomes = ensemble.integrate(&mut *system.field(), times, substeps, &run, |_, _, x| {
        states.extend(&x[..dimension]);
    });
    match outcomes[0] {
        Outcome::Reached => Ok(states),
        Outcome::Diverged { time, .. } => Err(time),
    }
}
