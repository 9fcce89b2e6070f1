//! The equations of motion over a box of positions, as polynomials in velocities and inputs.

use std::sync::Arc;

use reachtube_robot::{Robot, Workspace};
use reachtube_scalar::{
    Interval, TaylorBox, TaylorModel, TaylorPolynomial, TaylorSpace, TaylorTerm,
};

use crate::error::Result;
use crate::operating_box::OperatingBox;
use crate::polynomial_model::{ModelWorkspace, PolynomialModel};

/// A polynomial in the normalised (q̇, u), whose coefficients are Taylor models in q.
///
/// The equations of motion are polynomials in (q̇, u) of degree 3 at most, so nothing is truncated
/// there, and (q̇, u) need not be cut.
pub(crate) type InputPolynomial = TaylorPolynomial<TaylorModel>;

/// The equations of motion of a robot and of a model, over any positions and one box of (q̇, u).
pub(crate) struct Equations<'a> {
    model: &'a PolynomialModel,
    robot: &'a Robot,
    /// q̇ and u over the box, n of each, in the normalised (q̇, u).
    velocities: Vec<InputPolynomial>,
    inputs: Vec<InputPolynomial>,
    /// The space of the positions that M_m depends on.
    positions: Arc<TaylorSpace>,
    /// The space of these positions and (q̇, u) together.
    all: Arc<TaylorSpace>,
}

/// Scratch memory of one thread.
pub(crate) struct EquationsWorkspace {
    mass: Workspace<TaylorModel>,
    coriolis: Workspace<InputPolynomial>,
    rate: ModelWorkspace<InputPolynomial>,
}

/// sin q and cos q over a box of positions, n of each.
pub(crate) struct SinesCosines {
    sin: Vec<TaylorModel>,
    cos: Vec<TaylorModel>,
}

impl<'a> Equations<'a> {
    /// Prepares the equations for Taylor models of `order` in q.
    pub(crate) fn new(
        model: &'a PolynomialModel,
        robot: &'a Robot,
        operating_box: &OperatingBox,
        order: u32,
    ) -> Result<Self> {
        let n = robot.joint_count();
        let degree = input_degree(model).max(3);
        let space = TaylorSpace::new(2 * n, degree)?;
        let sides = operating_box.sides();
        let variable = |i: usize| {
            let side = sides[n + i];
            let (mid, rad) = (TaylorModel::from(side.mid()), TaylorModel::from(side.rad()));
            InputPolynomial::constant(mid) + InputPolynomial::variable(&space, i).scaled(&rad)
        };
        let count = position_variables(n).len();
        Ok(Self {
            model,
            robot,
            velocities: (0..n).map(variable).collect(),
            inputs: (n..2 * n).map(variable).collect(),
            positions: TaylorSpace::new(count, order)?,
            all: TaylorSpace::new(count + 2 * n, order + degree)?,
        })
    }

    pub(crate) fn scratch(&self) -> EquationsWorkspace {
        EquationsWorkspace {
            mass: Workspace::new(self.robot),
            coriolis: Workspace::new(self.robot),
            rate: self.model.workspace(),
        }
    }

    /// Returns the space of the positions that M_m depends on.
    pub(crate) fn positions(&self) -> &Arc<TaylorSpace> {
        &self.positions
    }

    /// Returns sin q and cos q over a box of positions, n sides.
    pub(crate) fn angles(&self, q: &[Interval]) -> SinesCosines {
        let variables = position_variables(q.len());
        let sides: Vec<Interval> = variables.clone().map(|i| q[i]).collect();
        let mut models: Vec<TaylorModel> = q.iter().map(|side| TaylorModel::from(*side)).collect();
        let positions = TaylorBox::new(&self.positions, &sides).variables();
        models.splice(variables, positions);
        let (sin, cos) = self.robot.sin_cos(&models);
        SinesCosines { sin, cos }
    }

    /// Returns M_m, row-major n x n.
    pub(crate) fn mass_matrix(
        &self,
        angles: &SinesCosines,
        scratch: &mut EquationsWorkspace,
    ) -> Vec<TaylorModel> {
        let n = self.robot.joint_count();
        let mut mass = vec![TaylorModel::from(0.0); n * n];
        self.robot.crba(&angles.sin, &angles.cos, &mut scratch.mass, &mut mass);
        mass
    }

    /// Returns u - c - τ_v, n: M_m times the acceleration of the robot.
    pub(crate) fn load(
        &self,
        angles: &SinesCosines,
        scratch: &mut EquationsWorkspace,
    ) -> Vec<InputPolynomial> {
        let n = self.robot.joint_count();
        let mut coriolis = vec![InputPolynomial::from(0.0); n];
        let [sin, cos] = [&angles.sin, &angles.cos].map(|models| constants(models));
        self.robot.coriolis(&sin, &cos, &self.velocities, &mut scratch.coriolis, &mut coriolis);
        let entry = |i: usize| {
            let friction = self.robot.joints()[i].friction.viscous.torque(&self.velocities[i]);
            &(&self.inputs[i] - &coriolis[i]) - &friction
        };
        (0..n).map(entry).collect()
    }

    /// Returns f_p, n: the acceleration of the model.
    pub(crate) fn acceleration(
        &self,
        angles: &SinesCosines,
        scratch: &mut EquationsWorkspace,
    ) -> Vec<InputPolynomial> {
        let n = self.robot.joint_count();
        // The accelerations depend on q by its sines and cosines only.
        let mut state = vec![InputPolynomial::from(0.0); n];
        state.extend_from_slice(&self.velocities);
        if self.model.layout().trigonometric {
            state.extend(
                [&angles.sin, &angles.cos].into_iter().flat_map(|models| constants(models)),
            );
        }
        let mut rate = vec![InputPolynomial::from(0.0); state.len()];
        self.model.rate_into(&state, &self.inputs, &mut scratch.rate, &mut rate);
        rate[n..2 * n].to_vec()
    }

    /// Returns one Taylor model in the positions and (q̇, u). Its terms with the smallest
    /// coefficients, up to a sum of `slack`, go into the remainder.
    pub(crate) fn joined(&self, polynomial: &InputPolynomial, slack: f64) -> TaylorModel {
        let terms = polynomial.terms();
        let (k, slack) = (self.positions.variables(), slack / terms.len().max(1) as f64);
        let indices: Vec<usize> = (0..k).collect();
        let (mut sum, mut remainder) = (TaylorPolynomial::from(0.0), Interval::ZERO);
        for TaylorTerm { exponents, coefficient } in terms {
            let coefficient = coefficient.without_small_terms(slack);
            let is_square = exponents.iter().all(|e| e % 2 == 0);
            let values = if is_square { Interval::ZERO } else { Interval::point(-1.0) };
            remainder += coefficient.remainder() * values.hull(Interval::ONE);
            let exponents = [vec![0; k], exponents].concat();
            let monomial = TaylorPolynomial::from_terms(
                &self.all,
                [TaylorTerm { exponents, coefficient: 1.0 }],
            );
            sum += &coefficient.polynomial().embedded(&self.all, &indices) * &monomial;
        }
        TaylorModel::from(sum) + TaylorModel::from(remainder)
    }
}

/// Returns the joints whose position is a variable: the mass matrix of a serial chain does not
/// depend on the position of the first joint. Any dependence is covered by remainders.
pub(crate) fn position_variables(joints: usize) -> std::ops::Range<usize> {
    if joints > 1 { 1..joints } else { 0..joints }
}

/// Returns polynomials that do not depend on (q̇, u).
fn constants(models: &[TaylorModel]) -> Vec<InputPolynomial> {
    models.iter().cloned().map(InputPolynomial::constant).collect()
}

/// Returns the highest degree of a term of the accelerations in (q̇, u).
fn input_degree(model: &PolynomialModel) -> u32 {
    let layout = model.layout();
    let degree = |exponents: &[u8]| -> u32 {
        (0..layout.joints)
            .flat_map(|i| [layout.velocity(i), layout.input(i)])
            .map(|z| u32::from(exponents[z]))
            .sum()
    };
    let terms = model.acceleration().iter().flat_map(|f| f.terms());
    terms.filter(|t| !t.exponents.is_empty()).map(|t| degree(&t.exponents)).max().unwrap_or(0)
}
