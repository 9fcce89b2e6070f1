use reachtube_ode::{Ensemble, InitialValueProblem, Outcome};
use reachtube_reach::{Nonlinear, System};
use reachtube_recordings::State;

use crate::data::case::Case;
use crate::data::runaway::Runaway;
use crate::data::setup::Compensation;
use crate::error::{Error, Result};
use crate::nominal::simulate::{BOUND, runs_away, substeps};
use crate::nominal::steps::LinearSteps;

/// A nominal motion with the inputs that cause it, unrounded.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct NominalMotion {
    pub states: Vec<f64>,
    /// The corrected input, samples x m. The last one acts on nothing and is the recorded one.
    pub inputs: Vec<f64>,
}

/// Simulates the nominal motion of a case from its recorded inputs, less what is compensated;
/// `steps` discretise a linear model over the case's grid.
pub(crate) fn motion(
    system: &System,
    case: &Case,
    steps: Option<&LinearSteps>,
    compensation: Option<Box<dyn Compensation>>,
) -> Result<NominalMotion> {
    match motion_until(system, case, steps, compensation)? {
        (motion, None) => Ok(motion),
        (_, Some(Runaway { case, time, .. })) => Err(Error::RunsAway { case, time }),
    }
}

/// Simulates the nominal motion of a case as [`motion`] does. If the motion of a linear model
/// diverges, returns where; from there on its states and inputs are 0.
///
/// # Errors
///
/// [`Error::RunsAway`](crate::Error::RunsAway) for a model that is not linear.
pub(crate) fn motion_until(
    system: &System,
    case: &Case,
    steps: Option<&LinearSteps>,
    mut compensation: Option<Box<dyn Compensation>>,
) -> Result<(NominalMotion, Option<Runaway>)> {
    let correct = |k: usize, x: &[f64], u: &mut [f64]| {
        if let Some(compensation) = &mut compensation {
            compensation.apply(k, x, u);
        }
    };
    match (steps, system) {
        (Some(steps), _) => Ok(linear(case, steps, correct)),
        (None, System::Nonlinear(system)) => Ok((nonlinear(&**system, case, correct)?, None)),
        (None, System::Linear(system)) => {
            Ok(linear(case, &LinearSteps::new(system, case.grid.times()), correct))
        }
    }
}

fn linear(
    case: &Case,
    steps: &LinearSteps,
    mut correct: impl FnMut(usize, &[f64], &mut [f64]),
) -> (NominalMotion, Option<Runaway>) {
    let (n, samples) = (case.parts(), case.grid.len());
    let mut inputs = case.inputs.to_vec();
    let mut states = vec![0.0; samples * 2 * n];
    states[..2 * n].copy_from_slice(&case.start);
    for k in 0..samples.saturating_sub(1) {
        let (before, after) = states.split_at_mut((k + 1) * 2 * n);
        let (x, u) = (&before[k * 2 * n..], &mut inputs[k * n..(k + 1) * n]);
        correct(k, x, u);
        steps.advance(k, x, u, &mut after[..2 * n]);
        if !after[..2 * n].iter().all(|x| x.abs() < BOUND) {
            let sizes = after[..2 * n].iter().map(|x| x.abs()).enumerate();
            let (state, _) = sizes.max_by(|a, b| a.1.total_cmp(&b.1)).unwrap_or_default();
            after.fill(0.0);
            inputs[(k + 1) * n..].fill(0.0);
            let (case, time) = (case.name.clone(), case.grid.times()[k]);
            let runaway = Runaway { case, sample: k, time, state: State::from_index(state, n) };
            return (NominalMotion { states, inputs }, Some(runaway));
        }
    }
    (NominalMotion { states, inputs }, None)
}

fn nonlinear(
    system: &dyn Nonlinear,
    case: &Case,
    mut correct: impl FnMut(usize, &[f64], &mut [f64]),
) -> Result<NominalMotion> {
    let (n, times) = (case.parts(), case.grid.times());
    let substeps = substeps(&mut *system.slopes(), case, &case.start);
    let (mut field, mut x) = (system.field(), system.lift(&case.start));
    let mut ensemble = Ensemble::<f64>::new(x.len()).bounded_by(BOUND);
    let (mut inputs, mut states) = (case.inputs.to_vec(), case.start.clone());
    for k in 0..times.len().saturating_sub(1) {
        let u = &mut inputs[k * n..(k + 1) * n];
        correct(k, &x[..2 * n], u);
        let (run, mut next) = ([InitialValueProblem { start: &x, inputs: u }], x.clone());
        let outcomes =
            ensemble.integrate(&mut *field, &times[k..k + 2], substeps, &run, |_, _, x| {
                next.copy_from_slice(x);
            });
        if let Outcome::Diverged { .. } = outcomes[0] {
            return Err(runs_away(case, times[k]));
        }
        x = next;
        states.extend(&x[..2 * n]);
    }
    Ok(NominalMotion { states, inputs })
}
