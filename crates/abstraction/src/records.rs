use std::sync::Arc;

use reachtube_robot::{JointKind, Robot};
use reachtube_scalar::{TaylorPolynomial, TaylorSpace, TaylorTerm};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::abstraction::Abstraction;
use crate::error::{RecordsError, Result};
use crate::expansion_point::ExpansionPoint;
use crate::layout::Layout;
use crate::polynomial_model::PolynomialModel;

/// Coefficients that are computed twice agree to this fraction of the largest.
const COEFFICIENT_TOLERANCE: f64 = 1e-9;

/// A term in a file: exponents, one per variable, and coefficient.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct TermRecord(pub Vec<u8>, pub f64);

/// The polynomials of a model as a file holds them.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Records {
    /// Names of the variables, in the order of the exponents.
    pub variables: Vec<String>,
    /// The point from which the terms count offsets, one value per variable.
    pub origin: Vec<f64>,
    /// Terms of the acceleration of each joint, rad/s².
    pub acceleration: Vec<Vec<TermRecord>>,
}

/// A model of more possible terms takes minutes to make again, which a file must not request.
const MOST_MONOMIALS: f64 = 1e12;

/// Returns the number of monomials in `variables` variables up to the degree `order`.
fn monomials(variables: usize, order: u32) -> f64 {
    (1..=variables).map(|k| (f64::from(order) + k as f64) / k as f64).product()
}

impl PolynomialModel {
    /// Returns the polynomials as a file holds them.
    #[must_use]
    pub fn records(&self) -> Records {
        let terms = |f: &TaylorPolynomial| {
            f.terms().into_iter().map(|t| TermRecord(t.exponents, t.coefficient)).collect()
        };
        Records {
            variables: self.variable_names(),
            origin: self.origin().to_vec(),
            acceleration: self.acceleration().iter().map(terms).collect(),
        }
    }

    /// Returns the model that a file holds, bit by bit, after a comparison with the model that the
    /// robot gives at the expansion point.
    ///
    /// # Errors
    ///
    /// [`Error::Records`](crate::Error::Records) where the records do not fit the model or differ
    /// from the robot's, and the errors of [`new`](Self::new).
    pub fn from_records(
        robot: &Robot,
        abstraction: Abstraction,
        point: &ExpansionPoint,
        records: Records,
    ) -> Result<Self> {
        let Abstraction { model, order } = abstraction;
        let n = robot.joint_count();
        let layout = Layout::new(model, n);
        records.check_sizes(layout, &robot.kinds())?;
        if point.q.len() != n || point.qd.len() != n || point.input().len() != n {
            return Err(RecordsError::ExpansionPoint { joints: n }.into());
        }
        if monomials(layout.variables(), order) > MOST_MONOMIALS {
            return Err(RecordsError::Order { order, variables: layout.variables() }.into());
        }
        let space = TaylorSpace::new(layout.variables(), order)?;
        let mut acceleration = Vec::with_capacity(n);
        for (joint, terms) in records.acceleration.into_iter().enumerate() {
            acceleration.push(polynomial(&space, joint, terms)?);
        }
        let own = Self::assemble(robot, model, order, point.clone(), records.origin, acceleration);
        let expected = Self::new(robot, model, order, point)?;
        if !own.is_close_to(&expected) {
            return Err(RecordsError::Changed.into());
        }
        Ok(own)
    }

    /// Returns whether all coefficients agree to [`COEFFICIENT_TOLERANCE`] of the largest.
    fn is_close_to(&self, other: &Self) -> bool {
        let largest = |f: &TaylorPolynomial| {
            f.terms().iter().map(|t| t.coefficient.abs()).fold(0.0, f64::max)
        };
        let close = |(a, b): (&TaylorPolynomial, &TaylorPolynomial)| {
            largest(&(a - b)) <= COEFFICIENT_TOLERANCE * largest(b)
        };
        self.origin() == other.origin()
            && self.acceleration().iter().zip(other.acceleration()).all(close)
    }
}

impl Records {
    fn check_sizes(&self, layout: Layout, kinds: &[JointKind]) -> Result<(), RecordsError> {
        let expected = layout.names(kinds);
        if self.variables != expected {
            return Err(RecordsError::Variables { expected });
        }
        let (origin, accelerations) = (self.origin.len(), self.acceleration.len());
        let (variables, joints) = (layout.variables(), layout.joints);
        if origin != variables || accelerations != joints {
            return Err(RecordsError::Size { origin, accelerations, variables, joints });
        }
        Ok(())
    }
}

/// Returns the polynomial with these terms, which belong to `joint` (from 0).
fn polynomial(
    space: &Arc<TaylorSpace>,
    joint: usize,
    terms: Vec<TermRecord>,
) -> Result<TaylorPolynomial, RecordsError> {
    for TermRecord(exponents, coefficient) in &terms {
        let degree: u32 = exponents.iter().map(|e| u32::from(*e)).sum();
        if exponents.len() != space.variables()
            || degree > space.order()
            || !coefficient.is_finite()
        {
            return Err(RecordsError::Term {
                joint: joint + 1,
                exponents: exponents.len(),
                degree,
                coefficient: *coefficient,
                variables: space.variables(),
                order: space.order(),
            });
        }
    }
    let term = |TermRecord(exponents, coefficient)| TaylorTerm { exponents, coefficient };
    Ok(TaylorPolynomial::from_terms(space, terms.into_iter().map(term)))
}
