//! What is written of an answer: JSON, the model, the robot and the choices.

use std::path::Path;

use reachtube_conform::model::Provenance;
use reachtube_files::MARK;
use serde_json::{Value, json};

use crate::build::Built;
use crate::choices::Choices;

impl Built {
    /// Returns the answer as JSON, as docs/output.schema.json describes it.
    #[must_use]
    pub fn to_json(&self) -> Value {
        let Provenance { tool, model_sha256, settings, data } = self.answer.model.own_provenance();
        json!({
            "useful": self.is_useful(),
            "conformant": self.answer.holds(),
            "horizon": self.choices.horizon,
            "joints": self.joints(),
            "held_out": {
                "windows": self.held_out.windows,
                "rows": self.held_out.rows,
                "outside": self.held_out.outside,
                "motions": self.held_out.motions,
                "factor": self.held_out.factor,
                "failure": self.held_out.failure,
            },
            "horizons": self.horizons.iter().map(|widths| json!({
                "horizon": widths.horizon, "ratios": widths.ratios, "reason": widths.reason,
                "with_fit": widths.with_fit,
            })).collect::<Vec<Value>>(),
            "choices": self.made,
            "claim": self.answer.model.proof.claim,
            "findings": self.all_findings(),
            "tool": tool,
            "model_sha256": model_sha256,
            "settings": settings,
            "data": data,
        })
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
