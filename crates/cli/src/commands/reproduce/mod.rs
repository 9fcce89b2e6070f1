//! `reachtube reproduce`: tables and figures of the paper, and how often bounds for the next motion
//! hold.

mod all;
mod coverage;
mod figure;
mod table1;
mod table2;
mod table3;

use clap::Subcommand;

use crate::error::Result;
use crate::outcome::Outcome;

const HELP: &str = "\
Examples:
  reachtube reproduce all --out paper
      every table and figure, on one page
  reachtube reproduce table1";

/// Reproduce tables and figures of the paper, and test the bounds for the next motion
#[derive(Debug, Subcommand)]
#[command(after_help = HELP)]
pub(crate) enum ReproduceCommand {
    All(all::Arguments),
    Table1(table1::Arguments),
    Table2(table2::Arguments),
    Table3(table3::Arguments),
    /// Fig. 1: recordings of the joint that spreads most in the reachable set
    Fig1(figure::Arguments),
    /// Fig. 2: one input moves the robot and the model
    Fig2(figure::Arguments),
    /// Fig. 3: the points of a motion at which the open loop begins
    Fig3(figure::Arguments),
    /// Fig. 4: the reachable sets of both cases of Table II, with the recordings of a suite
    Fig4(figure::Arguments),
    /// Fig. 5: the fits of Coulomb and viscous friction, of every joint
    Fig5(figure::Arguments),
    Coverage(coverage::Arguments),
}

/// Runs what is reproduced.
pub(crate) fn run(command: &ReproduceCommand, json: bool) -> Result<Outcome> {
    match command {
        ReproduceCommand::All(args) => all::run(args, json),
        ReproduceCommand::Table1(args) => table1::run(args, json),
        ReproduceCommand::Table2(args) => table2::run(args, json),
        ReproduceCommand::Table3(args) => table3::run(args, json),
        ReproduceCommand::Fig1(args) => figure::run(1, args, json),
        ReproduceCommand::Fig2(args) => figure::run(2, args, json),
        ReproduceCommand::Fig3(args) => figure::run(3, args, json),
        ReproduceCommand::Fig4(args) => figure::run(4, args, json),
        ReproduceCommand::Fig5(args) => figure::run(5, args, json),
        ReproduceCommand::Coverage(args) => coverage::run(args, json),
    }
}
