//! Construction of models 1, 2 and 3 from a robot.

use std::sync::Arc;

use nalgebra::DMatrix;
use reachtube_robot::{Joint, JointKind, PolynomialDynamics, Robot, ltdl, snapped_sin_cos};
use reachtube_scalar::{TaylorPolynomial, TaylorSpace};

use crate::error::{Error, Result};
use crate::expansion_point::ExpansionPoint;
use crate::layout::Layout;
use crate::model_kind::ModelKind;
use crate::polynomial_model::PolynomialModel;

impl PolynomialModel {
    /// Builds model `kind` of order p ≥ 1 about `point`: (13), (14) or (16). Its coefficients are
    /// computed in double precision; their rounding is part of the model.
    ///
    /// - Model 1 is M_m⁻¹(q_a)(u - T^p τ_v(q̇)).
    /// - Model 2 also subtracts the Coriolis terms (15), q̇ᵀ T^{p-2} C_i(s, c) q̇, from u. They are
    ///   exact where p - 2 is at least their degree, and then stay in powers of s and c.
    /// - Model 3 is the Taylor polynomial of M_m⁻¹(s, c)(u - c(q̇, s, c) - τ_v(q̇)) in
    ///   (q̇, s, c, u). M_m and c are the polynomials of [`PolynomialDynamics`]. Only M_m⁻¹ is a
    ///   series, in the sines and cosines that M_m depends on; its factor is an exact polynomial.
    ///
    /// # Errors
    ///
    /// - [`Error::OrderZero`] for order 0.
    /// - [`Error::SingularMassMatrix`] if M_m(q_a) is not positive definite.
    /// - [`Error::TooManyTerms`] and [`Error::Space`] if polynomials of this order do not fit.
    pub fn new(robot: &Robot, kind: ModelKind, order: u32, point: &ExpansionPoint) -> Result<Self> {
        if order == 0 {
            return Err(Error::OrderZero);
        }
        let inverse = inverse_mass_matrix(robot, point)?;
        let layout = Layout::new(kind, robot.joint_count());
        let space = TaylorSpace::new(layout.variables(), order)?;
        let builder = Builder { robot, order, point, layout, space };
        let (acceleration, origin) = match kind {
            ModelKind::One => {
                (times(&inverse, &builder.viscous_load()), vec![0.0; layout.variables()])
            }
            ModelKind::Two => builder.model2(&inverse)?,
            ModelKind::Three => builder.model3()?,
        };
        Ok(Self::assemble(robot, kind, order, point.clone(), origin, acceleration))
    }
}

/// Returns M_m⁻¹(q_a), n x n, in double precision.
fn inverse_mass_matrix(robot: &Robot, point: &ExpansionPoint) -> Result<DMatrix<f64>> {
    let n = robot.joint_count();
    let mut factors = robot.mass_matrix(&point.q).as_slice().to_vec();
    ltdl::factor(&mut factors, n);
    if (0..n).any(|i| !(factors[i * n + i] > 0.0 && factors[i * n + i].is_finite())) {
        let unit = JointKind::column(&robot.kinds(), JointKind::position_unit).list();
        let (robot, q) = (robot.name().into(), point.q.clone());
        return Err(Error::SingularMassMatrix { robot, q, unit });
    }
    let mut inverse = DMatrix::identity(n, n);
    inverse.column_iter_mut().for_each(|mut column| ltdl::solve(&factors, column.as_mut_slice()));
    Ok(inverse)
}

/// Memory that the terms of a model may take, bytes.
const MAX_BYTES: f64 = 2e9;
/// Memory of one term with its copies while products are formed, bytes.
const BYTES_PER_TERM: f64 = 128.0;

/// Returns an upper bound of the number of terms of model 3. The model is affine in u and cubic in
/// q̇, and each such factor multiplies a series of `angles` variables.
fn max_terms(joints: usize, angles: usize, order: u32) -> f64 {
    let n = joints as f64;
    // The number of monomials of degree up to d.
    let series = |d: i64| {
        (1..=d.max(-1)).fold(f64::from(d >= 0), |c, i| c * (angles as f64 + i as f64) / i as f64)
    };
    let p = i64::from(order);
    n * (series(p)
        + 2.0 * n * series(p - 1)
        + 0.5 * n * (n + 1.0) * series(p - 2)
        + n * series(p - 3))
}

type Polynomials = Vec<TaylorPolynomial>;

/// Returns a matrix of numbers times a vector of polynomials.
fn times(matrix: &DMatrix<f64>, vector: &[TaylorPolynomial]) -> Polynomials {
    let row = |i: usize| {
        let terms = vector.iter().enumerate().map(|(j, x)| x.scaled(&matrix[(i, j)]));
        terms.fold(TaylorPolynomial::from(0.0), |sum, term| sum + term)
    };
    (0..matrix.nrows()).map(row).collect()
}

/// The data from which a model is built.
struct Builder<'a> {
    robot: &'a Robot,
    order: u32,
    point: &'a ExpansionPoint,
    layout: Layout,
    space: Arc<TaylorSpace>,
}

impl Builder<'_> {
    fn variable(&self, index: usize) -> TaylorPolynomial {
        TaylorPolynomial::variable(&self.space, index)
    }

    /// Returns u - T^p τ_v(q̇), n, in powers of q̇ and u.
    fn viscous_load(&self) -> Polynomials {
        let joints = self.robot.joints().iter().enumerate();
        joints.map(|(i, _)| self.variable(self.layout.input(i)) - self.viscous(i)).collect()
    }

    /// Returns T^p τ_v of joint i about q̇_a, in powers of q̇.
    fn viscous(&self, i: usize) -> TaylorPolynomial {
        let line = TaylorSpace::new(1, self.order)
            .expect("the order fits, because it fits more variables");
        let velocity = TaylorPolynomial::variable_at(&line, 0, self.point.qd[i]);
        let torque = self.robot.joints()[i].friction.viscous.torque(&velocity);
        torque.shifted(&[-self.point.qd[i]]).embedded(&self.space, &[self.layout.velocity(i)])
    }

    /// Returns the indices of sin q and cos q among the model's variables, 2n.
    fn trigonometric_indices(&self) -> Vec<usize> {
        let n = self.layout.joints;
        (0..n).map(|i| self.layout.sine(i)).chain((0..n).map(|i| self.layout.cosine(i))).collect()
    }

    /// Returns (sin q_a, cos q_a), 2n, exact at multiples of π/2, or (q_a, 1) of a prismatic joint.
    fn trigonometric_point(&self) -> Vec<f64> {
        let pair = |(joint, q): (&Joint, &f64)| match joint.kind {
            JointKind::Revolute => snapped_sin_cos(*q),
            JointKind::Prismatic => (*q, 1.0),
        };
        let (sin, cos): (Vec<_>, Vec<_>) =
            self.robot.joints().iter().zip(&self.point.q).map(pair).unzip();
        [sin, cos].concat()
    }

    fn dynamics(&self) -> Result<PolynomialDynamics> {
        Ok(self.robot.polynomial_dynamics()?)
    }

    /// Returns the accelerations of model 2 and the origin of its variables.
    fn model2(&self, inverse: &DMatrix<f64>) -> Result<(Polynomials, Vec<f64>)> {
        let mut origin = vec![0.0; self.layout.variables()];
        let mut load = self.viscous_load();
        if self.order >= 2 {
            let mut christoffel = self.dynamics()?.christoffel();
            let degree =
                christoffel.iter().flatten().map(TaylorPolynomial::degree).max().unwrap_or(0);
            // Truncated Coriolis terms are in offsets of s and c from the expansion point.
            if self.order - 2 < degree {
                let at = self.trigonometric_point();
                christoffel
                    .iter_mut()
                    .flatten()
                    .for_each(|c| *c = c.shifted(&at).truncated(self.order - 2));
                for (index, at) in self.trigonometric_indices().into_iter().zip(at) {
                    origin[index] = at;
                }
            }
            let velocity: Vec<_> =
                (0..self.layout.joints).map(|i| self.variable(self.layout.velocity(i))).collect();
            for (load, matrix) in load.iter_mut().zip(&christoffel) {
                *load -= self.coriolis(matrix, &velocity);
            }
        }
        Ok((times(inverse, &load), origin))
    }

    /// Returns q̇ᵀ C q̇ for `matrix` C, row-major n x n, of polynomials in (s, c).
    fn coriolis(
        &self,
        matrix: &[TaylorPolynomial],
        velocity: &[TaylorPolynomial],
    ) -> TaylorPolynomial {
        let n = self.layout.joints;
        let indices = self.trigonometric_indices();
        let mut sum = TaylorPolynomial::from(0.0);
        for j in 0..n {
            for k in 0..=j {
                let own = &matrix[j * n + k];
                let both = if j == k { own.clone() } else { own + &matrix[k * n + j] };
                sum += &both.embedded(&self.space, &indices) * &(&velocity[j] * &velocity[k]);
            }
        }
        sum
    }

    /// Returns the accelerations of model 3 and the origin of its variables.
    fn model3(&self) -> Result<(Polynomials, Vec<f64>)> {
        // The series of M_m⁻¹ about (s_a, c_a).
        let n = self.layout.joints;
        let dynamics = self.dynamics()?;
        let at = self.trigonometric_point();
        let inverse = self.inverse_series(&dynamics, &at)?;
        // The load u - c - τ_v, a polynomial about the expansion point.
        let christoffel = dynamics.christoffel();
        let about = |c: &TaylorPolynomial| c.shifted(&at).truncated(self.order);
        let velocity: Vec<_> = (0..n)
            .map(|i| {
                TaylorPolynomial::variable_at(
                    &self.space,
                    self.layout.velocity(i),
                    self.point.qd[i],
                )
            })
            .collect();
        let input = self.point.input();
        let load = |i: usize| {
            let input = TaylorPolynomial::variable_at(&self.space, self.layout.input(i), input[i]);
            let matrix: Polynomials = christoffel[i].iter().map(about).collect();
            let friction = self.robot.joints()[i].friction.viscous.torque(&velocity[i]);
            input - self.coriolis(&matrix, &velocity) - friction
        };
        let load: Polynomials = (0..n).map(load).collect();
        // Their product, truncated to the order.
        let row = |i: usize| {
            let terms = (0..n).map(|j| &inverse[i * n + j] * &load[j]);
            terms.fold(TaylorPolynomial::from(0.0), |sum, term| sum + term)
        };
        let mut origin = vec![0.0; self.layout.variables()];
        for i in 0..n {
            origin[self.layout.velocity(i)] = self.point.qd[i];
            origin[self.layout.input(i)] = input[i];
            (origin[self.layout.sine(i)], origin[self.layout.cosine(i)]) = (at[i], at[n + i]);
        }
        Ok(((0..n).map(row).collect(), origin))
    }

    /// Checks that the terms of model 3 fit in memory; M_m depends on `angles` sines and cosines.
    fn check_size(&self, angles: usize) -> Result<()> {
        let (order, joints) = (self.order, self.layout.joints);
        let bytes = |order: u32| max_terms(joints, angles, order) * BYTES_PER_TERM;
        let needed = bytes(order);
        if needed <= MAX_BYTES {
            return Ok(());
        }
        let fitting_order = (1..order).rev().find(|p| bytes(*p) <= MAX_BYTES).unwrap_or(1);
        Err(Error::TooManyTerms { order, joints, needed, limit: MAX_BYTES, fitting_order })
    }

    /// Returns the series of M_m⁻¹ about (s_a, c_a), row-major n x n. It is computed in the space
    /// of only the variables that M_m depends on, which is much smaller.
    fn inverse_series(&self, dynamics: &PolynomialDynamics, at: &[f64]) -> Result<Polynomials> {
        let n = self.layout.joints;
        let used: Vec<usize> =
            (0..2 * n).filter(|i| dynamics.mass_matrix.iter().any(|m| m.depends_on(*i))).collect();
        self.check_size(used.len())?;
        let space = TaylorSpace::new(used.len().max(1), self.order)?;
        space.check_dense()?;
        let index = |i: usize| used.iter().position(|u| *u == i).unwrap_or(0);
        let indices: Vec<usize> = (0..2 * n).map(index).collect();
        let mut factors: Polynomials =
            dynamics.mass_matrix.iter().map(|m| m.shifted(at).embedded(&space, &indices)).collect();
        ltdl::factor(&mut factors, n);
        let trigonometric = self.trigonometric_indices();
        let back: Vec<usize> = used.iter().map(|i| trigonometric[*i]).collect();
        let column = |j: usize| {
            let mut column: Polynomials =
                (0..n).map(|i| TaylorPolynomial::from(f64::from(i == j))).collect();
            ltdl::solve(&factors, &mut column);
            column
        };
        let columns: Vec<Polynomials> = (0..n).map(column).collect();
        let entry = |ij: usize| columns[ij % n][ij / n].embedded(&self.space, &back);
        Ok((0..n * n).map(entry).collect())
    }
}
