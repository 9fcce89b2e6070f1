//! Gradient of the state at a later sample with respect to a disturbance: the adjoint of the
//! linearised model.

use nalgebra::{DMatrix, DVector};
use reachtube_conform::data::Case;
use reachtube_ode::{Ensemble, InitialValueProblem};
use reachtube_reach::System;

/// Bound of h |A| for a Runge-Kutta step of length h: its error is then below 1e-7 of the change.
const STEP_NORM: f64 = 0.1;

/// Beyond this |x| a motion counts as having diverge, rad or rad/s.
const BOUND: f64 = 1e4;

/// The motion of a model under given inputs, and its linearisation along the motion.
pub(super) struct Motion {
    /// Samples x 2n.
    pub states: Vec<f64>,
    /// A and B at each sample but the last.
    slopes: Vec<[DMatrix<f64>; 2]>,
}

impl Motion {
    /// Simulates a model along the samples of a case from `start` (2n) under `inputs` (samples x
    /// n); ends early if the motion diverges.
    pub(super) fn new(dynamics: &System, case: &Case, start: &[f64], inputs: &[f64]) -> Self {
        let (n, times) = (case.parts(), case.grid.times());
        let inputs = &inputs[..n * times.len().saturating_sub(1)];
        let mut states: Vec<f64> = Vec::with_capacity(times.len() * 2 * n);
        let mut observe = |_: usize, _: usize, x: &[f64]| states.extend(&x[..2 * n]);
        let substeps = |a: &DMatrix<f64>| {
            let norm = a.row_iter().map(|row| row.lp_norm(1)).fold(0.0, f64::max);
            (norm * case.grid.longest_step() / STEP_NORM).ceil().clamp(1.0, 1e3) as usize
        };
        let slopes = match dynamics {
            System::Linear(system) => {
                let run = [InitialValueProblem { start, inputs }];
                let mut ensemble = Ensemble::<f64>::new(2 * n).bounded_by(BOUND);
                let substeps = substeps(system.a());
                let _ = ensemble.integrate(&mut &*system, times, substeps, &run, &mut observe);
                let steps = (states.len() / (2 * n)).saturating_sub(1);
                vec![[system.a().clone(), system.b().clone()]; steps]
            }
            System::Nonlinear(system) => {
                let mut slopes = system.slopes();
                let mut at = |x: &[f64], u: &[f64]| {
                    let (a, b) = slopes.at(x, u);
                    [a.clone(), b.clone()]
                };
                let [a, _] = at(start, inputs.get(..n).unwrap_or(&vec![0.0; n]));
                let lifted = system.lift(start);
                let run = [InitialValueProblem { start: &lifted, inputs }];
                let mut ensemble = Ensemble::<f64>::new(lifted.len()).bounded_by(BOUND);
                let _ = ensemble.integrate(
                    &mut *system.field(),
                    times,
                    substeps(&a),
                    &run,
                    &mut observe,
                );
                let rows = states.chunks_exact(2 * n).zip(inputs.chunks_exact(n));
                rows.map(|(x, u)| at(x, u)).collect()
            }
        };
        Self { states, slopes }
    }

    /// Returns the derivatives of λᵀ x at sample `sample` by the start (2n) and by the input held
    /// from each earlier sample on (sample x n).
    pub(super) fn adjoint(
        &self,
        case: &Case,
        sample: usize,
        functional: &[f64],
    ) -> (Vec<f64>, Vec<f64>) {
        let (n, times) = (case.parts(), case.grid.times());
        let mut adjoint = DVector::from_column_slice(functional);
        let mut by_input = vec![0.0; sample * n];
        for k in (0..sample.min(self.slopes.len())).rev() {
            let ([a, b], h) = (&self.slopes[k], times[k + 1] - times[k]);
            // ∫ e^{Aᵀτ} λ dτ and e^{Aᵀh} λ by their series, for the direction of a search.
            let (mut term, mut integral, mut next) =
                (adjoint.clone(), h * &adjoint, adjoint.clone());
            for order in 1..=4 {
                term = a.tr_mul(&term) * (h / f64::from(order));
                integral += &term * (h / f64::from(order + 1));
                next += &term;
            }
            by_input[k * n..(k + 1) * n].copy_from_slice(b.tr_mul(&integral).as_slice());
            adjoint = next;
        }
        (adjoint.as_slice().to_vec(), by_input)
    }
}
