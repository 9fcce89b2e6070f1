//! M, c and g as exact polynomials in the sines and cosines of the joint angles, and in the
//! positions of prismatic joints.

use crate::joint_kind::JointKind;
use crate::robot::Robot;
use crate::workspace::Workspace;
use reachtube_scalar::{Scalar, TaylorPolynomial, TaylorSpace, TaylorSpaceError};
use std::sync::Arc;

/// The dynamics of a robot as polynomials in (s_1..s_n, c_1..c_n), with s_i = sin q_i and
/// c_i = cos q_i as independent variables (Property A). For a prismatic joint s_i is q_i \[m\], and
/// no polynomial depends on c_i.
///
/// A polynomial on the circle s² + c² = 1 has many extensions off the circle. Here M is the
/// extension of the composite-body algorithm ([`Robot::crba`]), and c follows from M by Christoffel
/// symbols (12). Then c has degree 2(n - 1) in (s, c), which with q̇ is the paper's p_max = 12 for
/// six joints. [`Robot::coriolis`] has another extension, of degree 13 for the LWA 4P.
///
/// # Guarantee
///
/// The polynomials are not truncated. Over `Interval`, each coefficient encloses the exact one for
/// the robot's constants as loaded.
#[derive(Clone, Debug)]
pub struct PolynomialDynamics<C = f64> {
    /// Kinds of the joints, n entries.
    pub kinds: Vec<JointKind>,
    /// The space of the 2n variables.
    pub space: Arc<TaylorSpace>,
    /// M_m(s, c) with the armature \[kg m²\], n x n, row by row.
    pub mass_matrix: Vec<TaylorPolynomial<C>>,
    /// g(c, s) \[N m\], n entries.
    pub gravity: Vec<TaylorPolynomial<C>>,
}

impl Robot {
    /// Returns M and g as polynomials.
    ///
    /// # Errors
    ///
    /// Returns an error if the robot has 13 joints or more, for which a monomial does not fit.
    ///
    /// # Examples
    ///
    /// ```
    /// use reachtube_robot::Robot;
    ///
    /// let dynamics = Robot::lwa4p().polynomial_dynamics::<f64>()?;
    /// let coriolis = dynamics.christoffel();
    /// assert_eq!(coriolis.iter().flatten().map(|c| c.degree()).max(), Some(10));
    /// # Ok::<(), reachtube_scalar::TaylorSpaceError>(())
    /// ```
    pub fn polynomial_dynamics<C: Scalar>(
        &self,
    ) -> Result<PolynomialDynamics<C>, TaylorSpaceError> {
        let n = self.joint_count();
        // Each revolute joint rotates second moments once, with two factors, and forces once. A
        // prismatic joint shifts them with two factors q. No product has more than two factors of
        // one joint, so 2 n bounds the degree.
        let space = TaylorSpace::new(2 * n, 2 * n as u32)?;
        let variable = |i| TaylorPolynomial::variable(&space, i);
        let (sin, cos): (Vec<_>, Vec<_>) = (0..n).map(|i| (variable(i), variable(n + i))).unzip();
        let mut workspace = Workspace::new(self);
        let mut mass_matrix = vec![TaylorPolynomial::from(0.0); n * n];
        self.crba(&sin, &cos, &mut workspace, &mut mass_matrix);
        let mut gravity = vec![TaylorPolynomial::from(0.0); n];
        self.gravity(&sin, &cos, &mut workspace, &mut gravity);
        Ok(PolynomialDynamics { kinds: self.kinds(), space, mass_matrix, gravity })
    }
}

impl<C: Scalar> PolynomialDynamics<C> {
    /// Returns the matrices C_1..C_n of (12) \[kg m²\], each n x n, row by row, for which
    /// c_i(q, q̇) = q̇ᵀ C_i(q) q̇.
    ///
    /// Their entries are c_ijk = ∂M_ij/∂q_k - ½ ∂M_jk/∂q_i, with ∂/∂q_k = c_k ∂/∂s_k - s_k ∂/∂c_k
    /// for a revolute joint k.
    pub fn christoffel(&self) -> Vec<Vec<TaylorPolynomial<C>>> {
        let n = self.gravity.len();
        let derivatives: Vec<Vec<_>> = (0..n)
            .map(|k| self.mass_matrix.iter().map(|m| self.derivative(m, k)).collect())
            .collect();
        let half = C::from(0.5);
        let symbol = |i: usize, j: usize, k: usize| {
            &derivatives[k][i * n + j] - &derivatives[i][j * n + k].scaled(&half)
        };
        let matrix = |i: usize| (0..n * n).map(|jk| symbol(i, jk / n, jk % n)).collect();
        (0..n).map(matrix).collect()
    }

    fn derivative(&self, f: &TaylorPolynomial<C>, k: usize) -> TaylorPolynomial<C> {
        if self.kinds[k] == JointKind::Prismatic {
            return f.derivative(k);
        }
        let n = self.gravity.len();
        let variable = |i| TaylorPolynomial::variable(&self.space, i);
        &(&variable(n + k) * &f.derivative(k)) - &(&variable(k) * &f.derivative(n + k))
    }
}
