//! The file of a polynomial model.

use std::path::Path;

use reachtube_robot::{Robot, RobotDescription};
use reachtube_scalar::{TaylorPolynomial, TaylorSpace, TaylorTerm};
use serde::{Deserialize, Serialize};

use super::layout::Layout;
use super::{ExpansionPoint, ModelKind, PolynomialModel, Remainder};
use crate::error::{Error, Result};
use crate::json;

/// What the file says it is.
const FORMAT: &str = "reachtube-abstraction";
/// Version of the format that is written and read.
const VERSION: u32 = 1;
const REMEDY: &str = "give a file that `abstract --out` wrote";

/// Coefficients that are computed twice are the same to this part of the largest.
const SAME: f64 = 1e-9;

/// A model as in its file (docs/abstraction.schema.json).
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct ModelFile {
    format: String,
    version: u32,
    tool: String,
    model: ModelKind,
    order: u32,
    expansion_point: ExpansionPoint,
    /// Names of the variables, in the order of the exponents.
    variables: Vec<String>,
    /// The terms are in offsets of the variables from here.
    origin: Vec<f64>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    remainder: Option<Remainder>,
    robot: RobotDescription,
    /// For each joint, the terms of its acceleration, rad/s².
    acceleration: Vec<Vec<TermRecord>>,
}

/// Exponents, one a variable, and coefficient.
#[derive(Serialize, Deserialize)]
struct TermRecord(Vec<u8>, f64);

impl PolynomialModel {
    /// The model as JSON: a term a line, ending with a newline. Numbers read back are the same bit by bit.
    pub fn to_json(&self) -> String {
        let records = |f: &TaylorPolynomial| {
            f.terms().into_iter().map(|t| TermRecord(t.exponents, t.coefficient)).collect()
        };
        json::to_lines(&ModelFile {
            format: FORMAT.into(),
            version: VERSION,
            tool: crate::TOOL.into(),
            model: self.kind(),
            order: self.order(),
            expansion_point: self.expansion_point().clone(),
            variables: self.layout().names(),
            origin: self.origin().to_vec(),
            remainder: self.remainder.clone(),
            robot: self.robot().clone(),
            acceleration: self.acceleration().iter().map(records).collect(),
        })
    }

    /// Reads a file that [`to_json`](Self::to_json) wrote.
    ///
    /// # Errors
    ///
    /// [`Error::Read`], or [`Error::ModelFile`] that says what is wrong and what to do.
    pub fn load(path: &Path) -> Result<Self> {
        let text = std::fs::read_to_string(path).map_err(|source| Error::Read {
            path: path.into(),
            source,
            remedy: REMEDY,
        })?;
        let wrong = |problem: String| Error::ModelFile { path: path.into(), problem };
        let value = json::versioned(&text, FORMAT, VERSION, "abstract").map_err(wrong)?;
        let file: ModelFile =
            serde_json::from_value(value).map_err(|error| wrong(format!("{error}; {REMEDY}")))?;
        file.model(path)
    }
}

impl ModelFile {
    fn model(self, path: &Path) -> Result<PolynomialModel> {
        let wrong =
            |problem: String| Error::ModelFile { path: path.into(), problem: format!("{problem}; {REMEDY}") };
        let robot = Robot::from_description(&self.robot)?;
        let n = robot.joint_count();
        let layout = Layout::new(self.model, n);
        if self.variables != layout.names() {
            return Err(wrong(format!("its variables are not {}", layout.names().join(", "))));
        }
        if self.origin.len() != layout.variables() || self.acceleration.len() != n {
            return Err(wrong(format!("origin or acceleration has not the size for {n} joints")));
        }
        let point = &self.expansion_point;
        if point.q.len() != n || point.qd.len() != n || point.input().len() != n {
            return Err(wrong(format!("its expansion point is not one of {n} joints")));
        }
        if let Some(remainder) = self.remainder.as_ref().filter(|remainder| !remainder.is_of(n)) {
            return Err(wrong(format!(
                "its remainder has {} bounds, not one a joint, or an empty box",
                remainder.bounds.len()
            )));
        }
        let space = TaylorSpace::new(layout.variables(), self.order)?;
        let mut acceleration = Vec::with_capacity(n);
        for (joint, terms) in self.acceleration.into_iter().enumerate() {
            acceleration.push(
                polynomial(&space, terms)
                    .map_err(|problem| wrong(format!("acceleration of joint {}: {problem}", joint + 1)))?,
            );
        }
        let mut model = PolynomialModel::assemble(
            &robot,
            self.model,
            self.order,
            self.expansion_point,
            self.origin,
            acceleration,
        );
        model.remainder = self.remainder;
        if !model.is_close_to(&PolynomialModel::new(
            &robot,
            model.kind(),
            model.order(),
            model.expansion_point(),
        )?) {
            return Err(wrong("its terms are not those of its robot at its expansion point: the file was changed after it was written".into()));
        }
        Ok(model)
    }
}

fn polynomial(
    space: &std::sync::Arc<TaylorSpace>,
    terms: Vec<TermRecord>,
) -> Result<TaylorPolynomial, String> {
    for TermRecord(exponents, coefficient) in &terms {
        let degree: u32 = exponents.iter().map(|e| u32::from(*e)).sum();
        if exponents.len() != space.variables() || degree > space.order() || !coefficient.is_finite() {
            return Err(format!(
                "a term has {} exponents of sum {degree} and the coefficient {coefficient}; there are {} variables and order {}",
                exponents.len(),
                space.variables(),
                space.order()
            ));
        }
    }
    let term = |TermRecord(exponents, coefficient)| TaylorTerm { exponents, coefficient };
    Ok(TaylorPolynomial::from_terms(space, terms.into_iter().map(term)))
}

impl PolynomialModel {
    /// Whether all coefficients agree to [`SAME`] of the largest.
    fn is_close_to(&self, other: &Self) -> bool {
        let largest =
            |f: &TaylorPolynomial| f.terms().iter().map(|t| t.coefficient.abs()).fold(0.0, f64::max);
        let close = |(a, b): (&TaylorPolynomial, &TaylorPolynomial)| largest(&(a - b)) <= SAME * largest(b);
        self.origin() == other.origin() && self.acceleration().iter().zip(other.acceleration()).all(close)
    }
}
