use std::sync::OnceLock;

use reachtube_abstraction::{Abstraction, PolynomialModel};
use reachtube_reach::{LinearSystem, PolynomialSystem};
use reachtube_robot::Robot;

use crate::data::settings::{Method, Settings};
use crate::error::Result;

/// A model of the motion, with everything that is derived from it once.
///
/// A linear model ẋ = A x + B u + d has reachable sets whose hull is known up to rounding. For any
/// other model ẋ = f_p(x, u) the sets are enclosed by a [`Flowpipe`](reachtube_reach::Flowpipe).
#[derive(Debug, Clone)]
pub struct Dynamics {
    linear: Option<LinearSystem>,
    polynomials: PolynomialModel,
    /// The polynomials as the flowpipe takes them, made when first asked for.
    system: OnceLock<PolynomialSystem>,
}

impl Dynamics {
    /// Makes the model of `robot` that `settings` ask for. A linear one is treated as a polynomial
    /// for [`Method::Bisection`], which has no program.
    ///
    /// # Errors
    ///
    /// When the robot is not physical at the expansion point, or the order does not fit.
    pub(crate) fn new(robot: &Robot, settings: &Settings) -> Result<Self> {
        let Abstraction { model, order } = settings.abstraction;
        let polynomials = PolynomialModel::new(robot, model, order, &settings.expansion_point)?;
        Ok(Self::of(polynomials, settings.method))
    }

    /// Takes a model; it counts as linear when its polynomials are and `method` solves a program.
    #[must_use]
    pub(crate) fn of(polynomials: PolynomialModel, method: Method) -> Self {
        let linear = match method {
            Method::Program => polynomials.linear_system().ok(),
            Method::Bisection => None,
        };
        Self { linear, polynomials, system: OnceLock::new() }
    }

    /// Takes a model and treats it as one that is not linear, whatever its polynomials are.
    #[must_use]
    pub fn polynomial(polynomials: PolynomialModel) -> Self {
        Self { linear: None, polynomials, system: OnceLock::new() }
    }

    /// Replaces the matrices of a linear model.
    pub(crate) fn with_linear(self, system: LinearSystem) -> Self {
        Self { linear: Some(system), ..self }
    }

    /// Returns A, B and d of a linear model, and `None` for any other.
    #[must_use]
    pub fn linear_system(&self) -> Option<&LinearSystem> {
        self.linear.as_ref()
    }

    /// Returns the polynomials of the model.
    #[must_use]
    pub fn polynomials(&self) -> &PolynomialModel {
        &self.polynomials
    }

    /// Returns the polynomials as the flowpipe takes them.
    ///
    /// # Errors
    ///
    /// When states, inputs and order together do not fit.
    pub(crate) fn polynomial_system(&self) -> Result<&PolynomialSystem> {
        if let Some(system) = self.system.get() {
            return Ok(system);
        }
        let system = self.polynomials.polynomial_system()?;
        Ok(self.system.get_or_init(|| system))
    }
}
