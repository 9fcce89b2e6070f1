//! The three models of the forward dynamics (Sec. IV-B of the paper): ẋ = f_p(x, u), linear or
//! polynomial.

mod build;
mod error;
mod expansion_point;
mod field;
mod file;
mod formula;
mod layout;
mod linearisation;
mod operating_box;
mod polynomial_model;
mod remainder;
mod seen_error;

pub use error::{Error, Result};
pub use expansion_point::ExpansionPoint;
pub use field::ModelField;
pub use file::{Records, TermRecord};
pub use layout::Layout;
pub use linearisation::Linearisation;
pub use operating_box::OperatingBox;
pub use polynomial_model::{Abstraction, ModelKind, ModelWorkspace, PolynomialModel};
use reachtube_reach::LinearSystem;
use reachtube_robot::Robot;
pub use remainder::Remainder;

/// Model 1 (13) at order p = 1: ẋ = A x + B u + d with x = (q, q̇), A = [0 I; 0 -M⁻¹
/// diag(τ_v'(q̇_a))], B = [0; M⁻¹], d = [0; -M⁻¹ (τ_v(q̇_a) - τ_v'(q̇_a) q̇_a)], M = M_m(q_a).
///
/// The double-precision result is the model; what it leaves out is for the uncertainty sets to
/// cover.
///
/// # Errors
///
/// [`Error::Setting`](crate::Error::Setting) when M_m(q_a) is not positive definite.
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
