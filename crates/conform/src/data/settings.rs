//! The settings of a conformance.

use std::ops::RangeInclusive;
use std::path::Path;

use reachtube_reach::Disturbance;
use reachtube_recordings::{Defect, GapLimit, Run};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::data::notion::Notion;
use crate::error::{Error, Result};

/// How the smallest sets are found (docs/method.md, correction K).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Method {
    /// By linear programs over all suites: one program for a linear model; a sequence of them for
    /// any other, each linearised along every nominal motion about the sets of the one before.
    #[default]
    Program,
    /// By bisection of one radius after the other, the paper's way for models that are not linear.
    /// The result depends on the order of the radii, and other radii may cost less: it is a
    /// baseline.
    Bisection,
}

/// Where the centres of the sets may lie (docs/method.md, correction B).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Centre {
    /// Anywhere.
    #[default]
    Free,
    /// Where the set still contains the origin, |c| <= r: the paper's restriction.
    Origin,
    /// At the origin.
    Zero,
}

/// Which states must be enclosed. The cost counts all of them in any case.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum States {
    /// Positions and velocities ("velocity conformant" in Table II).
    #[default]
    All,
    /// Positions only ("position conformant").
    Positions,
}

impl States {
    /// Returns how many of a number of states, positions before velocities, are rows.
    pub(crate) fn rows(self, states: usize) -> usize {
        match self {
            Self::All => states,
            Self::Positions => states / 2,
        }
    }

    /// Returns what rows are of, to follow the word "rows"; empty if they are of all states.
    pub(crate) fn of_words(self) -> &'static str {
        match self {
            Self::All => "",
            Self::Positions => " of positions",
        }
    }

    /// Returns which of them must lie in the reachable set together.
    #[must_use]
    pub fn together(self, notion: Notion) -> &'static str {
        match (notion, self) {
            (Notion::Hull, Self::All) => "each state by itself",
            (Notion::Hull | Notion::PhasePlane, Self::Positions) => "each position by itself",
            (Notion::PhasePlane, Self::All) => "each position and its velocity together",
            (Notion::Exact, Self::All) => "all states together",
            (Notion::Exact, Self::Positions) => "all positions together",
        }
    }
}

/// How far X0 may reach, to the accuracy of the solver and of the repair after it. Where each run
/// starts at its own measured state, the noise of the sensors limits X0 in any case.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum InitialLimit {
    /// By the amount that makes the sets cheapest: X0 may take over what U would have to cover
    /// later.
    #[default]
    None,
    /// Positions no further than the first states of the recordings lie from their nominal start,
    /// as the positions of X0 in Table II.
    Positions,
    /// Positions and velocities no further than these first states.
    States,
}

/// Where the nominal motion of a run starts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum NominalStart {
    /// At the mean of the first states of the suite's runs.
    #[default]
    Mean,
    /// At the run's own first state, which is known up to the noise of the sensors: X0 is at most
    /// that large.
    Own,
    /// Where the samples up to the run's first one tell that it starts ([`Run::before`]), as a
    /// motion's start is known while it goes on. X0 has the error of that.
    Past,
}

impl NominalStart {
    /// Returns whether each run has its own.
    pub(crate) fn is_of_run(self) -> bool {
        self != Self::Mean
    }

    /// Returns whether the noise of the sensors limits X0, which then cannot grow for a motion.
    pub(crate) fn is_measured(self) -> bool {
        self == Self::Own
    }

    /// Checks that the start of a run at `path` is known.
    ///
    /// # Errors
    ///
    /// A run without samples before it, where these tell its start.
    pub(crate) fn check(self, path: &Path, run: &Run) -> Result<(), Vec<Defect>> {
        if self != Self::Past || run.before.len() >= run.dimension() {
            return Ok(());
        }
        let problem = "the model's motions start where the samples before them tell, and there are \
                       none before this recording";
        let remedy = "give logs with torques of motors or links as they were recorded, of which \
                      windows are cut";
        Err(vec![Defect::new(path, None, problem, remedy)])
    }
}

/// The measurement noise: a set V of the measured state, centred at 0, that is added to the
/// reachable set where runs are compared with it.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Noise {
    /// No noise: X0 and U explain every deviation.
    #[default]
    None,
    /// The radii are unknowns of the program, count in its cost as every radius does, and are at
    /// most the sensor noise's.
    Fitted,
    /// Known radii, 2n, rad and rad/s.
    Fixed(Vec<f64>),
}

impl Noise {
    /// Returns the known radius of state `i`; 0 if none is known.
    pub(crate) fn known(&self, i: usize) -> f64 {
        match self {
            Self::Fixed(radii) => radii[i],
            Self::None | Self::Fitted => 0.0,
        }
    }
}

/// How the states are weighed against each other in the cost (docs/method.md, correction F: rad and
/// rad/s are otherwise added as they are).
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Weights {
    /// 1 for each state.
    #[default]
    Unit,
    /// As given, 2n numbers between 1e-9 and 1e9.
    Given(Vec<f64>),
}

impl Weights {
    pub(crate) fn of_states(&self, states: usize) -> Vec<f64> {
        match self {
            Self::Unit => vec![1.0; states],
            Self::Given(weights) => weights.clone(),
        }
    }
}

/// Everything that decides a conformance result besides recordings and what drives the model along
/// them.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Settings {
    /// How the sets are found.
    #[serde(default)]
    pub method: Method,
    /// How the disturbance may change in time.
    pub disturbance: Disturbance,
    /// Where the centres may lie.
    pub centre: Centre,
    /// In which directions recordings must lie in the reachable set.
    #[serde(default)]
    pub notion: Notion,
    /// Which states are rows.
    pub states: States,
    /// How far X0 may reach.
    #[serde(default, skip_serializing_if = "is_default")]
    pub initial_limit: InitialLimit,
    /// Whether U is widened by the dry friction that is possible where parts may come to rest, for
    /// other motions under the same motor torque.
    #[serde(default, skip_serializing_if = "is_default")]
    pub stiction: bool,
    /// The weights of the states.
    pub weights: Weights,
    /// The measurement noise.
    pub noise: Noise,
    /// Radii of the sensors' noise, 2n, rad and rad/s; estimated from the recordings where they are
    /// `None`. They limit V where it is [`Noise::Fitted`], and X0 where each run has its own
    /// nominal start.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sensor_noise: Option<Vec<f64>>,
    /// Where nominal motions start.
    pub nominal: NominalStart,
    /// The rates of the nominal motion at which U is twice what it is at rest, one per input: of
    /// the last state of the part that the input drives. U has the radius r (1 + a / b) along a
    /// motion whose largest rate is a, where b is this setting, r is the radius that the sets have,
    /// and a / b is rounded up to 64ths. Without it U is the same along every motion.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub input_doubling: Option<Vec<f64>>,
    /// The motions that are held out from the fit and then calibrate its sets. They are not
    /// looked at but by [`conform`](crate::conform).
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub calibrate: Vec<String>,
    /// Samples later than this many seconds after the first are not used.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub until: Option<f64>,
    /// Longest time between two samples.
    #[serde(skip)]
    pub gap_limit: GapLimit,
}

impl Settings {
    pub(crate) fn are_limited_by_noise(&self) -> bool {
        self.noise == Noise::Fitted || self.nominal.is_measured()
    }

    /// Checks sizes and signs for a model of `inputs` inputs.
    ///
    /// # Errors
    ///
    /// [`Error::SettingCount`] and [`Error::SettingRange`], which name the setting, its value and
    /// what it may be; [`Error::Stiction`] if stiction cannot be covered.
    pub fn validate(&self, inputs: usize) -> Result<()> {
        if self.stiction && self.disturbance == Disturbance::Constant {
            return Err(Error::Stiction(
                "friction changes during a motion, and a constant disturbance does not; let it \
                 change at each sample",
            ));
        }
        if let Weights::Given(weights) = &self.weights {
            check_list("weight", weights, (2 * inputs, STATES), 1e-9..=1e9)?;
        }
        if let Noise::Fixed(radii) = &self.noise {
            check_list("noise radius", radii, (2 * inputs, STATES), 0.0..=1e9)?;
        }
        if let Some(radii) = &self.sensor_noise {
            check_list("sensor noise radius", radii, (2 * inputs, STATES), 0.0..=1e9)?;
        }
        if let Some(rates) = &self.input_doubling {
            check_list("input doubling", rates, (inputs, "one per input"), 1e-9..=1e9)?;
            if self.notion != Notion::Hull || self.method != Method::Program {
                return Err(Error::InputDoubling("the notion hull and the method program"));
            }
        }
        self.until.map_or(Ok(()), |until| check_range("until", None, until, &(0.0..=f64::MAX)))
    }
}

fn is_default<T: Default + PartialEq>(value: &T) -> bool {
    *value == T::default()
}

pub(crate) fn check_allowance(allowance: &[f64], inputs: usize) -> Result<()> {
    let order = "X0 for q, then for q̇, then U";
    check_list("allowance", allowance, (3 * inputs, order), 0.0..=1e9)
}

/// The order of values of all states.
const STATES: &str = "one per state, q then q̇";

fn check_list(
    setting: &'static str,
    values: &[f64],
    (needed, order): (usize, &'static str),
    range: RangeInclusive<f64>,
) -> Result<()> {
    if values.len() != needed {
        return Err(Error::SettingCount { setting, given: values.len(), needed, order });
    }
    let mut pairs = values.iter().enumerate();
    pairs.try_for_each(|(index, value)| check_range(setting, Some(index + 1), *value, &range))
}

fn check_range(
    setting: &'static str,
    index: Option<usize>,
    value: f64,
    range: &RangeInclusive<f64>,
) -> Result<()> {
    if range.contains(&value) {
        return Ok(());
    }
    let (low, high) = (*range.start(), *range.end());
    Err(Error::SettingRange { setting, index, value, low, high })
}
