use reachtube_abstraction::{Linearisation, ModelField, PolynomialModel};
use reachtube_ode::RungeKutta4;

use crate::nominal::transition::Transition;

/// The model from one sample to the next, with its derivatives.
pub(super) struct ModelSteps<'a> {
    model: &'a PolynomialModel,
    linearisation: Linearisation,
    field: ModelField<'a, f64>,
    method: RungeKutta4<f64>,
    substeps: usize,
    transition: Transition,
}

/// One step of the model.
pub(super) struct Step<'a> {
    /// The state reached, including the sines and cosines that the model counts as states.
    pub reached: Vec<f64>,
    /// The derivative with respect to the state before, row-major, 2n x 2n.
    pub transition: &'a [f64],
    /// The derivative with respect to the held input, row-major, 2n x n.
    pub gain: &'a [f64],
}

impl<'a> ModelSteps<'a> {
    pub(super) fn new(model: &'a PolynomialModel, substeps: usize) -> Self {
        let (linearisation, field) = (Linearisation::new(model), ModelField::new(model));
        let (method, n) = (RungeKutta4::new(model.states()), model.joints());
        let transition = Transition::new(2 * n, n);
        Self { model, linearisation, field, method, substeps, transition }
    }

    /// Integrates from the state `before` under a held input; the derivatives are those halfway to
    /// `after`.
    pub(super) fn step(
        &mut self,
        times: [f64; 2],
        before: &[f64],
        after: &[f64],
        held: &[f64],
    ) -> Step<'_> {
        let n = held.len();
        let mut x = self.model.state(&before[..n], &before[n..]);
        self.method.integrate(&mut self.field, times, self.substeps, &mut x, held);
        let middle: Vec<f64> = before.iter().zip(after).map(|(x, y)| 0.5 * (x + y)).collect();
        let (a, b) = self.linearisation.at(&middle, held);
        self.transition.update(a, b, times[1] - times[0]);
        Step { reached: x, transition: &self.transition.phi, gain: &self.transition.gamma }
    }
}
