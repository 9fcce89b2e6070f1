use reachtube_reach::LinearSystem;
use reachtube_robot::Robot;

use crate::error::Result;
use crate::expansion_point::ExpansionPoint;
use crate::model_kind::ModelKind;
use crate::polynomial_model::PolynomialModel;

/// Returns model 1 (13) of order 1, the linear system ẋ = A x + B u + d with x = (q, q̇).
///
/// With M = M_m(q_a): A = [0 I; 0 -M⁻¹ diag(τ_v'(q̇_a))], 2n x 2n; B = [0; M⁻¹], 2n x n; and
/// d = [0; -M⁻¹ (τ_v(q̇_a) - τ_v'(q̇_a) q̇_a)], 2n.
///
/// The double-precision result is the model. Its truncation error is for the uncertainty sets to
/// cover.
///
/// # Errors
///
/// [`Error::SingularMassMatrix`](crate::Error::SingularMassMatrix) when M_m(q_a) is not positive
/// definite.
///
/// # Examples
///
/// ```
/// use reachtube_abstraction::{ExpansionPoint, linear_model};
/// use reachtube_robot::Robot;
///
/// let model = linear_model(&Robot::lwa4p(), &ExpansionPoint::zero(6))?;
/// assert_eq!((model.states(), model.inputs()), (12, 6));
/// assert_eq!(model.a()[(0, 6)], 1.0);
/// # Ok::<(), reachtube_abstraction::Error>(())
/// ```
pub fn linear_model(robot: &Robot, point: &ExpansionPoint) -> Result<LinearSystem> {
    PolynomialModel::new(robot, ModelKind::One, 1, point)?.linear_system()
}
