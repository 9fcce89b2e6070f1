//! Construction of models 1, 2 and 3.

use std::sync::Arc;

use nalgebra::DMatrix;
use reachtube_robot::{PolynomialDynamics, Robot, ltdl};
use reachtube_scalar::{TaylorPolynomial, TaylorSpace};

use super::layout::Layout;
use super::{ExpansionPoint, ModelKind, PolynomialModel};
use crate::error::{Error, Result};

impl PolynomialModel {
    /// Model `kind` of order p ≥ 1 about `point`: (13), (14) or (16), in double precision, whose
    /// rounding is part of what the model is.
    ///
    /// Model 1 is M_m⁻¹(q_a)(u - T^p τ_v(q̇)). Model 2 takes off the Coriolis terms (15), q̇ᵀ
    /// T^{p-2} C_i(s, c) q̇, which is exact where p - 2 is their degree or more; it then is kept in
    /// powers of s and c themselves. Model 3 is the Taylor polynomial of M_m⁻¹(s, c)(u - c(q̇, s,
    /// c) - τ_v(q̇)) in all of (q̇, s, c, u), with M_m and c in the extension of
    /// [`PolynomialDynamics`]; only M_m⁻¹ is a series, in the angles that M_m depends on, and what
    /// multiplies it is an exact polynomial.
    ///
    /// # Errors
    ///
    /// [`Error::Setting`] for order 0 and where M_m(q_a) is not positive definite, [`Error::Space`]
    /// where polynomials of that order do not fit.
    pub fn new(robot: &Robot, kind: ModelKind, order: u32, point: &ExpansionPoint) -> Result<Self> {
        if order == 0 {
            return Err(Error::Setting("order 0: a model has order 1 at least".into()));
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

/// M_m⁻¹(q_a).
fn inverse_mass_matrix(robot: &Robot, point: &ExpansionPoint) -> Result<DMatrix<f64>> {
    let n = robot.joint_count();
    let mut factors = robot.mass_matrix(&point.q).as_slice().to_vec();
    ltdl::factor(&mut factors, n);
    if (0..n).any(|i| !(factors[i * n + i] > 0.0 && factors[i * n + i].is_finite())) {
        return Err(Error::Setting(format!(
            "the mass matrix of {} is not positive definite at the expansion point q = {:?} rad; it is no physical robot there, choose another point",
            robot.name(),
            point.q
        )));
    }
    let mut inverse = DMatrix::identity(n, n);
    inverse.column_iter_mut().for_each(|mut column| ltdl::solve(&factors, column.as_mut_slice()));
    Ok(inverse)
}

/// Memory that the terms of a model may take, in bytes.
const MOST_BYTES: f64 = 2e9;
/// A term with its copies while products are formed.
const BYTES_OF_TERM: f64 = 128.0;

/// More terms than model 3 has: it is affine in u and cubic in q̇, each such factor times a series
/// of `angles` variables.
fn most_terms(joints: usize, angles: usize, order: u32) -> f64 {
    let n = joints as f64;
    // Monomials of degree up to d.
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

/// A matrix of numbers times a vector of polynomials.
fn times(matrix: &DMatrix<f64>, vector: &[TaylorPolynomial]) -> Polynomials {
    let row = |i: usize| {
        let terms = vector.iter().enumerate().map(|(j, x)| x.scaled(&matrix[(i, j)]));
        terms.fold(TaylorPolynomial::from(0.0), |sum, term| sum + term)
    };
    (0..matrix.nrows()).map(row).collect()
}

struct Builder<'a> {
    robot: &'a Robot,
    order: u32,
    point: &'a ExpansionPoint,
    layout: Layout,
    space: Arc<TaylorSpace>,
}

impl Builder<'_> {
    fn variable(&self, place: usize) -> TaylorPolynomial {
        TaylorPolynomial::variable(&self.space, place)
    }

    /// u - T^p τ_v(q̇), in q̇ and u themselves.
    fn viscous_load(&self) -> Polynomials {
        let joints = self.robot.joints().iter().enumerate();
        joints.map(|(i, _)| self.variable(self.layout.input(i)) - self.viscous(i)).collect()
    }

    /// T^p of τ_v of joint i about q̇_a, in powers of q̇.
    fn viscous(&self, i: usize) -> TaylorPolynomial {
        let line = TaylorSpace::new(1, self.order)
            .expect("one variable to an order that more variables have");
        let velocity = TaylorPolynomial::variable_at(&line, 0, self.point.qd[i]);
        let torque = self.robot.joints()[i].friction.viscous.torque(&velocity);
        torque.shifted(&[-self.point.qd[i]]).embedded(&self.space, &[self.layout.velocity(i)])
    }

    /// Where sin q and cos q are in the model's variables.
    fn trigonometric_places(&self) -> Vec<usize> {
        let n = self.layout.joints;
        (0..n).map(|i| self.layout.sine(i)).chain((0..n).map(|i| self.layout.cosine(i))).collect()
    }

    /// (sin q_a, cos q_a), exact at multiples of pi/2.
    fn trigonometric_point(&self) -> Vec<f64> {
        let (sin, cos): (Vec<_>, Vec<_>) =
            self.point.q.iter().map(|q| reachtube_robot::snapped_sin_cos(*q)).unzip();
        [sin, cos].concat()
    }

    fn dynamics(&self) -> Result<PolynomialDynamics> {
        Ok(self.robot.polynomial_dynamics()?)
    }

    fn model2(&self, inverse: &DMatrix<f64>) -> Result<(Polynomials, Vec<f64>)> {
        let mut origin = vec![0.0; self.layout.variables()];
        let mut load = self.viscous_load();
        if self.order >= 2 {
            let mut christoffel = self.dynamics()?.christoffel();
            let degree =
                christoffel.iter().flatten().map(TaylorPolynomial::degree).max().unwrap_or(0);
            if self.order - 2 < degree {
                let at = self.trigonometric_point();
                christoffel
                    .iter_mut()
                    .flatten()
                    .for_each(|c| *c = c.shifted(&at).truncated(self.order - 2));
                for (place, at) in self.trigonometric_places().into_iter().zip(at) {
                    origin[place] = at;
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

    /// q̇ᵀ C q̇ for a matrix of polynomials in (s, c).
    fn coriolis(
        &self,
        matrix: &[TaylorPolynomial],
        velocity: &[TaylorPolynomial],
    ) -> TaylorPolynomial {
        let n = self.layout.joints;
        let places = self.trigonometric_places();
        let mut sum = TaylorPolynomial::from(0.0);
        for j in 0..n {
            for k in 0..=j {
                let own = &matrix[j * n + k];
                let both = if j == k { own.clone() } else { own + &matrix[k * n + j] };
                sum += &both.embedded(&self.space, &places) * &(&velocity[j] * &velocity[k]);
            }
        }
        sum
    }

    fn model3(&self) -> Result<(Polynomials, Vec<f64>)> {
        let n = self.layout.joints;
        let dynamics = self.dynamics()?;
        let at = self.trigonometric_point();
        let inverse = self.inverse_series(&dynamics, &at)?;
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

    /// Refuses an order whose terms would not fit in memory; M_m depends on `angles` sines and
    /// cosines.
    fn check_size(&self, angles: usize) -> Result<()> {
        let bytes = |order: u32| most_terms(self.layout.joints, angles, order) * BYTES_OF_TERM;
        let needed = bytes(self.order);
        if needed <= MOST_BYTES {
            return Ok(());
        }
        let fits = (1..self.order).rev().find(|order| bytes(*order) <= MOST_BYTES).unwrap_or(1);
        Err(Error::Setting(format!(
            "model 3 of order {} for {} joints would need about {:.0} GB for its terms, more than the {:.0} GB allowed; order {fits} fits",
            self.order,
            self.layout.joints,
            needed / 1e9,
            MOST_BYTES / 1e9
        )))
    }

    /// The series of M_m⁻¹ about (s_a, c_a), n x n, made in the space of the variables that M_m
    /// depends on.
    fn inverse_series(&self, dynamics: &PolynomialDynamics, at: &[f64]) -> Result<Polynomials> {
        let n = self.layout.joints;
        let used: Vec<usize> =
            (0..2 * n).filter(|i| dynamics.mass_matrix.iter().any(|m| m.depends_on(*i))).collect();
        self.check_size(used.len())?;
        let space = TaylorSpace::new(used.len().max(1), self.order)?;
        space.check_dense()?;
        let place = |i: usize| used.iter().position(|u| *u == i).unwrap_or(0);
        let places: Vec<usize> = (0..2 * n).map(place).collect();
        let mut factors: Polynomials =
            dynamics.mass_matrix.iter().map(|m| m.shifted(at).embedded(&space, &places)).collect();
        ltdl::factor(&mut factors, n);
        let trigonometric = self.trigonometric_places();
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
