//! Options of `reachtube export`, and the way it writes files.

use reachtube::arm::{self, OfArm};
use std::path::PathBuf;

use clap::Args;
use reachtube::Robot;
use reachtube::conform::Keep;
use reachtube::export::{ExportFile, InputForm, Tool};
use serde::Deserialize;

use crate::data_arguments::DataArguments;
use crate::error::{Error, Result};
use crate::lock_arguments::LockArguments;
use crate::opened::OpenedCheck;
use crate::option_values::{Choices, choice, part, seconds, trimmed};
use crate::output;

/// An export has neither a model nor a robot that it could take.
const NO_MODEL: &str = "only mjcf and urdf take --robot; name a model that `model` or `conform` \
                        wrote with --model";

const BOTH: &str = "--model and --robot are both given, but a model has its robot; only a model of \
                    an arm under its controller, with --to moveit or sara-shield, needs both";

const HELP: &str = "\
Tools, and what each supports:
  cora        every model; the recorded input at equally spaced samples, U changing at any time
  flowstar    affine models as a model file, others as a C++ program that steps through samples
  spaceex     affine models; a polynomial one as a carrier for programs that read the format
  xspeed      affine models without a recorded input
  hylaa       affine models without a recorded input, at equally spaced samples; U held over each
  juliareach  affine models without a recorded input
  mjcf, urdf  the robot; of its friction a viscous and a Coulomb coefficient, and for MuJoCo 4 a
              cubic one. urdf has no motor inertia; --update changes a URDF that is there
  sara-shield the radius by which the safety shield SaRA must grow each link, proved; limits in
              its file that --update names, cut to what the motions reach
  ros2-control
              tolerances of the trajectory controller, of a model of the arm under its controller
  moveit      paddings of the links of a URDF, of a model of the arm under its controller
Unsupported models are refused. The first lines of each file state what the tool computes.

Examples:
  reachtube export --model model.json --to cora --data recordings --suites A --out cora
  reachtube export --model model.json --to hylaa --data recordings --suites A --out hylaa
  reachtube export --robot arm.toml --to mjcf --out robot
  reachtube export --robot identified.toml --to urdf --update arm.urdf --out robot
  reachtube export --model model.json --to sara-shield --data recordings --suites A --until 0.2 \\
    --update robot_parameters_schunk.yaml --out shield
  reachtube export --model arm/model.json --to ros2-control --out tolerances
  reachtube export --model arm/model.json --to moveit --robot arm.urdf --speed 0.5 --out padding

Each suite, or run with a nominal motion of its own, gets a folder, which also holds our bounds
(bounds.csv at samples, tube.csv between them) and the input (inputs.csv). docs/export.md says how
each tool runs its file.";

const TARGETS: Choices = &[
    ("cora", "CORA 2024 or later"),
    ("spaceex", "SpaceEx"),
    ("flowstar", "Flow*, a model file or a C++ program"),
    ("hylaa", "HyLAA 2"),
    ("xspeed", "XSpeed"),
    ("juliareach", "ReachabilityAnalysis.jl"),
    ("mjcf", "MuJoCo, the robot"),
    ("urdf", "the robot"),
    ("sara-shield", "SaRA shield"),
    ("ros2-control", "tolerances of joint_trajectory_controller"),
    ("moveit", "paddings of links for MoveIt"),
];

const FORMS: Choices = &[
    ("recorded", "held from sample to sample, plus U"),
    ("deviation", "only U, for affine models"),
    ("range", "any input in the box of all recorded inputs plus U"),
];

/// Write a model over recorded inputs, or its robot, as other tools read it
#[derive(Debug, Args)]
#[command(after_help = HELP)]
pub(crate) struct Arguments {
    /// Model file that `model` or `conform` wrote
    #[arg(long, value_name = "FILE", required_unless_present = "robot")]
    pub model: Option<PathBuf>,
    /// Robot in place of a model, for mjcf and urdf; for moveit and sara-shield the robot
    /// of a model of an arm under its controller
    #[arg(long, value_name = "ROBOT")]
    pub robot: Option<String>,
    /// Part of the recorded speeds that plans reach, for moveit
    #[arg(long, value_name = "PART", value_parser = part, hide_short_help = true)]
    pub speed: Option<f64>,
    #[command(flatten)]
    pub lock: LockArguments,
    /// The URDF, or robot_parameters and trajectory_parameters of the shield, to change; all other
    /// text stays as it is
    #[arg(long, value_name = "FILE", hide_short_help = true)]
    pub update: Vec<PathBuf>,
    /// The links' capsules, for sara-shield: a TOML or URDF file [default: the embedded robot's]
    #[arg(long, value_name = "FILE", hide_short_help = true)]
    pub capsules: Option<PathBuf>,
    /// What to write
    #[arg(long, value_name = "TOOL", value_parser = choice::<Target>(TARGETS))]
    pub to: Target,
    /// Folder for the files
    #[arg(long, value_name = "FOLDER")]
    pub out: PathBuf,
    /// How the recorded input enters [default: the tightest form that the tool can mean]
    #[arg(long, value_parser = choice::<InputForm>(FORMS))]
    pub input: Option<InputForm>,
    /// Folder with runs.csv and the recordings
    #[arg(long, value_name = "FOLDER", help_heading = "Data")]
    pub data: Option<PathBuf>,
    /// Test suites to use, separated by commas, such as A*,B? [default: all]
    #[arg(long, value_name = "NAME,..", value_delimiter = ',', value_parser = trimmed)]
    #[arg(help_heading = "Data")]
    pub suites: Vec<String>,
    /// Time after the first sample up to which samples are used, above 0 s [default: all]
    #[arg(long, hide_short_help = true)]
    #[arg(value_name = "SECONDS", value_parser = seconds, allow_negative_numbers = true)]
    #[arg(help_heading = "Data")]
    pub until: Option<f64>,
    /// Longest time between two samples, above 0 s; the input is held over it [default: 1.9 times
    /// the usual sample time, 10 times where sample times jitter]
    #[arg(long, hide_short_help = true)]
    #[arg(value_name = "SECONDS", value_parser = seconds, allow_negative_numbers = true)]
    #[arg(help_heading = "Data")]
    pub max_gap: Option<f64>,
}

/// The files to write.
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum Target {
    /// The robot for MuJoCo.
    Mjcf,
    /// The robot as URDF.
    Urdf,
    /// The files of the shield SaRA.
    #[serde(rename = "sara-shield")]
    SaraShield,
    /// The tolerances of ROS 2's trajectory controller.
    #[serde(rename = "ros2-control")]
    Ros2Control,
    /// The paddings of links for MoveIt.
    #[serde(rename = "moveit")]
    Moveit,
    /// A model for a tool.
    #[serde(untagged)]
    Tool(Tool),
}

impl Target {
    fn name(self) -> String {
        match self {
            Self::Mjcf => "MuJoCo".into(),
            Self::Urdf => "URDF".into(),
            Self::SaraShield => "the SaRA shield".into(),
            Self::Ros2Control => "ros2_control".into(),
            Self::Moveit => "MoveIt".into(),
            Self::Tool(tool) => tool.to_string(),
        }
    }
}

/// Refuses options that have no effect on what is written.
pub(super) fn refuse_unused(args: &Arguments) -> Result<()> {
    let to = args.to;
    let has_recordings = matches!(to, Target::Tool(_) | Target::SaraShield);
    // The joints of a URDF that is changed may be locked in the model.
    let is_robot = matches!(to, Target::Mjcf | Target::Urdf);
    let has_locks = (args.robot.is_some() && is_robot) || !args.update.is_empty();
    if args.robot.is_some()
        && args.model.is_some()
        && !matches!(to, Target::Moveit | Target::SaraShield)
    {
        return Err(Error::setting(BOTH));
    }
    let options = [
        ("data", args.data.is_some(), has_recordings),
        ("suites", !args.suites.is_empty(), has_recordings),
        ("until", args.until.is_some(), has_recordings),
        ("max-gap", args.max_gap.is_some(), has_recordings),
        ("input", args.input.is_some(), matches!(to, Target::Tool(_))),
        ("speed", args.speed.is_some(), matches!(to, Target::Moveit)),
        ("capsules", args.capsules.is_some(), matches!(to, Target::SaraShield)),
        ("lock", !args.lock.lock.is_empty(), has_locks && !matches!(to, Target::SaraShield)),
    ];
    match options.into_iter().find(|(_, is_given, is_used)| *is_given && !is_used) {
        Some((option, ..)) => Err(Error::setting(format!(
            "--{option} has no effect on an export to {}; leave it out",
            to.name()
        ))),
        None => Ok(()),
    }
}

/// Writes files to these paths. The tables of one case are the same for every tool, and stay.
pub(super) fn write_all<'a>(
    paths: &[PathBuf],
    files: impl Iterator<Item = &'a ExportFile>,
) -> Result<()> {
    output::write_all(paths.iter().zip(files.map(|file| file.text.as_bytes())))
}

pub(super) fn load_robot(args: &Arguments) -> Result<Robot> {
    match (&args.robot, &args.model) {
        (Some(robot), _) => args.lock.load(robot),
        (None, Some(model)) => Ok(arm::open(model)?.1.robot().clone()),
        (None, None) => Err(Error::setting(NO_MODEL)),
    }
}

/// Returns the model file of an export that needs one.
pub(super) fn model_file(args: &Arguments) -> Result<&PathBuf> {
    args.model.as_ref().ok_or_else(|| Error::setting(NO_MODEL))
}

/// Opens the model over the recordings; `tool` names what it is for.
pub(super) fn open(args: &Arguments, tool: &str) -> Result<OpenedCheck> {
    let model = model_file(args)?;
    let no_input = || {
        Error::setting(format!(
            "an export to {tool} needs the recorded input; name the recordings with --data and the \
             suites with --suites"
        ))
    };
    let data = args.data.clone().ok_or_else(no_input)?;
    let (model, setup) = arm::open(model)?;
    let data = DataArguments {
        data,
        suites: args.suites.clone(),
        torque: None,
        until: args.until,
        max_gap: args.max_gap,
    };
    let opened = OpenedCheck::with(model, setup, &data, None, Keep::Needed)?;
    opened.print_notes(&data);
    opened.warn_beyond_proof();
    Ok(opened)
}
