//! `reachtube campaign`: recordings of a whole experiment on a virtual robot.

use std::path::PathBuf;

use clap::Args;
use reachtube::campaign::{CampaignOptions, RecordedCampaign, record};
use reachtube_robot::Robot;

use crate::error::Result;
use crate::option_values::seconds;
use crate::outcome::Outcome;
use crate::output;
use crate::progress::Progress;
use crate::virtual_robot_arguments::VirtualRobotArguments;

const HELP: &str = "\
Examples:
  reachtube campaign --out campaign
      record the paper's experiment: 152 suites of 15 runs, and recordings to identify with
  reachtube campaign --out small --motions 4 --runs 5 --rest 100 --parameters robot.toml
      record a smaller one, with parameters of the virtual robot such as payload_mass = 0.5

Then, in the folder: reachtube conform --robot lwa4p --data . --torque compensated

Its README.md has all commands. A campaign that was stopped goes on when it is started again.";

/// Record a whole experiment on a virtual robot, as in the paper
///
/// The folder receives test suites of random motions, static poses, slow motions of single joints,
/// and exciting motions. No file is overwritten.
#[derive(Debug, Args)]
#[command(after_help = HELP)]
pub(crate) struct Arguments {
    /// Folder for the recordings
    #[arg(long, value_name = "FOLDER")]
    pub out: PathBuf,
    /// Seed of the random numbers
    #[arg(long, default_value_t = 1)]
    pub seed: u64,
    /// Random point-to-point motions
    #[arg(long, default_value_t = 38, value_name = "COUNT")]
    pub motions: usize,
    /// Starting points in each motion; each gives a test suite
    #[arg(long, default_value_t = 4, value_name = "COUNT")]
    pub start_points: usize,
    /// Runs of each suite
    #[arg(long, default_value_t = 15, value_name = "COUNT")]
    pub runs: usize,
    /// Duration of each point-to-point motion, s [default: as a random speed gives]
    #[arg(long, hide_short_help = true, value_name = "SECONDS", value_parser = seconds)]
    pub duration: Option<f64>,
    /// Longest duration of a run, s
    #[arg(long, hide_short_help = true, default_value_t = 5.0, value_name = "SECONDS")]
    pub longest: f64,
    /// Poses at rest, for gravity
    #[arg(long, hide_short_help = true, default_value_t = 1000, value_name = "COUNT")]
    pub rest: usize,
    /// Recordings of slow motions for each joint
    #[arg(long, hide_short_help = true, default_value_t = 6, value_name = "COUNT")]
    pub one_joint: usize,
    /// Exciting motions
    #[arg(long, hide_short_help = true, default_value_t = 6, value_name = "COUNT")]
    pub excitation: usize,
    /// Exciting motions to validate with
    #[arg(long, hide_short_help = true, default_value_t = 2, value_name = "COUNT")]
    pub validation: usize,
    #[command(flatten)]
    pub robot: VirtualRobotArguments,
}

pub(crate) fn run(args: &Arguments, json: bool) -> Result<Outcome> {
    let bar = Progress::of("recording");
    let progress = |done: usize, total: usize| bar.show(done, total);
    let recorded = record(&Robot::lwa4p(), &options(args)?, &args.out, &progress)?;
    drop(bar);
    output::show(json, &recorded, || summary(args, &recorded))?;
    Ok(Outcome::Done)
}

fn options(args: &Arguments) -> Result<CampaignOptions> {
    Ok(CampaignOptions {
        seed: args.seed,
        motions: args.motions,
        start_points: args.start_points,
        runs: args.runs,
        duration: args.duration,
        longest: args.longest,
        rest: args.rest,
        one_joint: args.one_joint,
        excitation: args.excitation,
        validation: args.validation,
        robot: args.robot.parameters()?,
        ..CampaignOptions::default()
    })
}

fn summary(args: &Arguments, recorded: &RecordedCampaign) -> String {
    let RecordedCampaign { suites, runs, recordings, kept, bytes, .. } = recorded;
    let kept = match kept {
        0 => String::new(),
        kept => format!(", {kept} of them by an earlier start"),
    };
    format!(
        "recorded {runs} runs in {suites} suites and {} recordings to identify with{kept}: \
         {:.0} MB in {}\nREADME.md there says what each file is, and what to type\n",
        recordings - runs,
        *bytes as f64 * 1e-6,
        args.out.display()
    )
}
