use reachtube_ode::VectorField;
use reachtube_scalar::Powers;

use crate::polynomial_model::{ModelWorkspace, PolynomialModel};

/// A polynomial model as the differential equation ẋ = f_p(x, u), for the integrators of
/// `reachtube-ode`. Over SIMD lanes each lane is a run of its own. Evaluations do not allocate.
///
/// # Examples
///
/// ```
/// use reachtube_abstraction::{ExpansionPoint, ModelField, ModelKind, PolynomialModel};
/// use reachtube_ode::{DormandPrince, InitialValueProblem, Tolerance};
/// use reachtube_robot::Robot;
///
/// let point = ExpansionPoint::zero(6);
/// let model = PolynomialModel::new(&Robot::lwa4p(), ModelKind::Two, 12, &point)?;
/// let start = model.state(&[0.3; 6], &[0.0; 6]);
/// let run = InitialValueProblem { start: &start, inputs: &[1.0; 2 * 6] };
/// let mut solver = DormandPrince::new(model.states(), Tolerance::default());
/// let mut field = ModelField::new(&model);
/// let outcome = solver.simulate(&mut field, &[0.0, 0.004, 0.008], run, |_sample, x| {
///     assert!((x[12] - x[0].sin()).abs() < 1e-8);
/// });
/// assert!(outcome.is_reached());
/// # Ok::<(), reachtube_abstraction::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct ModelField<'a, S> {
    model: &'a PolynomialModel,
    ws: ModelWorkspace<S>,
}

impl<'a, S: Powers> ModelField<'a, S> {
    /// Returns the vector field of `model`, with scratch memory of its own.
    #[must_use]
    pub fn new(model: &'a PolynomialModel) -> Self {
        Self { model, ws: model.workspace() }
    }
}

impl<S: Powers> VectorField<S> for ModelField<'_, S> {
    fn rate(&mut self, _: f64, x: &[S], u: &[S], dx: &mut [S]) {
        self.model.rate_into(x, u, &mut self.ws, dx);
    }
}
