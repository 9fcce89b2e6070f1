//! M, c and g as exact polynomials in the sines and cosines of the joint angles.

use std::sync::Arc;

use crate::{Robot, Workspace};
use reachtube_scalar::{Scalar, TaylorPolynomial, TaylorSpace, TaylorSpaceError};

/// The dynamics of a robot as polynomials in (s_1..s_n, c_1..c_n), s_i = sin q_i and c_i = cos q_i
/// taken as independent variables (Property A).
///
/// A polynomial on the circle s² + c² = 1 has many extensions off it. Here M is that of the
/// composite-body algorithm ([`Robot::crba`]) and c follows from it by Christoffel symbols (12), of
/// degree 2(n - 1) in (s, c) and so of the paper's p_max = 12 with q̇ for six joints;
/// [`Robot::coriolis`] has another extension, of degree 13 for the LWA 4P.
///
/// # Guarantee
///
/// Nothing is cut off. Over `Interval`, each coefficient encloses the exact one for the robot's
/// constants as loaded.
#[derive(Clone, Debug)]
pub struct PolynomialDynamics<C = f64> {
    /// The space of the 2n variables.
    pub space: Arc<TaylorSpace>,
    /// M_m(s, c) with the armature \[kg m²\], n x n, row by row.
    pub mass_matrix: Vec<TaylorPolynomial<C>>,
    /// g(c, s) \[N m\], n entries.
    pub gravity: Vec<TaylorPolynomial<C>>,
}

impl Robot {
    /// M and g as polynomials.
    ///
    /// # Errors
    ///
    /// When the robot has so many joints (13 or more) that a monomial does not fit.
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
        // Each joint turns second moments once, in two factors, and forces once: no product has
        // more than two of its s and c.
        let space = TaylorSpace::new(2 * n, 2 * n as u32)?;
        let variable = |i| TaylorPolynomial::variable(&space, i);
        let (sin, cos): (Vec<_>, Vec<_>) = (0..n).map(|i| (variable(i), variable(n + i))).unzip();
        let mut workspace = Workspace::new(self);
        let mut mass_matrix = vec![TaylorPolynomial::from(0.0); n * n];
        self.crba(&sin, &cos, &mut workspace, &mut mass_matrix);
        let mut gravity = vec![TaylorPolynomial::from(0.0); n];
        self.gravity(&sin, &cos, &mut workspace, &mut gravity);
        Ok(PolynomialDynamics { space, mass_matrix, gravity })
    }
}

impl<C: Scalar> PolynomialDynamics<C> {
    /// The matrices C_1..C_n of (12), c_i(q, q̇) = q̇ᵀ C_i(q) q̇ \[kg m²\], each n x n, row by row:
    /// c_ijk = ∂M_ij/∂q_k - ½ ∂M_jk/∂q_i, where ∂/∂q_k = c_k ∂/∂s_k - s_k ∂/∂c_k.
    pub fn christoffel(&self) -> Vec<Vec<TaylorPolynomial<C>>> {
        let n = self.gravity.len();
        let slopes: Vec<Vec<_>> =
            (0..n).map(|k| self.mass_matrix.iter().map(|m| self.slope(m, k)).collect()).collect();
        let half = C::from(0.5);
        let symbol = |i: usize, j: usize, k: usize| {
            &slopes[k][i * n + j] - &slopes[i][j * n + k].scaled(&half)
        };
        let matrix = |i: usize| (0..n * n).map(|jk| symbol(i, jk / n, jk % n)).collect();
        (0..n).map(matrix).collect()
    }

    /// ∂f/∂q_k.
    fn slope(&self, f: &TaylorPolynomial<C>, k: usize) -> TaylorPolynomial<C> {
        let n = self.gravity.len();
        let variable = |i| TaylorPolynomial::variable(&self.space, i);
        &(&variable(n + k) * &f.derivative(k)) - &(&variable(k) * &f.derivative(n + k))
    }
}
