//! The model file: what `conform` found, and everything that is needed to use it and to trace it
//! back.

use std::collections::HashSet;
use std::path::Path;
use std::sync::Arc;

use nalgebra::DMatrix;
use reachtube_files::{json, write};
use reachtube_finding::Finding;
use reachtube_reach::{Hyperrectangle, LinearSystem, System};
use reachtube_recordings::Preparation;
use schemars::JsonSchema;
use serde::de::IgnoredAny;
use serde::{Deserialize, Serialize};
use serde_json::Value;
use sha2::{Digest, Sha256};

use crate::claim::verdict::Verdict;
use crate::conformance::Conformance;
use crate::data::problem::Problem;
use crate::data::recordings::Recordings;
use crate::data::sensor_noise::SensorNoise;
use crate::data::settings::Settings;
use crate::data::setup::{Drive, Setup};
use crate::data::signals::Signals;
use crate::error::{Error, Result};
use crate::fit::record::FitRecord;
use crate::model::records::{DataRecord, LogRecord, is_zero};
use crate::next_motion::any_run::AnyRun;
use crate::next_motion::calibration::Calibration;
use crate::next_motion::trends::Trend;
use crate::next_motion::trust::Trust;
use crate::next_motion::without_motion::LeftOut;
use crate::plausibility::Usefulness;
use crate::search::found::SearchSummary;
use crate::sets::UncertaintySets;
use crate::stiction::Stiction;
use crate::tube::witness::Witness;

/// What the field `format` of every model file says.
pub(crate) const FORMAT: &str = "reachtube-model";

/// The version of the format that this library writes and reads; the schema is
/// what `reachtube man --schema model` prints.
pub(crate) const VERSION: u32 = 4;

/// Number of tight values kept in a file at most: as many as a degenerate program may have would
/// make it unreadable.
pub(crate) const MOST_TIGHT: usize = 500;

/// Makes what drives a model again from its file.
pub trait Loader {
    /// Returns the drive that wrote the record in a model file, and the system bit by bit as the
    /// file has it.
    ///
    /// # Errors
    ///
    /// What is wrong with the record.
    fn load(&self, model: &Model) -> Result<(Arc<dyn Drive>, System), String>;
}

/// A model with the uncertainty sets for which it is reachset conformant with the recordings named
/// in it. SI units; states are ordered q then q̇.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Model {
    /// The name of the format, "reachtube-model".
    #[schemars(extend("const" = FORMAT))]
    pub format: String,
    /// The version of the format.
    #[schemars(extend("const" = VERSION))]
    pub version: u32,
    /// Name and version of the program that wrote the file.
    pub tool: String,
    /// Whether the sets were proved to enclose the recordings.
    pub verified: bool,
    /// The cost of the sets: the integral over time of Σ_i s_i times the width of the reachable set
    /// and the noise, over all states; the mean where suites have different sets. `None` where a
    /// reachable set was lost.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(required)]
    pub cost: Option<f64>,
    /// The cost as the paper sums it: over distinct sample times, each of which counts 1.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub cost_of_samples: Option<f64>,
    /// The solver's dual objective for a linear model: sets that satisfy the program cost no less,
    /// up to its tolerance.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub cost_lower_bound: Option<f64>,
    /// How far the cost may be above the least, relative to the lower bound, for a linear model.
    /// Above 1e-6 the sets enclose the recordings but are not the smallest.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub optimality_gap: Option<f64>,
    /// The paper's sum (21) for a linear model, with E where |E| is meant, for comparison.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub cost_paper: Option<f64>,
    /// Σ_k Δt Π_i of the hull's edges, eq. (2). `None` where a reachable set was lost.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub hull_volume: Option<f64>,
    /// How the sets of a model that is not linear were found.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub search: Option<SearchSummary>,
    /// X0 around the nominal initial state, 2n, rad and rad/s.
    pub initial_set: Hyperrectangle,
    /// U around the nominal input, n, N m.
    pub input_set: Hyperrectangle,
    /// V, the measurement noise, 2n, where it was asked for.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub noise_set: Option<Hyperrectangle>,
    /// The noise of the sensors, where it limits V or X0.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sensor_noise: Option<SensorNoise>,
    /// Implausible results, and the most likely cause.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub warnings: Vec<Finding>,
    /// How much the sets say about the motion of each part.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub usefulness: Option<Usefulness>,
    /// The part of the variance of each state that the nominal motions explain, 2n; `None` if
    /// the state hardly moves.
    pub nominal_explains: Vec<Option<f64>>,
    /// The root mean square of the input minus what the robot needs for the recorded motions, n,
    /// N m, to lay beside U.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub input_error: Vec<f64>,
    /// The proof.
    pub proof: Verdict,
    /// What may be expected of the next motion.
    pub trust: Trust,
    /// How the sets were scaled, where motions were held out for it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub calibration: Option<Calibration>,
    /// The radii that were added to the smallest X0 and U, 3n, in SI units; none if none were.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub allowance: Vec<f64>,
    /// The dry friction that U was widened for, part by part; none without the setting.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub stiction: Vec<Stiction>,
    /// The sets without each of the motions they were found on, of a linear model.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub left_out: Vec<LeftOut>,
    /// The parts whose motion follows the order of the runs.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub trends: Vec<Trend>,
    /// The recorded points that touch the reachable set and so decide the sets, the closest first,
    /// 500 at most.
    pub tight: Vec<Witness>,
    /// The settings.
    pub settings: Settings,
    /// How logs became its recordings, where a pipeline made them. Commands do the same to other
    /// logs.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub preparation: Option<Preparation>,
    /// The sets that hold for every run and every warmth of the parts.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub any_run: Option<AnyRun>,
    /// How the nominal model was fitted, where it was.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub fit: Option<FitRecord>,
    /// A, 2n x 2n, of a linear model.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub a: Vec<Vec<f64>>,
    /// B, 2n x n.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub b: Vec<Vec<f64>>,
    /// d of ẋ = A x + B u + d, 2n; zero about q̇ = 0.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub drift: Vec<f64>,
    /// What its numbers are.
    pub signals: Signals,
    /// What drives the system, as it wrote itself down: a robot, and the polynomials of a model
    /// that is not linear.
    pub drive: Value,
    /// SHA-256 of the recordings that the drive was identified from or fitted to.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub seen: Vec<String>,
    /// The logs that a pipeline made it of or held out from it.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub logs: Vec<LogRecord>,
    /// Number of models with other sets that the file had before, and that some of the same
    /// recordings calibrated or were held out from. Bounds count them.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub replaced: usize,
    /// The recordings.
    pub data: DataRecord,
    /// The findings that the command prints beside the model. They follow from the rest and are
    /// not read.
    #[serde(default, skip_serializing)]
    #[schemars(skip)]
    pub(crate) findings: IgnoredAny,
    /// SHA-256 of the rest of the file's content, so that a change is noticed.
    pub sha256: String,
}

impl Model {
    /// Makes the model of a problem for which sets were found.
    #[must_use]
    pub fn new(problem: &Problem, found: &Conformance) -> Self {
        let (dynamics, settings) = (problem.dynamics(), problem.settings());
        let UncertaintySets { initial_set, input_set, noise_set } = found.sets.clone();
        let finite = |value: f64| value.is_finite().then_some(value);
        let linear = dynamics.linear_system();
        let matrix =
            |of: fn(&LinearSystem) -> &DMatrix<f64>| linear.map_or_else(Vec::new, |s| rows(of(s)));
        Self {
            format: FORMAT.into(),
            version: VERSION,
            tool: reachtube_files::TOOL.into(),
            verified: found.verdict.conformant,
            cost: finite(found.cost),
            cost_of_samples: finite(found.cost_of_samples),
            cost_lower_bound: found.lower_bound,
            optimality_gap: found.optimality_gap,
            cost_paper: found.paper_cost,
            hull_volume: finite(found.hull_volume),
            search: found.search.clone(),
            initial_set,
            input_set,
            noise_set,
            sensor_noise: settings.are_limited_by_noise().then(|| problem.sensor_noise().clone()),
            warnings: found.warnings.clone(),
            usefulness: Some(found.usefulness.clone()),
            nominal_explains: found.nominal_explains.clone(),
            input_error: found.input_error.clone(),
            proof: found.verdict.clone(),
            trust: found.trust.clone(),
            calibration: found.calibration.clone(),
            allowance: found.allowance.clone(),
            stiction: found.stiction.clone(),
            left_out: found.left_out.clone(),
            trends: found.trends.clone(),
            tight: found.tight.iter().take(MOST_TIGHT).cloned().collect(),
            settings: settings.clone(),
            preparation: None,
            any_run: found.any_run.clone(),
            fit: None,
            a: matrix(LinearSystem::a),
            b: matrix(LinearSystem::b),
            drift: linear.map_or_else(Vec::new, |system| system.drift().iter().copied().collect()),
            signals: problem.signals().clone(),
            drive: problem.setup().drive.record(dynamics),
            seen: problem.setup().drive.seen().to_vec(),
            logs: Vec::new(),
            replaced: 0,
            data: DataRecord::new(problem),
            findings: IgnoredAny,
            sha256: String::new(),
        }
        .sealed()
    }

    /// Reads the text of a model file, checks that its parts fit together, and returns what a
    /// problem with other recordings needs of it: the drive, the system bit by bit as the file has
    /// it, and the settings. Errors name the file `origin`.
    ///
    /// # Errors
    ///
    /// [`Error::ModelFile`], which says what is wrong.
    pub fn parse(text: &str, origin: &Path, loader: &dyn Loader) -> Result<(Self, Setup)> {
        let wrong = |problem: String| Error::ModelFile { path: origin.into(), problem };
        let value = json::versioned(text, FORMAT, VERSION, "conform").map_err(wrong)?;
        let model: Self = serde_json::from_value(value).map_err(|error| {
            wrong(format!(
                "{error}; give the file as `conform --out` wrote it, or run conform again"
            ))
        })?;
        let setup = model.checked_setup(loader).map_err(wrong)?;
        Ok((model, setup))
    }

    /// Returns what a problem with other recordings needs of the model, as [`parse`](Self::parse).
    ///
    /// # Errors
    ///
    /// [`Error::ModelFile`] for a model whose parts contradict each other.
    pub fn loaded(&self, loader: &dyn Loader) -> Result<Setup> {
        let wrong = |problem| Error::ModelFile { path: "the model".into(), problem };
        self.checked_setup(loader).map_err(wrong)
    }

    /// Writes the model file. A file that exists is replaced.
    ///
    /// # Errors
    ///
    /// [`Error::File`] where the file cannot be written.
    pub fn save(&self, path: impl AsRef<Path>) -> Result<()> {
        let text = self.to_json();
        Ok(write::atomically(path.as_ref(), |out| out.write_all(text.as_bytes()))?)
    }

    /// Returns the file's text: JSON, ending with a newline.
    #[must_use]
    pub fn to_json(&self) -> String {
        json::to_lines(&self.clone().sealed())
    }

    pub(super) fn sealed(self) -> Self {
        Self { sha256: self.digest(), ..self }
    }

    /// Returns the SHA-256 that the content must have: of its JSON without spaces and with an
    /// empty `sha256`.
    pub(super) fn digest(&self) -> String {
        let unsealed = Self { sha256: String::new(), ..self.clone() };
        let text = serde_json::to_vec(&unsealed).expect("a model has string keys");
        reachtube_files::hex(&Sha256::digest(text))
    }

    /// Returns X0, U and V.
    #[must_use]
    pub fn sets(&self) -> UncertaintySets {
        UncertaintySets {
            initial_set: self.initial_set.clone(),
            input_set: self.input_set.clone(),
            noise_set: self.noise_set.clone(),
        }
    }

    /// Returns whether one of these recordings is among the recordings that the model was fitted to
    /// or its robot identified from; `None` if that cannot be known, because the file lists no
    /// recordings, or because a fold that was not made to check this model has not kept the SHA-256
    /// of each recording.
    #[must_use]
    pub fn knows_of(&self, recordings: &Recordings) -> Option<bool> {
        if !self.data.are_listed() {
            return None;
        }
        let runs = self.data.suites.iter().flat_map(|suite| &suite.runs);
        let own = runs.flat_map(|run| std::iter::once(&run.sha256).chain(&run.origin));
        let seen = own.chain(&self.seen);
        let fitted: HashSet<&str> = seen.map(String::as_str).collect();
        let mut runs = recordings.suites.iter().flat_map(|suite| &suite.runs);
        if runs.any(|run| run.is_among(&fitted)) {
            return Some(true);
        }
        let are_complete = recordings.suites.iter().all(|suite| suite.every_run().is_ok());
        match &recordings.compared {
            _ if are_complete => Some(false),
            Some((digest, count)) if *digest == self.data.sha256 => Some(*count > 0),
            _ => None,
        }
    }

    /// Returns the optimality gap where it is so large that the sets must not be called the
    /// smallest.
    #[must_use]
    pub fn gap_of_not_minimal(&self) -> Option<f64> {
        let largest = self.settings.notion.largest_gap();
        self.optimality_gap.filter(|gap| *gap > largest)
    }

    /// Returns the number of inputs n.
    #[must_use]
    pub fn inputs(&self) -> usize {
        self.input_set.dimension()
    }

    /// Returns what tables call U.
    pub(crate) fn name_of_input_set(&self) -> &'static str {
        if self.settings.input_doubling.is_some() { "U rest" } else { "U" }
    }
}

fn rows(matrix: &DMatrix<f64>) -> Vec<Vec<f64>> {
    matrix.row_iter().map(|row| row.iter().copied().collect()).collect()
}
