//! The file of a polynomial model (`reachtube man --schema abstraction`).

use std::path::Path;

use reachtube_files::json;
use reachtube_robot::{Robot, RobotDescription};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::abstraction::Abstraction;
use crate::error::{Error, Result};
use crate::expansion_point::ExpansionPoint;
use crate::model_kind::ModelKind;
use crate::polynomial_model::PolynomialModel;
use crate::records::{Records, TermRecord};

/// Name of the format.
const FORMAT: &str = "reachtube-abstraction";
/// Version of the format that this crate writes and reads.
const VERSION: u32 = 1;
const REMEDY: &str = "give a file that `abstract --out` wrote";

/// The content of a model's file.
#[derive(Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct ModelFile {
    /// The name of the format, "reachtube-abstraction".
    #[schemars(extend("const" = FORMAT))]
    format: String,
    /// The version of the format.
    #[schemars(extend("const" = VERSION))]
    version: u32,
    /// Name and version of the program that wrote the file.
    tool: String,
    /// The paper's number of the model.
    model: ModelKind,
    /// Order of the model.
    order: u32,
    /// The point about which the model is expanded.
    expansion_point: ExpansionPoint,
    /// Names of the variables, in the order of the exponents.
    variables: Vec<String>,
    /// The point from which the terms count offsets, one value per variable.
    origin: Vec<f64>,
    /// The robot.
    robot: RobotDescription,
    /// Terms of the acceleration of each joint, rad/s².
    acceleration: Vec<Vec<TermRecord>>,
}

/// Returns the JSON schema of the file.
#[must_use]
pub fn file_schema() -> serde_json::Value {
    reachtube_files::schema::<ModelFile>()
}

impl PolynomialModel {
    /// Returns the model as JSON with one line per term, ending with a newline. Numbers read back
    /// are the same bit by bit.
    #[must_use]
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
            robot: self.robot().clone(),
            acceleration,
        })
    }

    /// Reads a file that [`to_json`](Self::to_json) wrote.
    ///
    /// # Errors
    ///
    /// [`Error::File`] where the file cannot be read, [`Error::ModelFile`] where it is not the file
    /// of a model or was changed, and [`Error::Robot`] if its robot is wrong.
    pub fn load(path: &Path) -> Result<Self> {
        Self::parse(&reachtube_files::read_text(path, REMEDY)?, path)
    }

    /// Reads the text of a file as [`load`](Self::load) does; errors name it `origin`.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`load`](Self::load), except [`Error::File`].
    pub fn parse(text: &str, origin: &Path) -> Result<Self> {
        let wrong = |problem: String| Error::ModelFile { path: origin.into(), problem };
        let value = json::versioned(text, FORMAT, VERSION, "abstract").map_err(wrong)?;
        let file: ModelFile =
            serde_json::from_value(value).map_err(|error| wrong(format!("{error}; {REMEDY}")))?;
        file.model(origin)
    }
}

impl ModelFile {
    fn model(self, path: &Path) -> Result<PolynomialModel> {
        let wrong = |problem: String| Error::ModelFile {
            path: path.into(),
            problem: format!("{problem}; {REMEDY}"),
        };
        let robot = Robot::from_description(&self.robot)?;
        let abstraction = Abstraction { model: self.model, order: self.order };
        let Self { variables, origin, acceleration, .. } = self;
        let records = Records { variables, origin, acceleration };
        PolynomialModel::from_records(&robot, abstraction, &self.expansion_point, records)
            .map_err(|error| wrong(error.to_string()))
    }
}
