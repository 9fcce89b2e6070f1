//! The options that decide which sets `conform` finds.

use clap::Args;
use reachtube::arm::Equations;
use reachtube::conform::settings::{Centre, InitialLimit, Method, NominalStart, States, Weights};
use reachtube::conform::{Noise, Notion, Settings};
use reachtube_reach::Disturbance;

use crate::error::{Error, Result};
use crate::option_values::{Choices, DISTURBANCES, INITIAL_LIMITS, choice};

/// The options that decide which sets are found.
#[derive(Debug, Args)]
pub(crate) struct SetArguments {
    /// How the disturbance may change in time
    #[arg(
        long, hide_short_help = true,
        help_heading = "Sets",
        default_value = "sample",
        value_parser = choice::<Disturbance>(DISTURBANCES)
    )]
    pub disturbance: Disturbance,
    /// Centres of the sets X0 and U
    #[arg(
        long, hide_short_help = true,
        help_heading = "Sets",
        default_value = "free",
        value_parser = choice::<Centre>(CENTRES)
    )]
    pub centre: Centre,
    /// What must lie in the reachable set
    #[arg(
        long,
        help_heading = "Sets",
        default_value = "hull",
        value_parser = choice::<Notion>(Notion::NAMES)
    )]
    pub notion: Notion,
    /// States that the reachable set must enclose
    #[arg(
        long, hide_short_help = true,
        help_heading = "Sets",
        default_value = "all",
        value_parser = choice::<States>(STATES)
    )]
    pub states: States,
    /// How far X0 may reach
    #[arg(
        long, hide_short_help = true,
        help_heading = "Sets",
        default_value = "none",
        value_parser = choice::<InitialLimit>(INITIAL_LIMITS)
    )]
    pub initial_limit: InitialLimit,
    /// Widen U by the dry friction that is possible near standstill, for motions whose joints stick
    /// or slip at other times
    #[arg(long, hide_short_help = true, help_heading = "Sets")]
    pub stiction: bool,
    /// Weights of the states in the cost: 1, or 2 or 2n numbers between 1e-9 and 1e9, positions
    /// first
    #[arg(
        long,
        hide_short_help = true,
        help_heading = "Sets",
        default_value = "unit",
        value_name = "unit|W,W,..",
        allow_hyphen_values = true
    )]
    pub weights: String,
    /// Measurement noise V: none, fitted up to the sensors' noise, or 2 or 2n radii up to 1e9, in
    /// rad, then rad/s
    #[arg(
        long,
        help_heading = "Sets",
        default_value = "none",
        value_name = "none|fitted|R,R,..",
        allow_hyphen_values = true
    )]
    pub noise: String,
    /// Radii of the sensors' noise, 2 or 2n numbers up to 1e9, in rad, then rad/s [default:
    /// estimated from the recordings]
    #[arg(
        long,
        hide_short_help = true,
        help_heading = "Sets",
        value_name = "R,R,..",
        allow_hyphen_values = true
    )]
    pub sensor_noise: Option<String>,
    /// Accelerations of the nominal motion at which U is twice what it is at rest, n numbers, in
    /// rad/s² [default: U is the same along every motion]
    #[arg(
        long,
        hide_short_help = true,
        help_heading = "Sets",
        value_name = "A,..",
        value_delimiter = ',',
        allow_hyphen_values = true
    )]
    pub input_doubling: Option<Vec<f64>>,
    /// First state of the nominal motions
    #[arg(
        long, hide_short_help = true,
        help_heading = "Sets",
        default_value = "mean",
        value_parser = choice::<NominalStart>(NOMINAL_STARTS)
    )]
    pub nominal: NominalStart,
    /// Equations of motion that nominal motions satisfy; the robot's need a linear model
    #[arg(
        long,
        help_heading = "Model",
        default_value = "model",
        value_parser = choice::<Equations>(EQUATIONS)
    )]
    pub equations: Equations,
    /// Motions that are held out, such as M1,N*: the sets are scaled until they enclose these too
    #[arg(long, help_heading = "Sets", value_name = "MOTION,..", value_delimiter = ',')]
    pub calibrate: Vec<String>,
    /// Method that finds the sets
    #[arg(
        long, hide_short_help = true,
        help_heading = "Method",
        default_value = "program",
        value_parser = choice::<Method>(METHODS)
    )]
    pub method: Method,
}

const CENTRES: Choices = &[
    ("free", "any centre"),
    ("origin", "the set contains 0, as in the paper"),
    ("zero", "the centre is 0"),
];

const STATES: Choices = &[("all", "positions and velocities"), ("positions", "positions only")];

const NOMINAL_STARTS: Choices = &[
    ("mean", "the mean of the first states of the suite's runs"),
    ("own", "each run's own first state"),
    ("past", "where the samples before a window of a log tell that it starts"),
];

const EQUATIONS: Choices = &[
    ("model", "the model's"),
    ("robot", "the robot's"),
    ("velocity", "none: without the robot and its torque, the velocity stays"),
    ("decaying", "none: the acceleration at the start dies out"),
    ("held", "none: the acceleration at the start stays"),
];

const METHODS: Choices =
    &[("program", "linear programs"), ("bisection", "one radius after the other, as in the paper")];

impl SetArguments {
    /// Returns the usual settings of a robot of `joints` joints with these options.
    pub(super) fn settings(&self, usual: Settings, joints: usize) -> Result<Settings> {
        Ok(Settings {
            method: self.method,
            disturbance: self.disturbance,
            centre: self.centre,
            notion: self.notion,
            states: self.states,
            initial_limit: self.initial_limit,
            stiction: self.stiction,
            weights: match self.weights.as_str() {
                "unit" => Weights::Unit,
                list => Weights::Given(numbers("--weights", "unit, ", list, joints)?),
            },
            noise: match self.noise.as_str() {
                "none" => Noise::None,
                "fitted" => Noise::Fitted,
                list => Noise::Fixed(numbers("--noise", "none, fitted, ", list, joints)?),
            },
            sensor_noise: match &self.sensor_noise {
                Some(list) => Some(numbers("--sensor-noise", "", list, joints)?),
                None => None,
            },
            input_doubling: self.input_doubling.clone(),
            nominal: self.nominal,
            calibrate: self.calibrate.clone(),
            ..usual
        })
    }
}

/// Parses one number per state: 2n numbers, or 2 that stand for all positions and all velocities.
/// `words` names the other values of the option, for the error.
fn numbers(
    option: &'static str,
    words: &'static str,
    list: &str,
    joints: usize,
) -> Result<Vec<f64>> {
    let states = 2 * joints;
    let wrong = |problem: String| {
        Error::setting(format!(
            "{option}: {problem}; give {words}2 numbers (positions, velocities), or {states} (one \
             per state)"
        ))
    };
    let parse = |text: &str| {
        text.trim().parse::<f64>().map_err(|_| wrong(format!("\"{text}\" is not a number")))
    };
    let values = list.split(',').map(parse).collect::<Result<Vec<_>>>()?;
    match values[..] {
        [position, velocity] => Ok([vec![position; joints], vec![velocity; joints]].concat()),
        _ if values.len() == states => Ok(values),
        _ => Err(wrong(format!("{} values given", values.len()))),
    }
}
