//! The origin of an answer.

use schemars::JsonSchema;
use serde::Serialize;

use serde_json::Value;

use crate::data::problem::Problem;
use crate::data::settings::Settings;
use crate::model::file::Model;
use crate::model::records::DataRecord;

/// The origin of an answer: the model, the settings in force, and each recording by its digest.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct Provenance {
    /// Name and version of the program.
    pub tool: &'static str,
    /// The digest in the model file.
    pub model_sha256: String,
    /// The settings in force. Notion and end of the recordings may be others than the model's.
    pub settings: Settings,
    /// The settings of what drives the model, where its record has some.
    #[serde(default, skip_serializing_if = "Value::is_null")]
    pub driven_by: Value,
    /// The recordings.
    pub data: DataRecord,
}

impl Model {
    pub(crate) fn provenance(&self, problem: &Problem) -> Provenance {
        self.provenance_of(problem.settings().clone(), DataRecord::new(problem))
    }

    /// Returns what the model's own verdict is about: the recordings that it was made from.
    #[must_use]
    pub fn own_provenance(&self) -> Provenance {
        self.provenance_of(self.settings.clone(), self.data.clone())
    }

    fn provenance_of(&self, settings: Settings, data: DataRecord) -> Provenance {
        let model_sha256 = self.sha256.clone();
        let driven_by = self.drive.get("settings").cloned().unwrap_or_default();
        Provenance { tool: reachtube_files::TOOL, model_sha256, settings, driven_by, data }
    }
}
