//! What the command line looks like.

use std::path::PathBuf;

use clap::builder::{PossibleValuesParser, TypedValueParser};
use clap::{Args, Parser, Subcommand};
use reachtube::abstraction::ModelKind;
use reachtube::conform::{Centre, Method, NominalStart, States};
use reachtube::recordings::{GapLimit, Torque};
use reachtube_reach::Disturbance;
use serde::de::DeserializeOwned;

/// Reachset-conformant models of robots: from recordings to a simple model and the smallest
/// uncertainty sets for which every recording lies in the interval hull of the model's reachable
/// set, proved with directed rounding.
#[derive(Debug, Parser)]
#[command(name = "reachtube", version, after_help = MAIN_HELP)]
pub struct Cli {
    #[command(subcommand)]
    pub command: Command,
    /// Print the result as JSON on standard output
    #[arg(long, global = true)]
    pub json: bool,
}

const MAIN_HELP: &str = "\
Examples:
  reachtube demo --out demo                                   the whole job on a virtual arm
  reachtube inspect --data recordings                         what is in this data set
  reachtube identify --robot arm.urdf --dynamic a.csv b.csv --validate c.csv --out arm.toml
  reachtube abstract --robot lwa4p --model 2 --order 5         a polynomial model of its forward dynamics
  reachtube conform --robot lwa4p --data recordings --suites A,B --torque compensated --out model.json
  reachtube check --model model.json --data recordings --suites C --torque compensated
  reachtube report --model model.json --data recordings --suites A,B --torque compensated --out report
  reachtube reproduce table1                                  the models in simulation, beside the paper's numbers

Exit codes: 0 conformant (or done), 1 not conformant, 2 error.
Results go to standard output, everything else to standard error.";

#[derive(Debug, Subcommand)]
pub enum Command {
    /// Record, identify, check and report a virtual arm
    #[command(
        after_help = "Example:\n  reachtube demo --out demo    then open demo/report/report.html"
    )]
    Demo(DemoArgs),
    /// Say what a robot's description was understood as
    #[command(subcommand)]
    Robot(RobotCommand),
    /// Say what is in a data set
    #[command(after_help = "Example:\n  reachtube inspect --data recordings --json")]
    Inspect(InspectArgs),
    /// Make a simple model of a robot's forward dynamics: linear or polynomial, models 1, 2 and 3
    /// of the paper
    #[command(after_help = ABSTRACT_HELP)]
    Abstract(AbstractArgs),
    /// Design a motion that shows a robot's parameters, within its joint limits
    #[command(
        after_help = "Example:\n  reachtube excite --robot arm.urdf --period 20 --acceleration 4 --out excitation.csv\n\nOnly joint limits are looked at: check for collisions."
    )]
    Excite(ExciteArgs),
    /// Find a robot's gravity, friction and inertia from its recordings
    #[command(after_help = IDENTIFY_HELP)]
    Identify(IdentifyArgs),
    /// Filter recordings, cut them into windows, and write them as test suites
    #[command(
        after_help = "Example:\n  reachtube prepare --robot arm.toml --logs repeated --repeats --window 1 --cut-off 6 --out windows"
    )]
    Prepare(PrepareArgs),
    /// Find the smallest sets for which a model encloses every recording, and prove it
    #[command(after_help = CONFORM_HELP)]
    Conform(ConformArgs),
    /// Check other recordings against a model
    #[command(
        after_help = "Example:\n  reachtube check --model model.json --data recordings --suites C,F --torque compensated\n\nExit code 1 and a witness (suite, run, time, joint, excess) when a recording leaves the reachable set."
    )]
    Check(ModelArgs),
    /// Compute the reachable set of a model over recorded suites, at samples and between them
    #[command(
        after_help = "Example:\n  reachtube reach --model model.json --data recordings --suites A --torque compensated --out reach\n\nWrites A.csv (at samples), A_tube.csv (over each step, outer) and A_*.svg into the folder."
    )]
    Reach(ReachArgs),
    /// Draw the page and figures of a model over recordings
    #[command(
        after_help = "Example:\n  reachtube report --model model.json --data recordings --torque compensated --out report\n\nWrites report.html (works offline) and an SVG for each figure into the folder."
    )]
    Report(ReportArgs),
    /// Make a table of the paper again
    #[command(subcommand)]
    Reproduce(ReproduceCommand),
}

const ABSTRACT_HELP: &str = "\
Examples:
  reachtube abstract --robot lwa4p --model 2 --order 5 --out model2.json
  reachtube abstract --robot lwa4p --model 1 --order 1 --at 0,0.5,0,0,0,0 --out model1.json
  reachtube abstract --robot lwa4p --model 3 --order 3 --box 0.2,0.3,2    with a proved bound of what is left out

Model 1: M(q_a)^-1 (u - tau_v(qd)); model 2: also Coriolis terms, polynomial in sin q and cos q; model 3: the Taylor polynomial of the whole forward dynamics.
`conform --abstraction FILE` finds the uncertainty sets.";

const CONFORM_HELP: &str = "\
Examples:
  reachtube conform --robot lwa4p --data recordings --suites A,B,D,E --torque compensated --out model.json
  reachtube conform --robot arm.toml --data recordings --torque motor --disturbance measurable --report report
  reachtube conform --robot lwa4p --data recordings --torque compensated --centre origin --disturbance constant
                                                              the settings of Liu and Althoff (2018)
  reachtube conform --robot lwa4p --model 2 --order 5 --data recordings --torque compensated --resume search.json
Exit codes: 0 conformant and proved, 1 not proved conformant, 2 error.";

const IDENTIFY_HELP: &str = "\
Examples:
  reachtube identify --robot arm.urdf --static poses --friction slow --dynamic a.csv b.csv --validate c.csv --out arm.toml
  reachtube identify --settings arm-identify.toml --report report
  reachtube identify --robot panda.toml --dynamic excitation --link-torque --cut-off 6

A settings file holds all of it, see docs/identify.md; what is given on the command line counts more.";

#[derive(Debug, Subcommand)]
pub enum RobotCommand {
    /// Print geometry, inertia, friction and M(q_a) of a robot; refuse what is no physical robot
    #[command(
        after_help = "Example:\n  reachtube robot show arm.toml\n  reachtube robot show lwa4p --at 0,0.5,0,0,0,0"
    )]
    Show(RobotShowArgs),
}

#[derive(Debug, Args)]
pub struct RobotShowArgs {
    /// An embedded robot (lwa4p), or a TOML or URDF file
    pub robot: String,
    /// Positions q_a at which M is printed, rad, separated by commas [default: 0]
    #[arg(long, value_delimiter = ',', allow_hyphen_values = true)]
    pub at: Vec<f64>,
}

#[derive(Debug, Subcommand)]
pub enum ReproduceCommand {
    /// Table I: the velocity error of models 1, 2 and 3 in simulation, against forward dynamics by
    /// Featherstone's algorithm
    #[command(
        after_help = "Example:\n  reachtube reproduce table1 --motions 50 --seed 1 --out table1.csv\n\nThe paper's trajectories are unpublished: what can agree is the size and the order of the numbers."
    )]
    Table1(Table1Args),
}

#[derive(Debug, Args)]
pub struct Table1Args {
    /// An embedded robot (lwa4p) or a TOML file
    #[arg(long, default_value = "lwa4p")]
    pub robot: String,
    /// Random motions; each is made slowly and fast
    #[arg(long, default_value_t = 50)]
    pub motions: usize,
    /// Seed of the motions
    #[arg(long, default_value_t = 1)]
    pub seed: u64,
    /// Orders p of the models, separated by commas
    #[arg(long, value_delimiter = ',', default_value = "1,3,5,7", value_name = "P,..")]
    pub orders: Vec<u32>,
    /// Leave out model 3 at higher orders than this
    #[arg(long, default_value_t = 5, value_name = "P")]
    pub model3_up_to: u32,
    /// Keep motions this close to the expansion point q = 0, rad
    #[arg(long, default_value_t = std::f64::consts::FRAC_PI_2, value_name = "RAD", allow_negative_numbers = true)]
    pub range: f64,
    /// Write the error of each motion to this CSV file
    #[arg(long)]
    pub out: Option<PathBuf>,
}

#[derive(Debug, Args)]
pub struct AbstractArgs {
    /// An embedded robot (lwa4p), or a TOML or URDF file
    #[arg(long)]
    pub robot: String,
    /// Which of the paper's models
    #[arg(long, default_value = "1", value_parser = word_of_number::<ModelKind>(&["1", "2", "3"]))]
    pub model: ModelKind,
    /// Order p of the Taylor polynomials
    #[arg(long, default_value_t = 1, value_name = "P")]
    pub order: u32,
    /// Expansion point: n positions (rad), also n velocities (rad/s), also n inputs (N m),
    /// separated by commas [default: 0]
    #[arg(long, value_delimiter = ',', allow_hyphen_values = true, value_name = "Q,..")]
    pub at: Vec<f64>,
    /// Bound what the model leaves out over a box about the expansion point: radii of positions
    /// (rad), velocities (rad/s) and inputs (N m), 3 or 3n numbers
    #[arg(long = "box", value_delimiter = ',', allow_hyphen_values = true, value_name = "Q,QD,U")]
    pub operating_box: Vec<f64>,
    /// Print the polynomials themselves, a line a joint, in place of the summary
    #[arg(long, conflicts_with = "json")]
    pub print: bool,
    /// Boxes that the bound may cut the operating box into: more take longer and bound more tightly
    /// [default: 16 to 2000, by the model's size]
    #[arg(long, value_name = "COUNT")]
    pub most_boxes: Option<usize>,
    /// Write the model to this file
    #[arg(long)]
    pub out: Option<PathBuf>,
}

#[derive(Debug, Args)]
pub struct DemoArgs {
    /// Folder for recordings, model and report
    #[arg(long, default_value = "reachtube-demo")]
    pub out: PathBuf,
    /// Seed of the virtual arm
    #[arg(long, default_value_t = 1)]
    pub seed: u64,
}

#[derive(Debug, Args)]
pub struct IdentifyArgs {
    /// An embedded robot (lwa4p), a TOML or a URDF file
    #[arg(long)]
    pub robot: Option<String>,
    /// A TOML file with all settings; its paths are relative to its folder
    #[arg(long, value_name = "FILE")]
    pub settings: Option<PathBuf>,
    /// Recordings of poses at rest: CSV files or folders
    #[arg(long = "static", value_name = "PATH", num_args = 1..)]
    pub rest: Vec<PathBuf>,
    /// Recordings of one slow joint at a time
    #[arg(long, value_name = "PATH", num_args = 1..)]
    pub friction: Vec<PathBuf>,
    /// Recordings of exciting motions
    #[arg(long, value_name = "PATH", num_args = 1..)]
    pub dynamic: Vec<PathBuf>,
    /// Recordings kept back
    #[arg(long, value_name = "PATH", num_args = 1..)]
    pub validate: Vec<PathBuf>,
    /// Cut-off of the low-pass, Hz [default: chosen from the recordings]
    #[arg(long, value_name = "HZ")]
    pub cut_off: Option<f64>,
    /// What the recorded torques are multiplied with, joint by joint (for currents: N m/A)
    #[arg(long, value_delimiter = ',', allow_hyphen_values = true)]
    pub gains: Vec<f64>,
    /// The torque is measured behind the gear: motor inertia is not in it
    #[arg(long)]
    pub link_torque: bool,
    /// Write the robot to this TOML file
    #[arg(long, value_name = "FILE")]
    pub out: Option<PathBuf>,
    /// Write the robot's URDF with the new values to this file
    #[arg(long, value_name = "FILE")]
    pub urdf: Option<PathBuf>,
    /// Write the page and figures into this folder
    #[arg(long, value_name = "FOLDER")]
    pub report: Option<PathBuf>,
}

#[derive(Debug, Args)]
pub struct ExciteArgs {
    /// An embedded robot (lwa4p), a TOML or a URDF file
    #[arg(long)]
    pub robot: String,
    /// Period of the motion, s
    #[arg(long, value_name = "SECONDS", value_parser = seconds, default_value = "10")]
    pub period: f64,
    /// Harmonics of each joint
    #[arg(long, default_value_t = 5)]
    pub harmonics: usize,
    /// Highest acceleration, rad/s^2: one for all joints, or one each
    #[arg(long, value_delimiter = ',')]
    pub acceleration: Vec<f64>,
    /// Highest speed of joints without a limit, rad/s
    #[arg(long, default_value_t = 1.0)]
    pub speed: f64,
    /// Make the condition number smallest instead of the determinant of the information largest
    #[arg(long)]
    pub condition: bool,
    /// Samples a second
    #[arg(long, value_name = "HZ", value_parser = seconds, default_value = "100")]
    pub rate: f64,
    /// Seed of the search
    #[arg(long, default_value_t = 1)]
    pub seed: u64,
    /// CSV file for the motion: t, q, qd, qdd
    #[arg(long, value_name = "FILE")]
    pub out: PathBuf,
}

#[derive(Debug, Args)]
pub struct PrepareArgs {
    /// An embedded robot (lwa4p), a TOML or a URDF file
    #[arg(long)]
    pub robot: String,
    /// Recordings: CSV files or folders
    #[arg(long, value_name = "PATH", num_args = 1.., required = true)]
    pub logs: Vec<PathBuf>,
    /// Logs whose names differ after the last _ only are repeats: align them, and put each window
    /// of all of them into one suite
    #[arg(long)]
    pub repeats: bool,
    /// Length of the windows, s [default: whole recordings]
    #[arg(long, value_name = "SECONDS", value_parser = seconds)]
    pub window: Option<f64>,
    /// Cut-off of the low-pass, Hz [default: chosen from the recordings]
    #[arg(long, value_name = "HZ", value_parser = seconds)]
    pub cut_off: Option<f64>,
    /// What the recorded torques are multiplied with, joint by joint
    #[arg(long, value_delimiter = ',', allow_hyphen_values = true)]
    pub gains: Vec<f64>,
    /// The robot's joints by name in the order of the columns [default: the robot's order]
    #[arg(long, value_delimiter = ',')]
    pub joints: Vec<String>,
    /// Accept gaps up to this many seconds
    #[arg(long, value_name = "SECONDS", value_parser = seconds)]
    pub max_gap: Option<f64>,
    /// Folder for the recordings and runs.csv
    #[arg(long)]
    pub out: PathBuf,
}

#[derive(Debug, Args)]
pub struct InspectArgs {
    /// Folder with runs.csv and the recordings
    #[arg(long)]
    pub data: PathBuf,
    /// Accept gaps up to this many seconds
    #[arg(long, value_name = "SECONDS", value_parser = seconds, allow_negative_numbers = true)]
    pub max_gap: Option<f64>,
}

/// Which recordings, and what their torques are.
#[derive(Debug, Args)]
pub struct DataArgs {
    /// Folder with runs.csv and the recordings
    #[arg(long)]
    pub data: PathBuf,
    /// Test suites, separated by commas [default: all]
    #[arg(long, value_delimiter = ',', value_parser = trimmed)]
    pub suites: Vec<String>,
    /// What the columns tau are: the input u itself (gravity and Coulomb friction taken off), motor
    /// torque, or link-side torque
    #[arg(long, value_parser = word_of::<Torque>(&["compensated", "motor", "link"]))]
    pub torque: Torque,
    /// Use samples up to this many seconds after the first
    #[arg(long, value_name = "SECONDS", value_parser = seconds, allow_negative_numbers = true)]
    pub until: Option<f64>,
    /// Accept gaps up to this many seconds, with the input held over them
    #[arg(long, value_name = "SECONDS", value_parser = seconds, allow_negative_numbers = true)]
    pub max_gap: Option<f64>,
}

#[derive(Debug, Args)]
pub struct ConformArgs {
    /// An embedded robot (lwa4p), or a TOML or URDF file
    #[arg(long, required_unless_present = "abstraction")]
    pub robot: Option<String>,
    /// Which of the paper's models of the robot
    #[arg(long, default_value = "1", value_parser = word_of_number::<ModelKind>(&["1", "2", "3"]))]
    pub model: ModelKind,
    /// Order p of the model
    #[arg(long, default_value_t = 1, value_name = "P")]
    pub order: u32,
    /// A model that `abstract --out` wrote, in place of a robot
    #[arg(long, value_name = "FILE", conflicts_with_all = ["robot", "expansion", "model", "order"])]
    pub abstraction: Option<PathBuf>,
    /// How the sets are found: by linear programs, for a model that is not linear one after the
    /// other; or by bisection of one radius after the other, the paper's way, as a baseline
    #[arg(long, default_value = "program", value_parser = word_of::<Method>(&["program", "bisection"]))]
    pub method: Method,
    /// Keep what is finished of a long search in this file, and go on from it where it is there
    #[arg(long, value_name = "FILE")]
    pub resume: Option<PathBuf>,
    #[command(flatten)]
    pub data: DataArgs,
    /// How the disturbance may change in time
    #[arg(long, default_value = "sample", value_parser = word_of::<Disturbance>(&["constant", "sample", "measurable"]))]
    pub disturbance: Disturbance,
    /// What the centres of the sets may be: anything, such that the set contains 0, or 0
    #[arg(long, default_value = "free", value_parser = word_of::<Centre>(&["free", "origin", "zero"]))]
    pub centre: Centre,
    /// Which states must be enclosed
    #[arg(long, default_value = "all", value_parser = word_of::<States>(&["all", "positions"]))]
    pub states: States,
    /// Weights of the states in the cost: unit, spread (one over the largest deviation), or 2, or
    /// 2n numbers
    #[arg(
        long,
        default_value = "unit",
        value_name = "unit|spread|W,W,..",
        allow_hyphen_values = true
    )]
    pub weights: String,
    /// Measurement noise: none, free (found by the program), or its radius in rad and rad/s: 2 or
    /// 2n numbers
    #[arg(
        long,
        default_value = "none",
        value_name = "none|free|R,R,..",
        allow_hyphen_values = true
    )]
    pub noise: String,
    /// Look for motions of the model itself that come within so many rad and rad/s of each
    /// recording: 2 numbers, or none [default: 0.001,0.01 for a model that is not linear]
    #[arg(long, value_name = "none|Q,QD")]
    pub explain: Option<String>,
    /// Where nominal solutions start: at the mean of the runs' first states, or at each run's own
    #[arg(long, default_value = "mean", value_parser = word_of::<NominalStart>(&["mean", "own"]))]
    pub nominal: NominalStart,
    /// Expansion point: n positions, or n positions and n velocities, separated by commas [default:
    /// 0]
    #[arg(long, value_delimiter = ',', allow_hyphen_values = true)]
    pub expansion: Vec<f64>,
    /// Write the model to this file
    #[arg(long)]
    pub out: Option<PathBuf>,
    /// Write the page and figures into this folder
    #[arg(long, value_name = "FOLDER")]
    pub report: Option<PathBuf>,
}

#[derive(Debug, Args)]
pub struct ModelArgs {
    /// A file that `conform --out` wrote
    #[arg(long)]
    pub model: PathBuf,
    #[command(flatten)]
    pub data: DataArgs,
}

#[derive(Debug, Args)]
pub struct ReachArgs {
    #[command(flatten)]
    pub model: ModelArgs,
    /// Folder for the CSV files and figures
    #[arg(long, default_value = "reach")]
    pub out: PathBuf,
}

#[derive(Debug, Args)]
pub struct ReportArgs {
    #[command(flatten)]
    pub model: ModelArgs,
    /// Folder for the page and figures
    #[arg(long, default_value = "report")]
    pub out: PathBuf,
}

/// The limit that `--max-gap` asks for.
pub fn gap_limit(max_gap: Option<f64>) -> GapLimit {
    max_gap.map_or(GapLimit::Usual, GapLimit::Seconds)
}

fn trimmed(text: &str) -> Result<String, std::convert::Infallible> {
    Ok(text.trim().into())
}

fn seconds(text: &str) -> Result<f64, String> {
    let value = text.parse::<f64>().ok().filter(|value| *value > 0.0 && value.is_finite());
    value.ok_or_else(|| "give a number of seconds above 0".into())
}

/// A parser for a setting that is one of a few numbers.
fn word_of_number<T>(words: &'static [&'static str]) -> impl TypedValueParser<Value = T>
where
    T: DeserializeOwned + Clone + Send + Sync + 'static,
{
    PossibleValuesParser::new(words).try_map(|word| serde_json::from_str::<T>(&word))
}

/// A parser for a setting by the word that model files have for it.
fn word_of<T>(words: &'static [&'static str]) -> impl TypedValueParser<Value = T>
where
    T: DeserializeOwned + Clone + Send + Sync + 'static,
{
    PossibleValuesParser::new(words).try_map(|word| serde_json::from_value::<T>(word.into()))
}
