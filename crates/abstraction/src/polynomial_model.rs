//! The polynomial models ẋ = f_p(x, u).

use nalgebra::{DMatrix, DVector};
use reachtube_reach::{LinearSystem, PolynomialSystem};
use reachtube_robot::{Robot, RobotDescription};
use reachtube_scalar::{
    Interval, MapWorkspace, PolynomialMap, Powers, TaylorPolynomial, TaylorSpace,
};
use serde::{Deserialize, Serialize};

use super::layout::Layout;
use super::{ExpansionPoint, Remainder};
use crate::error::{Error, Result};

/// Which of the paper's models (Sec. IV-B).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(try_from = "u32", into = "u32")]
pub enum ModelKind {
    /// (13): constant mass matrix, viscous friction, no Coriolis terms.
    One,
    /// (14), (15): constant mass matrix, viscous friction, Coriolis terms in sin q and cos q.
    Two,
    /// (16): the Taylor polynomial of the forward dynamics in (q̇, sin q, cos q, u).
    Three,
}

/// Which abstraction of the forward dynamics a model is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Abstraction {
    /// 1, 2 or 3 of the paper.
    pub model: ModelKind,
    /// The order p.
    pub order: u32,
}

impl Default for Abstraction {
    /// Model 1 of order 1: linear.
    fn default() -> Self {
        Self { model: ModelKind::One, order: 1 }
    }
}

impl From<ModelKind> for u32 {
    fn from(kind: ModelKind) -> u32 {
        kind as u32 + 1
    }
}

impl TryFrom<u32> for ModelKind {
    type Error = String;
    fn try_from(number: u32) -> Result<Self, String> {
        match number {
            1 => Ok(Self::One),
            2 => Ok(Self::Two),
            3 => Ok(Self::Three),
            _ => Err(format!("there is no model {number}; give 1, 2 or 3")),
        }
    }
}

/// An abstraction of the forward dynamics (10): ẋ = f_p(x, u), polynomial in x and u. SI units.
///
/// States are (q, q̇) for model 1 and (q, q̇, sin q, cos q) for models 2 and 3, n of each, with
/// d/dt sin q = q̇ cos q and d/dt cos q = -q̇ sin q. The accelerations are polynomials in (q̇, u)
/// or (q̇, sin q, cos q, u).
///
/// # Examples
///
/// ```
/// use reachtube_abstraction::{ExpansionPoint, ModelKind, PolynomialModel};
/// use reachtube_robot::Robot;
///
/// let robot = Robot::lwa4p();
/// let model = PolynomialModel::new(&robot, ModelKind::Two, 12, &ExpansionPoint::zero(6))?;
/// let x = model.state(&[0.3; 6], &[0.5; 6]);
/// let rate = model.rate(&x, &[1.0; 6]);
/// assert_eq!((model.states(), rate[0]), (24, 0.5));
/// # Ok::<(), reachtube_abstraction::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct PolynomialModel {
    kind: ModelKind,
    order: u32,
    point: ExpansionPoint,
    layout: Layout,
    /// The polynomials' variables are offsets from here, one value a variable.
    origin: Vec<f64>,
    acceleration: Vec<TaylorPolynomial>,
    map: PolynomialMap,
    robot: RobotDescription,
    pub(super) remainder: Option<Remainder>,
}

/// Scratch memory for evaluations of one model over T.
#[derive(Debug, Clone)]
pub struct ModelWorkspace<T> {
    offsets: Vec<T>,
    map: MapWorkspace<T>,
}

impl PolynomialModel {
    pub(super) fn assemble(
        robot: &Robot,
        kind: ModelKind,
        order: u32,
        point: ExpansionPoint,
        origin: Vec<f64>,
        acceleration: Vec<TaylorPolynomial>,
    ) -> Self {
        let layout = Layout::new(kind, robot.joint_count());
        let map = PolynomialMap::new(layout.variables(), &acceleration);
        let robot = robot.description().clone();
        Self { kind, order, point, layout, origin, acceleration, map, robot, remainder: None }
    }

    /// Which model it is.
    pub fn kind(&self) -> ModelKind {
        self.kind
    }

    /// The order p.
    pub fn order(&self) -> u32 {
        self.order
    }

    /// The expansion point.
    pub fn expansion_point(&self) -> &ExpansionPoint {
        &self.point
    }

    /// Number of joints n.
    pub fn joints(&self) -> usize {
        self.layout.joints
    }

    /// Number of states: 2n or 4n.
    pub fn states(&self) -> usize {
        self.layout.states()
    }

    /// The variables of the polynomials.
    pub fn layout(&self) -> Layout {
        self.layout
    }

    /// What the polynomials' variables are offsets from, one value a variable: zero, or where they
    /// are truncated the expansion point.
    pub fn origin(&self) -> &[f64] {
        &self.origin
    }

    /// The acceleration of each joint \[rad/s²\], a polynomial in offsets of the variables from
    /// [`origin`](Self::origin).
    pub fn acceleration(&self) -> &[TaylorPolynomial] {
        &self.acceleration
    }

    /// The highest degree of a term.
    pub fn degree(&self) -> u32 {
        self.acceleration.iter().map(TaylorPolynomial::degree).max().unwrap_or(0)
    }

    /// Number of terms of all accelerations together.
    pub fn term_count(&self) -> usize {
        self.acceleration.iter().map(TaylorPolynomial::term_count).sum()
    }

    /// The robot it was made from.
    pub fn robot(&self) -> &RobotDescription {
        &self.robot
    }

    /// The bound of what the model leaves out of the forward dynamics, where one was computed.
    pub fn remainder(&self) -> Option<&Remainder> {
        self.remainder.as_ref()
    }

    /// The state of the model at positions q (rad) and velocities q̇ (rad/s).
    pub fn state(&self, q: &[f64], qd: &[f64]) -> Vec<f64> {
        let mut x = [q, qd].concat();
        if self.layout.trigonometric {
            x.extend(q.iter().map(|q| q.sin()));
            x.extend(q.iter().map(|q| q.cos()));
        }
        x
    }

    /// Scratch memory for [`rate_into`](Self::rate_into).
    pub fn workspace<T: Powers>(&self) -> ModelWorkspace<T> {
        ModelWorkspace {
            offsets: vec![T::zero(); self.layout.variables()],
            map: self.map.workspace(),
        }
    }

    /// ẋ = f_p(x, u) into `rate`; `x` and `rate` have [`states`](Self::states) entries, `u` n.
    /// Allocates nothing.
    ///
    /// # Guarantee
    ///
    /// Over `Interval`: an outer enclosure of the range over the box.
    ///
    /// # Panics
    ///
    /// Where a slice has another length.
    pub fn rate_into<T: Powers>(
        &self,
        x: &[T],
        u: &[T],
        ws: &mut ModelWorkspace<T>,
        rate: &mut [T],
    ) {
        let n = self.layout.joints;
        assert_eq!(
            (x.len(), u.len(), rate.len()),
            (self.states(), n, self.states()),
            "states and inputs of the model"
        );
        let variables = x[n..].iter().chain(u);
        for ((offset, value), origin) in ws.offsets.iter_mut().zip(variables).zip(&self.origin) {
            *offset = if *origin == 0.0 { value.clone() } else { value.clone() - T::from(*origin) };
        }
        let (q, rest) = rate.split_at_mut(n);
        q.clone_from_slice(&x[n..2 * n]);
        self.map.evaluate_into(&ws.offsets, &mut ws.map, &mut rest[..n]);
        if self.layout.trigonometric {
            for i in 0..n {
                rest[n + i] = x[n + i].clone() * x[3 * n + i].clone();
                rest[2 * n + i] = -x[n + i].clone() * x[2 * n + i].clone();
            }
        }
    }

    /// ẋ = f_p(x, u), as [`rate_into`](Self::rate_into).
    pub fn rate<T: Powers>(&self, x: &[T], u: &[T]) -> Vec<T> {
        let mut rate = vec![T::zero(); self.states()];
        self.rate_into(x, u, &mut self.workspace(), &mut rate);
        rate
    }

    /// ∂q̈/∂z, a polynomial for each joint and each variable z of the [`layout`](Self::layout), row
    /// by row.
    pub fn derivatives(&self) -> Vec<Vec<TaylorPolynomial>> {
        let row =
            |f: &TaylorPolynomial| (0..self.layout.variables()).map(|z| f.derivative(z)).collect();
        self.acceleration.iter().map(row).collect()
    }

    /// The model as ẋ = A x + B u + d with x = (q, q̇), where its first two rows are that: model 1
    /// at order 1 or 2 without an even friction term, and models 2 and 3 at order 1 about q̇_a = 0,
    /// u_a = 0.
    ///
    /// # Errors
    ///
    /// [`Error::Setting`] where the model is not linear in (q̇, u).
    pub fn linear_system(&self) -> Result<LinearSystem> {
        let n = self.layout.joints;
        let (mut a, mut b) = (DMatrix::zeros(2 * n, 2 * n), DMatrix::zeros(2 * n, n));
        let mut drift = DVector::zeros(2 * n);
        a.view_mut((0, n), (n, n)).fill_with_identity();
        let place = |z: usize| self.layout.names()[z].clone();
        for (i, f) in self.acceleration.iter().enumerate() {
            for term in f.terms() {
                let factors: Vec<usize> =
                    (0..term.exponents.len()).filter(|z| term.exponents[*z] > 0).collect();
                match factors[..] {
                    [] => drift[n + i] += term.coefficient,
                    [z] if term.exponents[z] == 1 && z < n => a[(n + i, n + z)] = term.coefficient,
                    [z] if term.exponents[z] == 1 && z >= self.layout.input(0) => {
                        b[(n + i, z - self.layout.input(0))] = term.coefficient;
                    }
                    _ => {
                        let names: Vec<String> = factors.iter().map(|z| place(*z)).collect();
                        return Err(self.not_linear(i, &names));
                    }
                }
            }
            let offset: f64 = (0..n)
                .map(|j| {
                    a[(n + i, n + j)] * self.origin[j]
                        + b[(n + i, j)] * self.origin[self.layout.input(j)]
                })
                .sum();
            drift[n + i] -= offset;
        }
        Ok(LinearSystem::new(a, b, drift)?)
    }

    /// The model as a system whose reachable sets [`Flowpipe`](reachtube_reach::Flowpipe) encloses:
    /// the 2n states (q, q̇) for every model, in which models 2 and 3 are polynomials of sines and
    /// cosines too; n inputs.
    ///
    /// # Guarantee
    ///
    /// Outer: where polynomials in offsets are written in the variables themselves, each
    /// coefficient encloses the exact one.
    ///
    /// # Errors
    ///
    /// [`Error::Space`] where states, inputs and order together do not fit.
    pub fn polynomial_system(&self) -> Result<PolynomialSystem> {
        let (n, layout) = (self.layout.joints, self.layout);
        // The model's variables but its inputs come after q, the inputs after q̇.
        let place = |z: usize| match z {
            z if z < n => n + z,
            z if z >= layout.input(0) => 2 * n + z - layout.input(0),
            z => 2 * n + z,
        };
        let places: Vec<usize> = (0..layout.variables()).map(place).collect();
        let space = TaylorSpace::new(n + layout.variables(), self.degree().max(1))?;
        let offset: Vec<Interval> =
            self.origin.iter().map(|origin| Interval::point(-origin)).collect();
        let about_zero =
            |f: &TaylorPolynomial| f.map_coefficients(|c| Interval::point(*c)).shifted(&offset);
        let velocities = (0..n).map(|i| TaylorPolynomial::variable(&space, n + i));
        let accelerations =
            self.acceleration.iter().map(|f| about_zero(f).embedded(&space, &places));
        let components: Vec<_> = velocities.chain(accelerations).collect();
        let angles: Vec<usize> = (0..if layout.trigonometric { n } else { 0 }).collect();
        Ok(PolynomialSystem::trigonometric(2 * n, n, &angles, &components)?)
    }

    fn not_linear(&self, joint: usize, names: &[String]) -> Error {
        Error::Setting(format!(
            "model {} of order {} is not linear: the acceleration of joint {} has a term in {}; use order 1, whose sets are found by a linear program",
            u32::from(self.kind),
            self.order,
            joint + 1,
            names.join(", ")
        ))
    }
}
