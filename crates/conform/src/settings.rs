use reachtube_reach::Disturbance;
use serde::{Deserialize, Serialize};

use crate::error::{Error, Result};
use reachtube_abstraction::{
    Abstraction, ExpansionPoint, OperatingBox, PolynomialModel, Remainder,
};
use reachtube_recordings::{GapLimit, Torque};

/// How the smallest sets are found (correction K of the method).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Method {
    /// By linear programs over all suites: one for a linear model; for another one after the other,
    /// each linearised along every nominal about the sets of the one before.
    #[default]
    Program,
    /// By bisection of one radius after the other, the paper's way for models that are not linear.
    /// The result depends on their order and is not the smallest together; it is there to be
    /// compared with.
    Bisection,
}

/// In which directions the reachable set must reach as far as the recordings (correction C of the
/// method).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Notion {
    /// Along ± each state axis: the interval hull of the runs lies in the hull of the reachable
    /// set, the paper's notion.
    #[default]
    Hull,
}

/// What the centres of the sets may be (correction B of the method).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Centre {
    /// Anything.
    #[default]
    Free,
    /// Such that the set contains the origin, |c| <= r: the paper's restriction.
    Origin,
    /// The origin.
    Zero,
}

/// Which states must be enclosed. The cost counts all of them in any case.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum States {
    /// Positions and velocities ("velocity conformant" in Table II).
    #[default]
    All,
    /// Positions only ("position conformant").
    Positions,
}

impl States {
    /// How many of the 2n states, ordered q then q̇, are rows.
    pub fn rows(self, joints: usize) -> usize {
        match self {
            Self::All => 2 * joints,
            Self::Positions => joints,
        }
    }
}

/// Where the nominal solution of a run starts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum NominalStart {
    /// At the mean of the first states of the suite's runs.
    #[default]
    Mean,
    /// At the run's own first state; the initial set then covers only what the model misses.
    Own,
}

/// What is known of the measurement noise: a set V of the measured state, centred at 0, that is
/// added to the reachable set where runs are compared with it.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Noise {
    /// No noise: every deviation is explained by X0 and U.
    #[default]
    None,
    /// Radii are unknowns of the program, and count in its cost as every radius does.
    Free,
    /// Known radii, 2n, rad and rad/s.
    Fixed(Vec<f64>),
}

/// How the states are weighed against each other in the cost (correction F of the method: rad and
/// rad/s are otherwise added as they are).
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Weights {
    /// 1 for each state.
    #[default]
    Unit,
    /// The reciprocal of the largest deviation of that state in the recordings.
    Spread,
    /// As given, 2n numbers between 1e-9 and 1e9.
    Given(Vec<f64>),
}

/// Within what largest difference a motion of the model counts as an explanation of a recording.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Tolerance {
    /// rad.
    pub position: f64,
    /// rad/s.
    pub velocity: f64,
}

impl Default for Tolerance {
    /// A little more than the noise of the paper's recordings: 0.0002 rad and 0.009 rad/s at most.
    fn default() -> Self {
        Self { position: 1e-3, velocity: 1e-2 }
    }
}

/// All that decides a conformance result besides robot and recordings.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Settings {
    /// What the recorded torques are.
    pub torque: Torque,
    /// Which of the paper's models.
    pub abstraction: Abstraction,
    /// Where the model is expanded.
    pub expansion_point: ExpansionPoint,
    /// The box over which what the model leaves out was bounded, where that was done; recordings
    /// must start in it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub operating_box: Option<OperatingBox>,
    /// How the sets are found.
    #[serde(default)]
    pub method: Method,
    /// The notion of conformance.
    pub notion: Notion,
    /// How the disturbance may change in time.
    pub disturbance: Disturbance,
    /// What the centres may be.
    pub centre: Centre,
    /// Which states are rows.
    pub states: States,
    /// The weights of the states.
    pub weights: Weights,
    /// The measurement noise.
    pub noise: Noise,
    /// Where nominal solutions start.
    pub nominal: NominalStart,
    /// Whether each run's own explanation is looked for, and what counts as one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub explain: Option<Tolerance>,
    /// Samples later than this many seconds after the first are not used.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub until: Option<f64>,
    /// How long a gap may be.
    #[serde(skip)]
    pub gap_limit: GapLimit,
}

impl Settings {
    /// The defaults for a robot of `joints` joints whose recordings hold `torque`.
    pub fn new(torque: Torque, joints: usize) -> Self {
        Self {
            torque,
            abstraction: Abstraction::default(),
            expansion_point: ExpansionPoint::zero(joints),
            operating_box: None,
            method: Method::default(),
            notion: Notion::default(),
            disturbance: Disturbance::default(),
            centre: Centre::default(),
            states: States::default(),
            weights: Weights::default(),
            noise: Noise::default(),
            nominal: NominalStart::default(),
            explain: None,
            until: None,
            gap_limit: GapLimit::default(),
        }
    }

    /// Takes model, expansion point and operating box from an abstraction.
    ///
    /// # Errors
    ///
    /// [`Error::Setting`] where what the model leaves out was found to have no bound over its box.
    pub fn with_abstraction(self, model: &PolynomialModel) -> Result<Self> {
        let unbounded = |remainder: &Remainder| remainder.bounds.iter().position(Option::is_none);
        if let Some(joint) = model.remainder().and_then(unbounded) {
            return Err(Error::Setting(format!(
                "what the model leaves out of the acceleration of joint {} has no bound over its box; give `abstract` a smaller --box or more --most-boxes, or no box at all",
                joint + 1
            )));
        }
        Ok(Self {
            abstraction: Abstraction { model: model.kind(), order: model.order() },
            expansion_point: model.expansion_point().clone(),
            operating_box: model.remainder().map(|remainder| remainder.operating_box.clone()),
            ..self
        })
    }

    /// Checks sizes and signs for a robot of `joints` joints.
    ///
    /// # Errors
    ///
    /// [`Error::Setting`] that names the setting, its value and what it may be.
    pub fn validate(&self, joints: usize) -> Result<()> {
        if let Weights::Given(weights) = &self.weights {
            check_list(
                "weight",
                weights,
                2 * joints,
                |w| (1e-9..=1e9).contains(&w),
                "between 1e-9 and 1e9",
            )?;
        }
        if let Noise::Fixed(radii) = &self.noise {
            check_list(
                "noise radius",
                radii,
                2 * joints,
                |r| (0.0..=1e9).contains(&r),
                "between 0 and 1e9",
            )?;
        }
        if let Some(Tolerance { position, velocity }) = self.explain {
            check_list("tolerance", &[position, velocity], 2, |t| t >= 0.0, "0 or more")?;
        }
        match self.until {
            Some(until) if !(until >= 0.0 && until.is_finite()) => {
                Err(Error::Setting(format!("until is {until} s; give a time after the start in s")))
            }
            _ => Ok(()),
        }
    }
}

fn check_list(
    what: &str,
    values: &[f64],
    count: usize,
    fits: impl Fn(f64) -> bool,
    range: &str,
) -> Result<()> {
    if values.len() != count {
        return Err(Error::Setting(format!(
            "{} {what} values; there are {count} states, q then q̇",
            values.len()
        )));
    }
    match values.iter().enumerate().find(|(_, v)| !(v.is_finite() && fits(**v))) {
        Some((i, value)) => {
            Err(Error::Setting(format!("{what} {} is {value}; it must be {range}", i + 1)))
        }
        None => Ok(()),
    }
}
