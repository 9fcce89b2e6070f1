//! The model file of a system.

use reachtube_files::{FileHead, SealedFile};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::description::SystemDescription;
use crate::error::Result;
use crate::rows::SystemSets;
use crate::system::OutputSystem;

/// What the field `format` of every file says.
pub(crate) const FORMAT: &str = "reachtube-system-model";

/// The version of the format.
pub(crate) const VERSION: u32 = 1;

/// A system with sets for which its reachable outputs hold recordings.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SystemModel {
    /// The name of the format, "reachtube-system-model".
    #[schemars(extend("const" = FORMAT))]
    pub format: String,
    /// The version of the format.
    #[schemars(extend("const" = VERSION))]
    pub version: u32,
    /// Name and version of the program that wrote the file.
    pub tool: String,
    /// Whether every recorded output was proved to lie in the sets, with directed rounding.
    pub verified: bool,
    /// The system.
    pub system: SystemDescription,
    /// Its sets.
    pub sets: SystemSets,
    /// The integral over time of the widths that the sets give the outputs which were found, each
    /// times its weight.
    pub cost: f64,
    /// No sets cost less, to the tolerance of the solver.
    pub lower_bound: f64,
    /// The widths of the outputs.
    pub outputs: Vec<OutputWidth>,
    /// The narrowest sets without a model.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub without_model: Option<OutputsAlone>,
    /// What recordings need that were left out.
    pub left_out: RunsLeftOut,
    /// Over how many first samples the start of a recording is estimated; 0 if it is known.
    pub start_samples: usize,
    /// The recordings.
    pub recordings: Vec<SystemRecording>,
    /// SHA-256 of the rest of the file's content, so that a change is noticed.
    pub sha256: String,
}

/// How wide an output is.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct OutputWidth {
    /// The name of the output.
    pub name: String,
    /// The mean width of its set over the samples.
    pub mean: f64,
    /// The largest width of its set.
    pub largest: f64,
    /// The mean difference of the highest and the lowest deviation of a sample from the nominal
    /// motion: no sets around the same motions are narrower.
    pub least: f64,
    /// The difference of its highest and its lowest recorded value.
    pub motion: f64,
}

/// Sets of a system that depends on its outputs alone.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct OutputsAlone {
    /// What it takes the outputs to do.
    pub how: String,
    /// How many times as wide its sets are on average, each output with its weight.
    pub narrower: f64,
}

/// What recordings need of sets that were found without them.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RunsLeftOut {
    /// The number of recordings that were left out.
    pub runs: usize,
    /// Whether each was left out in turn, and not every second one at once.
    pub is_in_turn: bool,
    /// The number of left-out recordings that lie in the sets of the other recordings.
    pub inside: usize,
    /// The recording that needs the largest part of the sets of the others.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub furthest: Option<String>,
    /// The factor of the sets of the others that it needs; `None` if no factor suffices.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub factor: Option<f64>,
}

/// A recording that a model was made of.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SystemRecording {
    /// Its name.
    pub run: String,
    /// SHA-256 of its file.
    pub sha256: String,
    /// The number of its samples.
    pub samples: usize,
}

impl SystemModel {
    pub(crate) fn new(system: SystemDescription, sets: SystemSets) -> Self {
        Self {
            format: String::new(),
            version: 0,
            tool: String::new(),
            verified: false,
            system,
            sets,
            cost: 0.0,
            lower_bound: 0.0,
            outputs: vec![],
            without_model: None,
            left_out: RunsLeftOut::default(),
            start_samples: 0,
            recordings: vec![],
            sha256: String::new(),
        }
    }

    /// Returns whether the sets are proved, and narrower than those without a model.
    #[must_use]
    pub fn is_useful(&self) -> bool {
        self.verified && self.without_model.as_ref().is_none_or(|of| of.narrower > 1.0)
    }

    /// Returns the system.
    ///
    /// # Errors
    ///
    /// [`Error::System`](crate::Error::System), for a description that was changed.
    pub fn system(&self) -> Result<OutputSystem> {
        OutputSystem::new(self.system.clone())
    }
}

impl SealedFile for SystemModel {
    const FORMAT: &'static str = FORMAT;
    const VERSION: u32 = VERSION;
    const COMMAND: &'static str = "conform";

    fn head(&mut self) -> FileHead<'_> {
        let Self { format, version, tool, sha256, .. } = self;
        FileHead { format, version, tool, sha256 }
    }

    fn check_content(&self) -> Result<(), String> {
        let system = self.system().map_err(|error| error.to_string())?;
        let sets = [&self.sets.start, &self.sets.disturbance, &self.sets.noise];
        match system.forms.iter().zip(sets).all(|(form, set)| set.has_form(form)) {
            true => Ok(()),
            false => Err("its sets do not fit its system".into()),
        }
    }
}
