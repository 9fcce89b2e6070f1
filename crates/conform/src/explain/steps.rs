use nalgebra::DMatrix;
use reachtube_abstraction::{Linearisation, ModelField, PolynomialModel};
use reachtube_ode::RungeKutta4;

/// The model from one sample to the next, with its derivatives.
pub(super) struct ModelSteps<'a> {
    model: &'a PolynomialModel,
    linearisation: Linearisation,
    field: ModelField<'a, f64>,
    method: RungeKutta4<f64>,
    substeps: usize,
}

/// One step of the model.
pub(super) struct Step {
    /// The state reached, including the sines and cosines that the model counts as states.
    pub reached: Vec<f64>,
    /// The derivative with respect to the state before, 2n x 2n.
    pub transition: DMatrix<f64>,
    /// The derivative with respect to the held input, 2n x n.
    pub gain: DMatrix<f64>,
}

impl<'a> ModelSteps<'a> {
    pub(super) fn new(model: &'a PolynomialModel, substeps: usize) -> Self {
        let (linearisation, field) = (Linearisation::new(model), ModelField::new(model));
        Self { model, linearisation, field, method: RungeKutta4::new(model.states()), substeps }
    }

    /// Integrates from the state `before` under a held input; the derivatives are those halfway to
    /// `after`.
    pub(super) fn step(
        &mut self,
        times: [f64; 2],
        before: &[f64],
        after: &[f64],
        held: &[f64],
    ) -> Step {
        let n = held.len();
        let mut x = self.model.state(&before[..n], &before[n..]);
        self.method.integrate(&mut self.field, times, self.substeps, &mut x, held);
        let middle: Vec<f64> = before.iter().zip(after).map(|(x, y)| 0.5 * (x + y)).collect();
        let (a, b) = self.linearisation.at(&middle, held);
        let mut augmented = DMatrix::zeros(3 * n, 3 * n);
        augmented.view_mut((0, 0), (2 * n, 2 * n)).copy_from(a);
        augmented.view_mut((0, 2 * n), (2 * n, n)).copy_from(b);
        let exponential = (augmented * (times[1] - times[0])).exp();
        Step {
            reached: x,
            transition: exponential.view((0, 0), (2 * n, 2 * n)).into_owned(),
            gain: exponential.view((0, 2 * n), (2 * n, n)).into_owned(),
        }
    }
}
