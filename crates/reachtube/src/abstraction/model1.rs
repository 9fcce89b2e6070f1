use nalgebra::{DMatrix, DVector};
use reachtube_reach::LinearSystem;
use reachtube_robot::Robot;

use super::ExpansionPoint;
use crate::error::{Error, Result};

/// Model 1 (13) at order p = 1: ẋ = A x + B u + d with x = (q, q̇),
/// A = [0 I; 0 -M⁻¹ diag(τ_v'(q̇_a))], B = [0; M⁻¹], d = [0; -M⁻¹ (τ_v(q̇_a) - τ_v'(q̇_a) q̇_a)], M = M_m(q_a).
///
/// The double-precision result is the model; what it leaves out is for the uncertainty sets to cover.
///
/// # Errors
///
/// [`Error::Setting`] when M_m(q_a) is not positive definite.
///
/// # Examples
///
/// ```
/// use reachtube::abstraction::{ExpansionPoint, linear_model};
/// use reachtube_robot::Robot;
///
/// let model = linear_model(&Robot::lwa4p(), &ExpansionPoint::zero(6))?;
/// assert_eq!((model.states(), model.inputs()), (12, 6));
/// assert_eq!(model.a()[(0, 6)], 1.0);
/// # Ok::<(), reachtube::Error>(())
/// ```
pub fn linear_model(robot: &Robot, point: &ExpansionPoint) -> Result<LinearSystem> {
    let n = robot.joint_count();
    let inverse = robot.mass_matrix(&point.q).cholesky().map(|factor| factor.inverse()).ok_or_else(|| {
        Error::Setting(format!(
            "the mass matrix of {} is not positive definite at the expansion point q = {:?} rad; it is no physical robot there",
            robot.name(),
            point.q
        ))
    })?;
    let (slope, constant) = viscous_expansion(robot, &point.qd);
    let mut a = DMatrix::zeros(2 * n, 2 * n);
    a.view_mut((0, n), (n, n)).fill_with_identity();
    a.view_mut((n, n), (n, n)).copy_from(&(-&inverse * DMatrix::from_diagonal(&slope)));
    let mut b = DMatrix::zeros(2 * n, n);
    b.rows_mut(n, n).copy_from(&inverse);
    let mut drift = DVector::zeros(2 * n);
    drift.rows_mut(n, n).copy_from(&(-inverse * constant));
    Ok(LinearSystem::new(a, b, drift)?)
}

/// T¹ of τ_v about q̇_a: the slopes τ_v'(q̇_a), and what is left at q̇ = 0, τ_v(q̇_a) - τ_v'(q̇_a) q̇_a.
fn viscous_expansion(robot: &Robot, qd: &[f64]) -> (DVector<f64>, DVector<f64>) {
    let terms = robot.joints().iter().zip(qd).map(|(joint, qd)| {
        let viscous = &joint.friction.viscous;
        let slope = viscous.slope(qd);
        (slope, viscous.torque(qd) - slope * qd)
    });
    let (slopes, constants): (Vec<f64>, Vec<f64>) = terms.unzip();
    (DVector::from_vec(slopes), DVector::from_vec(constants))
}
