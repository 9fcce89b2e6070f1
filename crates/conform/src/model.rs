//! The model file: what `conform` found, and all that is needed to use it and to trace it back.

use std::collections::HashSet;
use std::path::Path;

use nalgebra::{DMatrix, DVector};
use reachtube_reach::{Hyperrectangle, LinearSystem};
use reachtube_robot::{Robot, RobotDescription};
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

use crate::error::{Error, Result};
use crate::{
    Conformance, Dynamics, Explanation, Place, Proof, Recordings, Search, Settings, TightRow,
    Tolerance, Trust, UncertaintySets,
};
use reachtube_abstraction::{PolynomialModel, Records, TermRecord};
use reachtube_files::json;
use reachtube_recordings::DataSet;

/// What the field `format` of every model file says.
pub const FORMAT: &str = "reachtube-model";

/// The version of the format that this library writes and reads; the schema is
/// `docs/model.schema.json`.
pub const VERSION: u32 = 1;

/// Numbers that are computed twice are the same to this part.
const SAME: f64 = 1e-9;

const MODEL_REMEDY: &str = "give a file that `conform --out` wrote";

/// Tight rows kept in a file at most: as many as a degenerate program may have would make it
/// unreadable.
pub const MOST_TIGHT: usize = 500;

/// A model with the uncertainty sets for which it is reachset conformant with the recordings named
/// in it. SI units; states are ordered q then q̇.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Model {
    /// [`FORMAT`].
    pub format: String,
    /// [`VERSION`].
    pub version: u32,
    /// Name and version of the program that wrote the file.
    pub tool: String,
    /// Whether the sets were proved to enclose the recordings.
    pub verified: bool,
    /// The cost of the sets: Σ_k Σ_i s_i times the width of the reachable set and the noise, over
    /// all states and distinct sample times; the mean where suites have different sets. None where
    /// a reachable set was lost.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub cost: Option<f64>,
    /// The solver's dual objective for a linear model: sets that satisfy the program cost no less,
    /// up to its tolerance.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub cost_lower_bound: Option<f64>,
    /// The paper's sum (21) for a linear model, with E where |E| is meant, for comparison.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub cost_paper: Option<f64>,
    /// Σ_k Δt Π_i of the hull's edges, eq. (2). None where a reachable set was lost.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub hull_volume: Option<f64>,
    /// How the sets of a model that is not linear were found.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub search: Option<Search>,
    /// Which recordings a motion of the model itself reproduces, where that was looked for.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub explained: Option<Explained>,
    /// X0 around the nominal initial state, 2n, rad and rad/s.
    pub initial_set: Hyperrectangle,
    /// U around the nominal input, n, N m.
    pub input_set: Hyperrectangle,
    /// V, the measurement noise, 2n, where it was asked for.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub noise_set: Option<Hyperrectangle>,
    /// What was proved.
    pub proof: Proof,
    /// What may be expected of the next motion.
    pub trust: Trust,
    /// The recorded points that touch the reachable set and so decide the sets, the closest first,
    /// 500 at most.
    pub tight: Vec<Place>,
    /// How it was done.
    pub settings: Settings,
    /// A, 2n x 2n, of a linear model.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub a: Vec<Vec<f64>>,
    /// B, 2n x n.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub b: Vec<Vec<f64>>,
    /// d of ẋ = A x + B u + d, 2n; zero about q̇ = 0.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub drift: Vec<f64>,
    /// Names of the variables of the polynomials of a model that is not linear, as in the file of
    /// an abstraction.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub variables: Vec<String>,
    /// What the polynomials' variables are offsets from.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub origin: Vec<f64>,
    /// For each joint, the terms of its acceleration, rad/s².
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub acceleration: Vec<Vec<TermRecord>>,
    /// The recordings.
    pub data: DataRecord,
    /// The robot.
    pub robot: RobotDescription,
}

/// Recordings beside the closest motions of the model that were found: a start in X0 and an input
/// in U, held over each sample.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Explained {
    /// Recordings that are reproduced within the tolerance of the settings.
    pub runs: usize,
    /// Each recording.
    pub residuals: Vec<Residual>,
}

/// The largest difference of a recording to the closest motion found.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Residual {
    /// Path in the data set.
    pub file: String,
    /// rad; none where the motion ran away.
    pub position: Option<f64>,
    /// rad/s; none where the motion ran away.
    pub velocity: Option<f64>,
}

/// The recordings that a model encloses.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DataRecord {
    /// SHA-256 over the lines `sha256  file` of all runs, as in the output of sha256sum, in this
    /// order.
    pub sha256: String,
    /// The suites.
    pub suites: Vec<SuiteRecord>,
}

/// A test suite in a model file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SuiteRecord {
    /// Its name.
    pub name: String,
    /// The motion it is part of, where the index says so.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub motion: Option<String>,
    /// Its runs.
    pub runs: Vec<RunRecord>,
}

/// A run in a model file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RunRecord {
    /// Path in the data set.
    pub file: String,
    /// SHA-256 of the file.
    pub sha256: String,
    /// Samples used.
    pub samples: usize,
    /// Time from the first to the last of them, s.
    pub duration: f64,
}

impl Model {
    /// The model that a conformance found.
    pub fn new(robot: &Robot, data: &DataSet, settings: &Settings, found: &Conformance) -> Self {
        let UncertaintySets { initial_set, input_set, noise_set } = found.sets.clone();
        let finite = |value: f64| value.is_finite().then_some(value);
        let (mut linear, mut polynomial) = (None, Records::default());
        match &found.dynamics {
            Dynamics::Linear(system) => linear = Some(system),
            Dynamics::Polynomial(model) => polynomial = model.records(),
        }
        let matrix =
            |of: fn(&LinearSystem) -> &DMatrix<f64>| linear.map_or_else(Vec::new, |s| rows(of(s)));
        Self {
            format: FORMAT.into(),
            version: VERSION,
            tool: reachtube_files::TOOL.into(),
            verified: found.proof.verified,
            cost: finite(found.cost),
            cost_lower_bound: found.lower_bound,
            cost_paper: found.paper_cost,
            hull_volume: finite(found.hull_volume),
            search: found.search.clone(),
            explained: settings.explain.map(|tolerance| Explained::new(data, tolerance, found)),
            initial_set,
            input_set,
            noise_set,
            proof: found.proof.clone(),
            trust: found.trust.clone(),
            tight: tight(data, found, robot.joint_count()),
            settings: settings.clone(),
            a: matrix(LinearSystem::a),
            b: matrix(LinearSystem::b),
            drift: linear.map_or_else(Vec::new, |system| system.drift().iter().copied().collect()),
            variables: polynomial.variables,
            origin: polynomial.origin,
            acceleration: polynomial.acceleration,
            data: DataRecord::new(data, &found.recordings),
            robot: robot.description().clone(),
        }
    }

    /// Reads a model file and checks that its parts fit together.
    ///
    /// # Errors
    ///
    /// [`Error::Read`], or [`Error::ModelFile`] that says what is wrong.
    pub fn load(path: &Path) -> Result<Self> {
        let text = reachtube_files::read_text(path, MODEL_REMEDY)?;
        let wrong = |problem: String| Error::ModelFile { path: path.into(), problem };
        let value = json::versioned(&text, FORMAT, VERSION, "conform").map_err(wrong)?;
        let model: Self = serde_json::from_value(value).map_err(|error| {
            wrong(format!(
                "{error}; give the file as `conform --out` wrote it, or run conform again"
            ))
        })?;
        model.check().map_err(wrong)?;
        Ok(model)
    }

    /// The file's text: JSON, ending with a newline.
    pub fn to_json(&self) -> String {
        json::to_lines(self)
    }

    /// The robot.
    ///
    /// # Errors
    ///
    /// When the embedded description is no robot.
    pub fn robot(&self) -> Result<Robot> {
        Ok(Robot::from_description(&self.robot)?)
    }

    /// The model itself: bit by bit what its file says.
    ///
    /// # Errors
    ///
    /// When matrices or polynomials do not fit together, or are not those of the robot.
    pub fn dynamics(&self) -> Result<Dynamics> {
        if self.acceleration.is_empty() {
            return Ok(Dynamics::Linear(self.system()?));
        }
        let records = Records {
            variables: self.variables.clone(),
            origin: self.origin.clone(),
            acceleration: self.acceleration.clone(),
        };
        let Settings { abstraction, expansion_point, .. } = &self.settings;
        PolynomialModel::of_records(&self.robot()?, *abstraction, expansion_point, records)
            .map(|model| Dynamics::Polynomial(Box::new(model)))
            .map_err(Error::Setting)
    }

    fn system(&self) -> Result<LinearSystem> {
        let matrix = |rows: &[Vec<f64>]| {
            DMatrix::from_row_iterator(
                rows.len(),
                rows.first().map_or(0, Vec::len),
                rows.iter().flatten().copied(),
            )
        };
        Ok(LinearSystem::new(
            matrix(&self.a),
            matrix(&self.b),
            DVector::from_vec(self.drift.clone()),
        )?)
    }

    /// X0, U and V.
    pub fn sets(&self) -> UncertaintySets {
        UncertaintySets {
            initial_set: self.initial_set.clone(),
            input_set: self.input_set.clone(),
            noise_set: self.noise_set.clone(),
        }
    }

    /// Whether one of these recordings, by its SHA-256, is among those that the model was fitted
    /// to.
    pub fn was_fitted_to(&self, recordings: &Recordings) -> bool {
        let fitted: HashSet<&str> = self
            .data
            .suites
            .iter()
            .flat_map(|suite| &suite.runs)
            .map(|run| run.sha256.as_str())
            .collect();
        recordings
            .suites
            .iter()
            .flat_map(|suite| &suite.runs)
            .any(|run| fitted.contains(run.sha256.as_str()))
    }

    /// Number of joints n.
    pub fn joints(&self) -> usize {
        self.input_set.dimension()
    }

    fn check(&self) -> Result<(), String> {
        let n = self.robot.joints.len();
        let is = |matrix: &[Vec<f64>], columns: usize| {
            matrix.len() == 2 * n && matrix.iter().all(|row| row.len() == columns)
        };
        let set =
            |set: &Hyperrectangle, dimension: usize| set.is_valid() && set.dimension() == dimension;
        let costs = [self.cost, self.cost_lower_bound, self.cost_paper, self.hull_volume];
        if self.acceleration.is_empty() && costs.contains(&None) {
            return Err("it has no cost, cost_lower_bound, cost_paper or hull_volume, as every linear model does; run conform again".into());
        }
        let linear = is(&self.a, 2 * n) && is(&self.b, n) && self.drift.len() == 2 * n;
        let none = self.a.is_empty() && self.b.is_empty() && self.drift.is_empty();
        let sizes = if self.acceleration.is_empty() { linear } else { none };
        let sets = set(&self.initial_set, 2 * n)
            && set(&self.input_set, n)
            && self.noise_set.as_ref().is_none_or(|noise| set(noise, 2 * n));
        if !sizes {
            return Err(format!(
                "a, b or drift has not the size for the {n} joints of its robot; run conform again"
            ));
        }
        if !sets {
            return Err(format!(
                "initial_set, input_set or noise_set has not the size for the {n} joints of its robot, or a negative radius; run conform again"
            ));
        }
        let point = &self.settings.expansion_point;
        if point.q.len() != n || point.qd.len() != n {
            return Err(format!("its expansion point is not one of {n} joints; run conform again"));
        }
        if self.settings.operating_box.as_ref().is_some_and(|operating_box| !operating_box.is_of(n))
        {
            return Err(format!("its operating box is not one of {n} joints; run conform again"));
        }
        self.settings.validate(n).map_err(|error| error.to_string())?;
        self.check_parts()
    }

    /// What is in the file twice must be the same: where it is not, somebody has changed a part.
    fn check_parts(&self) -> Result<(), String> {
        let changed = |what: &str| {
            Err(format!("{what}: the file was changed after it was written; run conform again"))
        };
        let robot = self.robot().map_err(|error| error.to_string())?;
        let made = Dynamics::new(&robot, &self.settings).map_err(|error| error.to_string())?;
        let near =
            |x: &DMatrix<f64>, y: &DMatrix<f64>| (x - y).amax() <= SAME * x.amax().max(y.amax());
        match (&made, self.dynamics().map_err(|error| error.to_string())?) {
            (Dynamics::Linear(made), Dynamics::Linear(own)) => {
                let drift = (made.drift() - own.drift()).amax() <= SAME * made.drift().amax();
                if !(near(made.a(), own.a()) && near(made.b(), own.b()) && drift) {
                    return changed(
                        "a, b or drift is not that of its robot at its expansion point",
                    );
                }
            }
            (Dynamics::Polynomial(_), Dynamics::Polynomial(_)) => {}
            _ => {
                return changed("it has not the matrices or polynomials that its settings ask for");
            }
        }
        if self.data.sha256 != self.data.digest() {
            return changed("data.sha256 is not that of the recordings it lists");
        }
        if self.verified != self.proof.verified
            || self.verified && self.proof.proved != self.proof.rows
        {
            return changed("verified does not agree with proof");
        }
        Ok(())
    }
}

impl Explained {
    /// In one sentence, for people; `tolerance` is that of the settings.
    pub fn words(&self, tolerance: Tolerance) -> String {
        let worst = self
            .residuals
            .iter()
            .max_by(|a, b| a.in_tolerances(tolerance).total_cmp(&b.in_tolerances(tolerance)));
        let Some(worst) = worst else { return "no recording to explain".into() };
        let median = |of: fn(&Residual) -> Option<f64>| {
            let mut values: Vec<f64> =
                self.residuals.iter().map(|r| of(r).unwrap_or(f64::INFINITY)).collect();
            values.sort_by(f64::total_cmp);
            format!("{:.2e}", values[values.len() / 2])
        };
        let of = |value: Option<f64>| {
            value.map_or_else(|| "infinitely far".into(), |value| format!("{value:.2e}"))
        };
        format!(
            "a motion of the model itself (start in X0, input in U, held over each sample) was found within {} rad and {} rad/s of {} of the {} recordings; \
             the closest found differ by {} rad and {} rad/s in the median, and by {} rad and {} rad/s for {}",
            tolerance.position,
            tolerance.velocity,
            self.runs,
            self.residuals.len(),
            median(|r| r.position),
            median(|r| r.velocity),
            of(worst.position),
            of(worst.velocity),
            worst.file
        )
    }

    fn new(data: &DataSet, tolerance: Tolerance, found: &Conformance) -> Self {
        let is_within =
            |e: &&Explanation| e.position <= tolerance.position && e.velocity <= tolerance.velocity;
        let finite = |value: f64| value.is_finite().then_some(value);
        let residual = |e: &Explanation| Residual {
            file: data.runs()[e.run].file.clone(),
            position: finite(e.position),
            velocity: finite(e.velocity),
        };
        Self {
            runs: found.explanations.iter().filter(is_within).count(),
            residuals: found.explanations.iter().map(residual).collect(),
        }
    }
}

impl Residual {
    /// The larger difference in parts of the tolerance.
    fn in_tolerances(&self, tolerance: Tolerance) -> f64 {
        let part = |value: Option<f64>, of: f64| {
            value.unwrap_or(f64::INFINITY) / of.max(f64::MIN_POSITIVE)
        };
        part(self.position, tolerance.position).max(part(self.velocity, tolerance.velocity))
    }
}

impl DataRecord {
    fn new(data: &DataSet, recordings: &Recordings) -> Self {
        let mut suites = Vec::new();
        for suite in &recordings.suites {
            let mut runs = Vec::new();
            for run in &suite.runs {
                let file = data.runs()[run.index].file.clone();
                let (sha256, samples, duration) = (run.sha256.clone(), run.samples, run.duration);
                runs.push(RunRecord { file, sha256, samples, duration });
            }
            suites.push(SuiteRecord {
                name: suite.entry.name.clone(),
                motion: suite.entry.motion.clone(),
                runs,
            });
        }
        let record = Self { sha256: String::new(), suites };
        Self { sha256: record.digest(), ..record }
    }

    fn digest(&self) -> String {
        let mut digest = Sha256::new();
        for run in self.suites.iter().flat_map(|suite| &suite.runs) {
            digest.update(format!("{}  {}\n", run.sha256, run.file));
        }
        reachtube_files::hex(&digest.finalize())
    }
}

/// The tight rows in the words of the recordings.
fn tight(data: &DataSet, found: &Conformance, joints: usize) -> Vec<Place> {
    let place = |tight: &TightRow| {
        Place::new(data, &found.recordings.suites[tight.suite], &tight.row, joints)
    };
    found.tight.iter().take(MOST_TIGHT).map(place).collect()
}

fn rows(matrix: &DMatrix<f64>) -> Vec<Vec<f64>> {
    matrix.row_iter().map(|row| row.iter().copied().collect()).collect()
}
