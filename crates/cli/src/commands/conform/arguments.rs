use std::path::PathBuf;

use clap::{Args, ValueHint};
use reachtube::abstraction::ModelKind;
use reachtube::conform::settings::{Centre, Equations, InitialLimit, Method, NominalStart, States};
use reachtube::conform::{Group, Notion};
use reachtube_reach::Disturbance;

use crate::data_arguments::DataArguments;
use crate::lock_arguments::LockArguments;
use crate::option_values::{
    Choices, DISTURBANCES, INITIAL_LIMITS, MODELS, NOTIONS, choice, numbered_choice, seconds,
};

const HELP: &str = "\
Examples:
  reachtube conform --robot lwa4p --data recordings --suites A,B,D,E --torque compensated \\
      --out model.json
  reachtube conform --robot arm.toml --data recordings --torque motor \\
      --disturbance measurable --report report
  reachtube conform --robot lwa4p --data recordings --torque compensated \\
      --centre origin --disturbance constant
      with the settings of Liu and Althoff (2018)
  reachtube conform --robot lwa4p --data recordings --torque compensated \\
      --fit inertia,viscous,coulomb --out model.json
  reachtube conform --robot lwa4p --data recordings --torque compensated --notion exact \\
      --out model.json --certificate points.jsonl
      all states together lie in the reachable set itself
  reachtube conform --robot lwa4p --paper-model 2 --order 5 --data recordings \\
      --torque compensated --resume search.json
  reachtube conform --robot arm.toml --data logs --torque motor --horizon 0.3 --noise fitted \\
      --nominal own --equations robot --out model.json
      cut logs into windows of 0.3 s; the model does the same to other logs
  reachtube conform --robot arm.toml --data recordings --torque motor --calibrate M7,M8,M9
      find the sets on the other motions, and scale them to hold these three

Exit codes: 0 conformant and proved, 1 not proved conformant, 2 error, 3 conformant but vacuous:
the sets do not limit some joint.";

/// Find the smallest sets for which a model encloses every recording, and prove it
///
/// The sets are the initial set X0, the input set U and, with --noise, the measurement noise V.
#[derive(Debug, Args)]
#[command(after_help = HELP)]
pub(crate) struct Arguments {
    /// Robot: the embedded lwa4p, or a TOML or URDF file
    #[arg(
        long,
        help_heading = "Model",
        required_unless_present = "abstraction",
        value_hint = ValueHint::FilePath
    )]
    pub robot: Option<String>,
    #[command(flatten)]
    pub lock: LockArguments,
    /// Model of the forward dynamics, numbered as in the paper
    #[arg(
        long, hide_short_help = true,
        help_heading = "Model",
        default_value = "1",
        value_name = "MODEL",
        value_parser = numbered_choice::<ModelKind>(MODELS)
    )]
    pub paper_model: ModelKind,
    /// Order of the model's Taylor polynomials, 1 or more
    #[arg(
        long,
        hide_short_help = true,
        help_heading = "Model",
        default_value_t = 1,
        value_name = "P"
    )]
    pub order: u32,
    /// Expansion point, separated by commas: n positions in rad, or also n velocities in rad/s
    /// [default: 0]
    #[arg(
        long,
        hide_short_help = true,
        help_heading = "Model",
        value_name = "Q,..",
        value_delimiter = ',',
        allow_hyphen_values = true
    )]
    pub expansion: Vec<f64>,
    /// Model file that `abstract --out` wrote, instead of a robot
    #[arg(
        long, hide_short_help = true,
        help_heading = "Model",
        value_name = "FILE",
        conflicts_with_all = ["robot", "lock", "expansion", "paper_model", "order"]
    )]
    pub abstraction: Option<PathBuf>,
    /// TOML file with values for the options of this command.
    ///
    /// Its paths are relative to its folder, and options on the command line come before it.
    #[arg(long, value_name = "FILE")]
    pub settings: Option<PathBuf>,
    #[command(flatten)]
    pub data: DataArguments,
    /// Cut recordings into windows of this length, above 0 s, each a suite of its own.
    ///
    /// Torques of motors or links are filtered first, and the robot's gravity and dry friction are
    /// taken off them. The data may be logs as they are, one CSV file or a folder; `check`,
    /// `reach`, `report` and `export` do the same to theirs.
    #[arg(long, help_heading = "Data", value_name = "SECONDS", value_parser = seconds)]
    #[arg(allow_negative_numbers = true, conflicts_with = "until")]
    pub horizon: Option<f64>,
    /// Fit these parameters of the nominal model for the smallest sets, separated by commas
    #[arg(
        long,
        help_heading = "Fit",
        value_name = "GROUP,..",
        value_delimiter = ',',
        value_parser = choice::<Group>(GROUPS),
        conflicts_with = "abstraction"
    )]
    pub fit: Vec<Group>,
    /// Weight of the pull toward the identified values, from 0 to 1: part of the identified model's
    /// cost per unit of the logarithm of a factor, or of half the logarithm for inertia [default:
    /// chosen by leaving one motion out]
    #[arg(
        long,
        hide_short_help = true,
        help_heading = "Fit",
        value_name = "WEIGHT",
        requires = "fit",
        allow_hyphen_values = true
    )]
    pub pull: Option<f64>,
    /// How the disturbance may change in time; the verdict on a nonlinear model covers measurable
    /// disturbances in any case
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
    /// Directions in which recordings must lie in the reachable set
    #[arg(
        long,
        help_heading = "Sets",
        default_value = "hull",
        value_parser = choice::<Notion>(NOTIONS)
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
    /// How far X0 may reach. Where nothing limits it, X0 may take over what U would cover later
    #[arg(
        long, hide_short_help = true,
        help_heading = "Sets",
        default_value = "none",
        value_parser = choice::<InitialLimit>(INITIAL_LIMITS)
    )]
    pub initial_limit: InitialLimit,
    /// Weights of the states in the cost: unit (1 for each state); spread (1 over the state's
    /// largest deviation in the recordings); or 2 or 2n numbers between 1e-9 and 1e9, positions
    /// first
    #[arg(
        long,
        hide_short_help = true,
        help_heading = "Sets",
        default_value = "unit",
        value_name = "unit|spread|W,W,..",
        allow_hyphen_values = true
    )]
    pub weights: String,
    /// Measurement noise V: none, fitted, or its radii in rad and rad/s.
    ///
    /// Fitted radii are found with the sets and are at most the sensor noise's. Given radii are 2
    /// or 2n numbers between 0 and 1e9: positions in rad, then velocities in rad/s.
    #[arg(
        long,
        help_heading = "Sets",
        default_value = "none",
        value_name = "none|fitted|R,R,..",
        allow_hyphen_values = true
    )]
    pub noise: String,
    /// Radii of the sensors' noise, 2 or 2n numbers between 0 and 1e9: positions in rad, then
    /// velocities in rad/s. They limit V of --noise fitted and X0 of --nominal own [default:
    /// estimated from the recordings]
    #[arg(
        long,
        hide_short_help = true,
        help_heading = "Sets",
        value_name = "R,R,..",
        allow_hyphen_values = true
    )]
    pub sensor_noise: Option<String>,
    /// First state of the nominal motions
    #[arg(
        long, hide_short_help = true,
        help_heading = "Sets",
        default_value = "mean",
        value_parser = choice::<NominalStart>(NOMINAL_STARTS)
    )]
    pub nominal: NominalStart,
    /// Equations of motion that nominal motions satisfy.
    ///
    /// With the robot's equations U covers only what the robot itself does not explain; this needs
    /// a linear model.
    #[arg(
        long,
        help_heading = "Model",
        default_value = "model",
        value_parser = choice::<Equations>(EQUATIONS)
    )]
    pub equations: Equations,
    /// Motions that are held out from the fit, separated by commas; * and ? match as in M*.
    ///
    /// Their names are in runs.csv. The sets found on the other motions are scaled until they
    /// enclose these too, which bounds the probability that the next motion leaves them.
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
    /// Search for a motion of the model itself near each recording, within these tolerances in rad
    /// and rad/s: 2 numbers, 0 or more, or none [default: none for a linear model, otherwise
    /// 0.001,0.01 for the recordings that decide the sets]
    #[arg(long, hide_short_help = true, help_heading = "Method", value_name = "none|Q,QD")]
    pub explain: Option<String>,
    /// Save the progress of a long search to this file, and continue from it if it exists
    #[arg(long, hide_short_help = true, help_heading = "Method", value_name = "FILE")]
    pub resume: Option<PathBuf>,
    /// Write the model to this JSON file
    #[arg(long, help_heading = "Output", value_name = "FILE")]
    pub out: Option<PathBuf>,
    /// Write for every recorded point what another program needs to prove that it lies in the
    /// reachable set, for --notion exact and phase-plane: one line of JSON for each point
    #[arg(long, hide_short_help = true, help_heading = "Output", value_name = "FILE")]
    pub certificate: Option<PathBuf>,
    /// Write an HTML page and its figures to this folder
    #[arg(long, help_heading = "Output", value_name = "FOLDER")]
    pub report: Option<PathBuf>,
}

const GROUPS: Choices = &[
    ("inertia", "motor inertia of each joint and density of each link"),
    ("viscous", "viscous friction"),
    ("cubic", "quadratic and cubic viscous friction"),
    ("coulomb", "Coulomb friction, by quadrant where the quadrants differ"),
    ("warm-up", "viscous friction that changes with the order of a suite's runs"),
    ("payload", "a point mass at the last link's frame"),
];

const CENTRES: Choices = &[
    ("free", "any centre"),
    ("origin", "any centre for which the set contains 0, as in the paper"),
    ("zero", "the centre is 0"),
];

const STATES: Choices = &[("all", "positions and velocities"), ("positions", "positions only")];

const NOMINAL_STARTS: Choices = &[
    ("mean", "the mean of the first states of the suite's runs"),
    ("own", "each run's own first state"),
];

const EQUATIONS: Choices = &[
    ("model", "the model's"),
    ("robot", "the robot's own; the model describes the deviations from them"),
];

const METHODS: Choices = &[
    ("program", "linear programs: one for a linear model, a sequence of them otherwise"),
    ("bisection", "bisection of one radius after the other, the paper's baseline"),
];
