//! The command line: its commands and the global options.

use clap::{CommandFactory, Parser, Subcommand};

use crate::commands::robot::{self, RobotCommand};
use crate::commands::{
    r#abstract, campaign, check, completions, conform, convert, demo, excite, export, identify,
    inspect, man, model, monitor, prepare, reach, report, reproduce, stop, verify,
};
use crate::error::Result;
use crate::global::GlobalOptions;
use crate::outcome::Outcome;

/// Robot models that provably cover your recordings
///
/// From recordings of an arm, reachtube finds a simple model and the smallest uncertainty sets for
/// which every recorded sample lies in the interval hull of the model's reachable set. It checks
/// this with directed rounding.
#[derive(Debug, Parser)]
#[command(name = "reachtube", version = VERSION, after_help = HELP, disable_help_flag = true)]
pub(crate) struct Cli {
    #[command(subcommand)]
    pub command: Command,
    #[command(flatten)]
    pub global: GlobalOptions,
}

/// The version, and the commit where the command was built from a clone.
const VERSION: &str = concat!(env!("CARGO_PKG_VERSION"), env!("REACHTUBE_COMMIT"));

const HELP: &str = "\
Examples:
  reachtube model --robot arm.urdf --data logs --torque motor --out arm
      from logs to a model, a page and a verdict
  reachtube demo --out demo
  reachtube campaign --out campaign
      record the paper's experiment on a virtual robot
  reachtube inspect --data recordings
      summarise a data set
  reachtube convert --robot arm.urdf --data run.mcap --marker /run --out recordings
      cut a robot's log into recordings
  reachtube identify --robot arm.urdf --excitation a.csv b.csv --validate c.csv --out arm.toml
      identify gravity, friction and inertia
  reachtube abstract --robot lwa4p --paper-model 2 --order 5
      make a polynomial model of the forward dynamics
  reachtube conform --robot lwa4p --data recordings --suites A,B --torque compensated \\
      --out model.json
      find the smallest uncertainty sets
  reachtube check --model model.json --data recordings --suites C
      check other recordings against the model
  reachtube report --model model.json --data recordings --out report
      write an HTML page with figures
  reachtube verify cell.toml --out cell
      decide whether the links stay clear of obstacles
  reachtube stop --model model.json --data recordings --brakes brakes.toml
      enclose how far the robot moves after a stop
  robot-driver | reachtube monitor --model model.json
      report at once when a motion leaves the sets
  reachtube reproduce --out paper
      reproduce the paper's tables and figures on a virtual robot

Exit codes: 0 conformant (or done), 1 not conformant, 2 error, 3 vacuous or undecided.

Results go to standard output; notes, warnings and errors go to standard error.";

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    Model(model::Arguments),
    Check(check::Arguments),
    Inspect(inspect::Arguments),
    Export(export::Arguments),
    Report(report::Arguments),
    Identify(identify::Arguments),
    Prepare(prepare::Arguments),
    Conform(conform::Arguments),
    Abstract(r#abstract::Arguments),
    Reach(reach::Arguments),
    Verify(verify::Arguments),
    Stop(stop::Arguments),
    Monitor(monitor::Arguments),
    Excite(excite::Arguments),
    Convert(convert::Arguments),
    Demo(demo::Arguments),
    Campaign(campaign::Arguments),
    Reproduce(reproduce::Arguments),
    #[command(subcommand)]
    Robot(RobotCommand),
    Completions(completions::Arguments),
    Man(man::Arguments),
}

/// Runs the command that the arguments name.
pub(crate) fn run(cli: &Cli) -> Result<Outcome> {
    let json = cli.global.json;
    match &cli.command {
        Command::Model(args) => model::run(args, json),
        Command::Check(args) => check::run(args, json),
        Command::Inspect(args) => inspect::run(args, json),
        Command::Export(args) => export::run(args, json),
        Command::Report(args) => report::run(args, json),
        Command::Identify(args) => identify::run(args, json),
        Command::Prepare(args) => prepare::run(args, json),
        Command::Conform(args) => conform::run(args, json),
        Command::Abstract(args) => r#abstract::run(args, json),
        Command::Reach(args) => reach::run(args, json),
        Command::Verify(args) => verify::run(args, json),
        Command::Stop(args) => stop::run(args, json),
        Command::Monitor(args) => monitor::run(args, json),
        Command::Excite(args) => excite::run(args, json),
        Command::Convert(args) => convert::run(args, json),
        Command::Demo(args) => demo::run(args, json),
        Command::Campaign(args) => campaign::run(args, json),
        Command::Reproduce(args) => reproduce::run(args, json),
        Command::Robot(RobotCommand::Show(args)) => robot::show(args, json),
        Command::Completions(args) => completions::run(args, Cli::command()),
        Command::Man(args) => man::run(args, Cli::command()),
    }
}
