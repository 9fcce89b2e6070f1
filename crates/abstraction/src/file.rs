//! The file of a polynomial model.

use std::path::Path;

use reachtube_robot::{Robot, RobotDescription};
use reachtube_scalar::{TaylorPolynomial, TaylorSpace, TaylorTerm};
use serde::{Deserialize, Serialize};

use super::layout::Layout;
use super::{Abstraction, ExpansionPoint, ModelKind, PolynomialModel, Remainder};
use crate::error::{Error, Result};
use reachtube_files::json;

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

/// A term in a file: exponents, one a variable, and coefficient.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct TermRecord(pub Vec<u8>, pub f64);

/// The polynomials of a model in a file.
#[derive(Default)]
pub struct Records {
    /// Names of the variables, in the order of the exponents.
    pub variables: Vec<String>,
    /// The terms are in offsets of the variables from here.
    pub origin: Vec<f64>,
    /// For each joint, the terms of its acceleration.
    pub acceleration: Vec<Vec<TermRecord>>,
}

impl PolynomialModel {
    /// The model as JSON: a term a line, ending with a newline. Numbers read back are the same bit
    /// by bit.
    pub fn to_json(&self) -> String {
        let Records { variables, origin, acceleration } = self.records();
        json::to_lines(&ModelFile {
            format: FORMAT.into(),
            version: VERSION,
            tool: reachtube_files::TOOL.into(),
            model: self.kind(),
            order: self.order(),
            expansion_point: self.expansion_point().clone(),
            variables,
            origin,
            remainder: self.remainder.clone(),
            robot: self.robot().clone(),
            acceleration,
        })
    }

    /// Returns the polynomials as a file holds them.
    #[must_use]
    pub fn records(&self) -> Records {
        let terms = |f: &TaylorPolynomial| {
            f.terms().into_iter().map(|t| TermRecord(t.exponents, t.coefficient)).collect()
        };
        Records {
            variables: self.layout().names(),
            origin: self.origin().to_vec(),
            acceleration: self.acceleration().iter().map(terms).collect(),
        }
    }

    /// The model of these records, bit by bit, once they have been compared with what the robot
    /// gives at the expansion point.
    ///
    /// # Errors
    ///
    /// What does not fit, in words.
    pub fn of_records(
        robot: &Robot,
        abstraction: Abstraction,
        point: &ExpansionPoint,
        records: Records,
    ) -> Result<Self, String> {
        let Abstraction { model, order } = abstraction;
        let n = robot.joint_count();
        let layout = Layout::new(model, n);
        if records.variables != layout.names() {
            return Err(format!("its variables are not {}", layout.names().join(", ")));
        }
        if records.origin.len() != layout.variables() || records.acceleration.len() != n {
            return Err(format!("origin or acceleration has not the size for {n} joints"));
        }
        if point.q.len() != n || point.qd.len() != n || point.input().len() != n {
            return Err(format!("its expansion point is not one of {n} joints"));
        }
        let space =
            TaylorSpace::new(layout.variables(), order).map_err(|error| error.to_string())?;
        let mut acceleration = Vec::with_capacity(n);
        for (joint, terms) in records.acceleration.into_iter().enumerate() {
            let wrong = |problem| format!("acceleration of joint {}: {problem}", joint + 1);
            acceleration.push(polynomial(&space, terms).map_err(wrong)?);
        }
        let own = Self::assemble(robot, model, order, point.clone(), records.origin, acceleration);
        let made = Self::new(robot, model, order, point).map_err(|error| error.to_string())?;
        if !own.is_close_to(&made) {
            return Err("its terms are not those of its robot at its expansion point: the file was changed after it was written".into());
        }
        Ok(own)
    }

    /// Reads a file that [`to_json`](Self::to_json) wrote.
    ///
    /// # Errors
    ///
    /// [`Error::File`], or [`Error::ModelFile`] that says what is wrong and what to do.
    pub fn load(path: &Path) -> Result<Self> {
        let text = reachtube_files::read_text(path, REMEDY)?;
        let wrong = |problem: String| Error::ModelFile { path: path.into(), problem };
        let value = json::versioned(&text, FORMAT, VERSION, "abstract").map_err(wrong)?;
        let file: ModelFile =
            serde_json::from_value(value).map_err(|error| wrong(format!("{error}; {REMEDY}")))?;
        file.model(path)
    }
}

impl ModelFile {
    fn model(self, path: &Path) -> Result<PolynomialModel> {
        let wrong = |problem: String| Error::ModelFile {
            path: path.into(),
            problem: format!("{problem}; {REMEDY}"),
        };
        let robot = Robot::from_description(&self.robot)?;
        let n = robot.joint_count();
        if let Some(remainder) = self.remainder.as_ref().filter(|remainder| !remainder.is_of(n)) {
            return Err(wrong(format!(
                "its remainder has {} bounds, not one a joint, or an empty box",
                remainder.bounds.len()
            )));
        }
        let abstraction = Abstraction { model: self.model, order: self.order };
        let Self { variables, origin, acceleration, .. } = self;
        let records = Records { variables, origin, acceleration };
        let mut model =
            PolynomialModel::of_records(&robot, abstraction, &self.expansion_point, records)
                .map_err(wrong)?;
        model.remainder = self.remainder;
        Ok(model)
    }
}

fn polynomial(
    space: &std::sync::Arc<TaylorSpace>,
    terms: Vec<TermRecord>,
) -> Result<TaylorPolynomial, String> {
    for TermRecord(exponents, coefficient) in &terms {
        let degree: u32 = exponents.iter().map(|e| u32::from(*e)).sum();
        if exponents.len() != space.variables()
            || degree > space.order()
            || !coefficient.is_finite()
        {
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
        let largest = |f: &TaylorPolynomial| {
            f.terms().iter().map(|t| t.coefficient.abs()).fold(0.0, f64::max)
        };
        let close =
            |(a, b): (&TaylorPolynomial, &TaylorPolynomial)| largest(&(a - b)) <= SAME * largest(b);
        self.origin() == other.origin()
            && self.acceleration().iter().zip(other.acceleration()).all(close)
    }
}
