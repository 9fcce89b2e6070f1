use std::path::PathBuf;

use clap::{Args, ValueHint};
use reachtube::abstraction::ModelKind;
use reachtube::conform::Group;

use super::sets::SetArguments;
use crate::data_arguments::DataArguments;
use crate::lock_arguments::LockArguments;
use crate::option_values::{Choices, MODELS, choice, numbered_choice, seconds};

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

  reachtube conform --system car.toml --data drives --out model.json
      a linear system, its outputs and the forms of its sets are in the file

Exit codes: 0 conformant, which is proved, 1 not proved, 2 error, 3 conformant, but the sets do not
limit some joint.";

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
        required_unless_present_any = ["abstraction", "system"],
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
    /// Order of the Taylor polynomials, 1 or more
    #[arg(
        long,
        hide_short_help = true,
        help_heading = "Model",
        default_value_t = 1,
        value_name = "P"
    )]
    pub order: u32,
    /// Expansion point: n positions in rad, or also n velocities in rad/s [default: 0]
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
    /// File with a linear system and its outputs, instead of a robot
    #[arg(
        long,
        help_heading = "Model",
        value_name = "FILE",
        conflicts_with_all = [
            "robot", "lock", "abstraction", "expansion", "paper_model", "order", "SetArguments",
            "horizon", "fit", "pull", "resume", "certificate", "report"
        ]
    )]
    pub system: Option<PathBuf>,
    #[command(flatten)]
    pub data: DataArguments,
    /// Cut recordings, or logs as they are, into windows of this length, above 0 s, each a suite of
    /// its own
    #[arg(long, help_heading = "Data", value_name = "SECONDS", value_parser = seconds)]
    #[arg(allow_negative_numbers = true, conflicts_with = "until")]
    pub horizon: Option<f64>,
    /// Fit these parameters of the nominal model, separated by commas
    #[arg(
        long,
        help_heading = "Fit",
        value_name = "GROUP,..",
        value_delimiter = ',',
        value_parser = choice::<Group>(GROUPS),
        conflicts_with = "abstraction"
    )]
    pub fit: Vec<Group>,
    /// Weight of the pull toward the identified values, from 0 to 1 [default: chosen by leaving one
    /// motion out]
    #[arg(
        long,
        hide_short_help = true,
        help_heading = "Fit",
        value_name = "WEIGHT",
        requires = "fit",
        allow_hyphen_values = true
    )]
    pub pull: Option<f64>,
    #[command(flatten)]
    pub sets: SetArguments,
    /// Save the progress of a long search to this file, and continue from it
    #[arg(long, hide_short_help = true, help_heading = "Method", value_name = "FILE")]
    pub resume: Option<PathBuf>,
    /// Write the model to this JSON file
    #[arg(long, help_heading = "Output", value_name = "FILE")]
    pub out: Option<PathBuf>,
    /// Write what another program needs to prove that each point lies in the set, for --notion
    /// exact and phase-plane, as lines of JSON
    #[arg(long, hide_short_help = true, help_heading = "Output", value_name = "FILE")]
    pub certificate: Option<PathBuf>,
    /// Write an HTML page and its figures to this folder
    #[arg(long, help_heading = "Output", value_name = "FOLDER")]
    pub report: Option<PathBuf>,
}

pub(crate) const GROUPS: Choices = &[
    ("inertia", "motor inertias and densities of links"),
    ("viscous", "viscous friction"),
    ("cubic", "quadratic and cubic viscous friction"),
    ("coulomb", "Coulomb friction"),
    ("warm-up", "friction that changes with temperatures, or from run to run"),
    ("payload", "a point mass at the last link's frame"),
];
