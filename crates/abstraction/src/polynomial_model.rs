//! The polynomial models ẋ = f_p(x, u).

use std::sync::OnceLock;

use reachtube_reach::PolynomialSystem;
use reachtube_robot::{JointKind, Robot, RobotDescription};
use reachtube_scalar::{MapWorkspace, PolynomialMap, Powers, TaylorPolynomial};

use crate::expansion_point::ExpansionPoint;
use crate::layout::Layout;
use crate::model_kind::ModelKind;

/// An abstraction of the forward dynamics (10): ẋ = f_p(x, u), polynomial in x and u, in rad, s and
/// N m, or m, s and N for a prismatic joint.
///
/// The states are (q, q̇) for model 1 and (q, q̇, sin q, cos q) for models 2 and 3, n of each, with
/// d/dt sin q = q̇ cos q and d/dt cos q = -q̇ sin q. The accelerations are polynomials in (q̇, u)
/// for model 1 and in (q̇, sin q, cos q, u) for models 2 and 3. A prismatic joint has q and the
/// constant 1 in place of sin q and cos q.
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
    joint_kinds: Vec<JointKind>,
    /// The polynomials' variables are offsets from this point, one value per variable.
    origin: Vec<f64>,
    acceleration: Vec<TaylorPolynomial>,
    map: PolynomialMap,
    robot: RobotDescription,
    /// The polynomials as flowpipes take them, made on first use.
    pub(crate) system: OnceLock<PolynomialSystem>,
}

/// Scratch memory for evaluations of one model over the scalar T.
#[derive(Debug, Clone)]
pub struct ModelWorkspace<T> {
    offsets: Vec<T>,
    map: MapWorkspace<T>,
}

impl PolynomialModel {
    /// Returns the model with these polynomials, n, in offsets from `origin`.
    pub(crate) fn assemble(
        robot: &Robot,
        kind: ModelKind,
        order: u32,
        point: ExpansionPoint,
        origin: Vec<f64>,
        acceleration: Vec<TaylorPolynomial>,
    ) -> Self {
        let layout = Layout::new(kind, robot.joint_count());
        let map = PolynomialMap::new(layout.variables(), &acceleration);
        let (joint_kinds, robot) = (robot.kinds(), robot.description().clone());
        Self {
            kind,
            order,
            point,
            layout,
            joint_kinds,
            origin,
            acceleration,
            map,
            robot,
            system: OnceLock::new(),
        }
    }

    /// Returns which of the paper's models it is.
    #[must_use]
    pub fn kind(&self) -> ModelKind {
        self.kind
    }

    /// Returns the order p.
    #[must_use]
    pub fn order(&self) -> u32 {
        self.order
    }

    /// Returns the expansion point.
    #[must_use]
    pub fn expansion_point(&self) -> &ExpansionPoint {
        &self.point
    }

    /// Returns the number of joints n.
    #[must_use]
    pub fn joints(&self) -> usize {
        self.layout.joints
    }

    /// Returns the number of variables that a simulation integrates: 2n or 4n.
    #[must_use]
    pub fn states(&self) -> usize {
        self.layout.variables()
    }

    /// Returns the variables of the polynomials and their order.
    #[must_use]
    pub fn layout(&self) -> Layout {
        self.layout
    }

    /// Returns the kinds of the joints, n.
    #[must_use]
    pub fn joint_kinds(&self) -> &[JointKind] {
        &self.joint_kinds
    }

    /// Returns the names of the variables, in the order of the [`layout`](Self::layout).
    #[must_use]
    pub fn variable_names(&self) -> Vec<String> {
        self.layout.names(&self.joint_kinds)
    }

    /// Returns the point from which the polynomials' variables count offsets, one value per
    /// variable: the expansion point where the polynomials are truncated, and 0 elsewhere.
    #[must_use]
    pub fn origin(&self) -> &[f64] {
        &self.origin
    }

    /// Returns the accelerations of the joints, n, rad/s² or m/s²: polynomials in offsets of the
    /// variables from [`origin`](Self::origin).
    #[must_use]
    pub fn acceleration(&self) -> &[TaylorPolynomial] {
        &self.acceleration
    }

    /// Returns the highest degree of a term.
    #[must_use]
    pub fn degree(&self) -> u32 {
        self.acceleration.iter().map(TaylorPolynomial::degree).max().unwrap_or(0)
    }

    /// Returns the number of terms of all accelerations together.
    #[must_use]
    pub fn term_count(&self) -> usize {
        self.acceleration.iter().map(TaylorPolynomial::term_count).sum()
    }

    /// Returns the description of the robot that the model was built from.
    #[must_use]
    pub fn robot(&self) -> &RobotDescription {
        &self.robot
    }

    /// Returns the state of the model at positions `q` (n, rad or m) and velocities `qd` (n, rad/s
    /// or m/s).
    #[must_use]
    pub fn state(&self, q: &[f64], qd: &[f64]) -> Vec<f64> {
        let mut x = [q, qd].concat();
        if self.layout.trigonometric {
            let pairs = self.joint_kinds.iter().zip(q).map(|(kind, q)| kind.sin_cos(q));
            let (sin, cos): (Vec<f64>, Vec<f64>) = pairs.unzip();
            x.extend(sin);
            x.extend(cos);
        }
        x
    }

    /// Returns scratch memory for [`rate_into`](Self::rate_into).
    #[must_use]
    pub fn workspace<T: Powers>(&self) -> ModelWorkspace<T> {
        ModelWorkspace {
            offsets: vec![T::zero(); self.layout.variables()],
            map: self.map.workspace(),
        }
    }

    /// Writes ẋ = f_p(x, u) into `rate`. `x` and `rate` have [`states`](Self::states) entries and
    /// `u` has n. Allocates nothing.
    ///
    /// # Guarantee
    ///
    /// Outer over `Interval`, with directed rounding: the result encloses the range of f_p over the
    /// box.
    ///
    /// # Panics
    ///
    /// Panics if a slice has another length.
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
            for (i, kind) in self.joint_kinds.iter().enumerate() {
                let qd = x[n + i].clone();
                (rest[n + i], rest[2 * n + i]) = match kind {
                    JointKind::Revolute => {
                        (qd.clone() * x[3 * n + i].clone(), -qd * x[2 * n + i].clone())
                    }
                    JointKind::Prismatic => (qd, T::zero()),
                };
            }
        }
    }

    /// Returns ẋ = f_p(x, u), with the guarantee of [`rate_into`](Self::rate_into).
    #[must_use]
    pub fn rate<T: Powers>(&self, x: &[T], u: &[T]) -> Vec<T> {
        let mut rate = vec![T::zero(); self.states()];
        self.rate_into(x, u, &mut self.workspace(), &mut rate);
        rate
    }

    /// Returns the derivatives ∂q̈/∂z as polynomials: one row per joint, one column per variable z
    /// of the [`layout`](Self::layout).
    #[must_use]
    pub fn derivatives(&self) -> Vec<Vec<TaylorPolynomial>> {
        let row =
            |f: &TaylorPolynomial| (0..self.layout.variables()).map(|z| f.derivative(z)).collect();
        self.acceleration.iter().map(row).collect()
    }
}
