//! Systems with states and inputs, as reachable sets are computed of them.

use std::any::Any;
use std::fmt::Debug;
use std::sync::Arc;

use nalgebra::DMatrix;
use reachtube_ode::VectorField;
use reachtube_scalar::Lanes;

use crate::error::ReachError;
use crate::linear::LinearSystem;
use crate::polynomial::PolynomialSystem;

/// A system ẋ = f(x, u) with N states and m inputs.
#[derive(Debug, Clone)]
pub enum System {
    /// ẋ = A x + B u + d, whose reachable sets have hulls that are known up to rounding.
    Linear(LinearSystem),
    /// Any other system, whose reachable sets a [`Flowpipe`](crate::Flowpipe) encloses.
    Nonlinear(Arc<dyn Nonlinear>),
}

/// A system ẋ = f(x, u) that is not linear, or is not treated as linear.
pub trait Nonlinear: Debug + Send + Sync {
    /// Returns the number of states N.
    fn states(&self) -> usize;

    /// Returns the number of inputs m.
    fn inputs(&self) -> usize;

    /// Returns the coordinates in which the system is simulated, at the state `x` (N). The first N
    /// of them are x.
    fn lift(&self, x: &[f64]) -> Vec<f64>;

    /// Returns the rates of these coordinates.
    fn field(&self) -> Box<dyn VectorField<f64> + '_>;

    /// Returns the rates of these coordinates for several motions at once.
    fn field_of_many(&self) -> Box<dyn VectorField<Lanes<8>> + '_>;

    /// Returns the derivatives of f along motions.
    fn slopes(&self) -> Box<dyn Slopes + '_>;

    /// Returns the system with polynomials that flowpipes are proved with. It is made on first use.
    ///
    /// # Errors
    ///
    /// When states, inputs and order together do not fit.
    fn polynomial_system(&self) -> Result<&PolynomialSystem, ReachError>;

    /// Returns the type that implements it.
    fn any(&self) -> &dyn Any;
}

/// The derivatives A = ∂f/∂x and B = ∂f/∂u of a system, in floating point.
pub trait Slopes {
    /// Returns A (N x N) and B (N x m) at a state (N) and an input (m).
    fn at(&mut self, x: &[f64], u: &[f64]) -> (&DMatrix<f64>, &DMatrix<f64>);

    /// Shows A and B at many pairs of a state and an input to `visit`, one after the other, with
    /// their numbers from 0.
    fn along(
        &mut self,
        points: &[(&[f64], &[f64])],
        visit: &mut dyn FnMut(usize, [&DMatrix<f64>; 2]),
    );
}

impl System {
    /// Returns A, B and d of a linear system, and `None` for any other.
    pub fn linear_system(&self) -> Option<&LinearSystem> {
        match self {
            Self::Linear(system) => Some(system),
            Self::Nonlinear(_) => None,
        }
    }

    /// Returns a system that is not linear, and `None` for a linear one.
    pub fn nonlinear_system(&self) -> Option<&dyn Nonlinear> {
        match self {
            Self::Linear(_) => None,
            Self::Nonlinear(system) => Some(&**system),
        }
    }

    /// Returns the number of states N.
    pub fn states(&self) -> usize {
        match self {
            Self::Linear(system) => system.states(),
            Self::Nonlinear(system) => system.states(),
        }
    }

    /// Returns the number of inputs m.
    pub fn inputs(&self) -> usize {
        match self {
            Self::Linear(system) => system.inputs(),
            Self::Nonlinear(system) => system.inputs(),
        }
    }
}
