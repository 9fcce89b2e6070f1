use std::borrow::Cow;

use reachtube_reach::LinearSystem;
use reachtube_robot::Robot;

use super::{Method, Settings};
use crate::error::Result;
use reachtube_abstraction::{Abstraction, PolynomialModel};

/// A model as its reachable sets are computed.
#[derive(Debug, Clone)]
pub enum Dynamics {
    /// ẋ = A x + B u + d, whose hull is known up to rounding.
    Linear(LinearSystem),
    /// ẋ = f_p(x, u), whose reachable sets are enclosed by a
    /// [`Flowpipe`](reachtube_reach::Flowpipe).
    Polynomial(Box<PolynomialModel>),
}

impl Dynamics {
    /// The model of `robot` that `settings` ask for. A linear one is taken as a polynomial for
    /// [`Method::Bisection`], which knows no program.
    ///
    /// # Errors
    ///
    /// Where the robot is not physical at the expansion point, or the order does not fit.
    pub fn new(robot: &Robot, settings: &Settings) -> Result<Self> {
        let Abstraction { model, order } = settings.abstraction;
        Ok(Self::of(
            PolynomialModel::new(robot, model, order, &settings.expansion_point)?,
            settings.method,
        ))
    }

    /// The polynomials of the model; those of a linear one are made of `robot` again.
    ///
    /// # Errors
    ///
    /// As [`new`](Self::new).
    pub fn polynomials(
        &self,
        robot: &Robot,
        settings: &Settings,
    ) -> Result<Cow<'_, PolynomialModel>> {
        let Abstraction { model, order } = settings.abstraction;
        match self {
            Self::Linear(_) => Ok(Cow::Owned(PolynomialModel::new(
                robot,
                model,
                order,
                &settings.expansion_point,
            )?)),
            Self::Polynomial(model) => Ok(Cow::Borrowed(model)),
        }
    }

    /// A model, by the method that its sets are found by.
    pub fn of(model: PolynomialModel, method: Method) -> Self {
        match (model.linear_system(), method) {
            (Ok(system), Method::Program) => Self::Linear(system),
            _ => Self::Polynomial(Box::new(model)),
        }
    }
}
