//! What is written of an answer: JSON, the model, the robot and the choices.

use std::path::Path;

use reachtube_conform::model::Provenance;
use reachtube_files::MARK;
use reachtube_finding::Finding;
use schemars::JsonSchema;
use serde::Serialize;
use serde_json::Value;

use crate::build::Built;
use crate::choices::{Choice, Choices};
use crate::compared::HeldOut;
use crate::horizon::HorizonWidths;
use crate::joint_row::JointRow;
use crate::without_model::WithoutModel;

/// The answer of `model` as JSON.
#[derive(Serialize, JsonSchema)]
pub struct ModelOutput<'a> {
    /// Whether the model is conformant and its sets are narrow enough.
    useful: bool,
    /// Whether the sets were proved to enclose the recordings.
    conformant: bool,
    /// Time up to which the model predicts, s.
    horizon: Option<f64>,
    /// The set of each joint at the horizon.
    joints: Vec<JointRow>,
    /// The check of the motions that were held out.
    held_out: &'a HeldOut,
    /// The sets without a model, beside which the model's are judged.
    #[serde(skip_serializing_if = "Option::is_none")]
    without_model: Option<&'a WithoutModel>,
    /// The horizons that were tried, with sets that have their allowance.
    horizons: &'a [HorizonWidths],
    /// The choices, each with its reason.
    choices: &'a [Choice],
    /// What is claimed, in words.
    claim: &'a str,
    /// What contradicts the recordings and the robot first, then the findings of the model.
    findings: Vec<Finding>,
    /// What the answer is about.
    #[serde(flatten)]
    provenance: Provenance,
}

impl Built {
    /// Returns the answer as JSON, as [`ModelOutput`] describes it.
    #[must_use]
    pub fn to_json(&self) -> Value {
        serde_json::to_value(self.output()).expect("an answer has string keys")
    }

    /// Returns what is written of the answer as JSON.
    #[must_use]
    pub fn output(&self) -> ModelOutput<'_> {
        ModelOutput {
            useful: self.is_useful(),
            conformant: self.answer.holds(),
            horizon: self.choices.horizon,
            joints: self.joints(),
            held_out: &self.held_out,
            without_model: self.without_model.as_ref(),
            horizons: &self.horizons,
            choices: &self.made,
            claim: &self.answer.model.proof.claim,
            findings: self.all_findings(),
            provenance: self.answer.model.own_provenance(),
        }
    }

    /// Returns the names and the texts of the model file, the robot file and the file of choices,
    /// whose paths are absolute.
    #[must_use]
    pub fn files(&self) -> [(&'static str, String); 3] {
        let robot = toml::to_string(self.robot.description());
        let robot = robot.expect("the keys of a description are strings");
        let here = std::env::current_dir().unwrap_or_default();
        let absolute = |path: &Path| here.join(path);
        let named = Choices {
            robot: self.choices.robot.as_ref().map(|name| match Path::new(name) {
                path if path.exists() => absolute(path).display().to_string(),
                _ => name.clone(),
            }),
            data: self.choices.data.iter().map(|path| absolute(path)).collect(),
            ..self.choices.clone()
        };
        let choices = named.to_toml(&self.made);
        let head = "the choices behind model.json, each with its reason";
        [
            ("model.json", self.answer.model.to_json()),
            ("robot.toml", format!("# {MARK} model.\n{robot}")),
            ("choices.toml", format!("# {MARK} model: {head}.\n\n{choices}")),
        ]
    }
}
