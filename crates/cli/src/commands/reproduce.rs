//! `reachtube reproduce`: tables of the paper, and how often bounds for the next motion hold.

use std::fmt::Write;
use std::path::PathBuf;

use clap::{Args, Subcommand};
use reachtube::abstraction::ModelKind;
use reachtube::reproduce::{
    Cell, Coverage, CoverageOptions, CoverageRow, Paper, Speed, Table1, Table1Options,
    coverage as simulate_coverage, table1 as make_table1,
};
use reachtube::write;

use crate::error::Result;
use crate::lock_arguments::LockArguments;
use crate::outcome::Outcome;
use crate::output;
use crate::progress::Progress;
use crate::table::table;
use reachtube::number::four_decimals;

/// Reproduce a table of the paper, or put the bounds for the next motion to the test
#[derive(Debug, Subcommand)]
pub enum ReproduceCommand {
    Table1(Table1Arguments),
    Coverage(CoverageArguments),
}

const TABLE1_HELP: &str = "\
Example:
  reachtube reproduce table1 --motions 50 --seed 1 --out table1.csv

The paper's trajectories are unpublished, so only the sizes and the order of the errors can agree.";

/// Table I: velocity errors of models 1, 2 and 3 in simulation
///
/// The reference is the robot's forward dynamics by Featherstone's articulated-body algorithm,
/// under the same inputs.
#[derive(Debug, Args)]
#[command(after_help = TABLE1_HELP)]
pub struct Table1Arguments {
    /// Robot: the embedded lwa4p, or a TOML or URDF file
    #[arg(long, default_value = "lwa4p")]
    pub robot: String,
    #[command(flatten)]
    pub lock: LockArguments,
    /// Number of random point-to-point motions, 1 or more; each is simulated slowly and fast
    #[arg(long, default_value_t = 50, value_name = "COUNT")]
    pub motions: usize,
    /// Seed of the motions; the same seed gives the same motions
    #[arg(long, default_value_t = 1)]
    pub seed: u64,
    /// Orders p of the models, separated by commas, each 1 or more
    #[arg(long, value_delimiter = ',', default_value = "1,3,5,7", value_name = "P,..")]
    pub orders: Vec<u32>,
    /// Highest order at which model 3 is simulated
    #[arg(long, default_value_t = 5, value_name = "P")]
    pub model3_up_to: u32,
    /// Largest distance of a joint from the expansion point q = 0, rad
    #[arg(
        long,
        default_value_t = std::f64::consts::FRAC_PI_2,
        value_name = "RAD",
        allow_negative_numbers = true
    )]
    pub range: f64,
    /// Write the error of each motion to this CSV file
    #[arg(long, value_name = "FILE")]
    pub out: Option<PathBuf>,
}

const COVERAGE_HELP: &str = "\
Example:
  reachtube reproduce coverage --campaigns 400 --seed 1

Exit codes: 0 every bound holds within three standard errors, 1 one does not, 2 error.";

/// Simulate how often the bounds for the next motion are wrong
///
/// Each campaign records random motions of a virtual arm, finds sets for them, and states bounds of
/// the probability that the next motion leaves them. 2000 further motions give the truth.
#[derive(Debug, Args)]
#[command(after_help = COVERAGE_HELP)]
pub struct CoverageArguments {
    /// Number of campaigns, 1 or more
    #[arg(long, default_value_t = 400, value_name = "COUNT")]
    pub campaigns: usize,
    /// Seed of the motions; the same seed gives the same motions
    #[arg(long, default_value_t = 1)]
    pub seed: u64,
}

/// Runs `reproduce coverage`.
pub fn coverage(args: &CoverageArguments, json: bool) -> Result<Outcome> {
    let bar = Progress::of("simulating");
    let options = CoverageOptions { campaigns: args.campaigns, seed: args.seed };
    let coverage = simulate_coverage(&options, &|done, total| bar.show(done, total))?;
    drop(bar);
    output::show(json, &coverage, || coverage_summary(&coverage))?;
    Ok(Outcome::of(coverage.rows.iter().all(CoverageRow::holds)))
}

/// Returns how often each bound was wrong, beside how often it may be.
fn coverage_summary(coverage: &Coverage) -> String {
    let Coverage { options, fitted, held_out, calibrating, next, rows } = coverage;
    let row = |row: &CoverageRow| {
        vec![
            row.statement.clone(),
            format!("{:.3}", row.mean_bound),
            format!("{:.3}", row.mean_truth),
            format!("{:.3}", row.nominal),
            format!("{:.3} ± {:.3}", row.observed, row.standard_error),
            if row.holds() { "yes".into() } else { "NO".into() },
        ]
    };
    let header = ["statement", "mean bound", "mean truth", "may be wrong", "was wrong", "holds"];
    format!(
        "{} campaigns of {fitted} random motions (seed {}), {held_out} more for the hold-out \
         bound; {calibrating} of the {fitted} calibrate the sets of the others; the truth is the \
         part of {next} further motions that leave the sets\n\n{}",
        options.campaigns,
        options.seed,
        table(&header, &rows.iter().map(row).collect::<Vec<_>>())
    )
}

/// Runs `reproduce table1`.
pub fn table1(args: &Table1Arguments, json: bool) -> Result<Outcome> {
    let robot = args.lock.load(&args.robot)?;
    robot.check_physical()?;
    if let Some(path) = &args.out {
        output::claim(path)?;
    }
    let bar = Progress::of("simulating");
    let table = make_table1(&robot, &options(args), &|done, total| bar.show(done, total))?;
    drop(bar);
    if let Some(path) = &args.out {
        write::atomically(path, |out| table.write_csv(out))?;
        output::wrote(path);
    }
    output::show(json, &table, || summary(&table))?;
    Ok(Outcome::Done)
}

fn options(args: &Table1Arguments) -> Table1Options {
    Table1Options {
        motions: args.motions,
        seed: args.seed,
        orders: args.orders.clone(),
        model3_up_to: args.model3_up_to,
        range: args.range,
    }
}

/// Returns Table I in the paper's layout.
fn summary(table1: &Table1) -> String {
    let (options, [slow, fast]) = (&table1.options, table1.durations);
    let mut text = format!(
        "Table I for {}: mean |velocity error| over time and joints [rad/s], against the \
         articulated-body algorithm\n\
         mean ± standard deviation over {} random point-to-point motions (seed {}) within {} rad \
         of 0; duration {slow:.2} s (slow) and {fast:.2} s (fast); inputs held over 4 ms\n\n",
        table1.robot,
        options.motions,
        options.seed,
        four_decimals(options.range)
    );
    let rows: Vec<_> = options
        .orders
        .iter()
        .flat_map(|order| Speed::ALL.map(|speed| row(table1, *order, speed)))
        .collect();
    let header = ["p", "speed", "model 1", "paper", "model 2", "paper", "model 3", "paper"];
    text.push_str(&table(&header, &rows));
    if options.orders.iter().any(|order| *order > options.model3_up_to) {
        let _ = writeln!(
            text,
            "\n-: not simulated; --model3-up-to {} limits the order of model 3",
            options.model3_up_to
        );
    }
    text
}

fn row(table1: &Table1, order: u32, speed: Speed) -> Vec<String> {
    let kinds = [ModelKind::One, ModelKind::Two, ModelKind::Three];
    let cells = kinds.map(|kind| cell_pair(table1.cell(kind, order, speed)));
    [order.to_string(), speed.name().into()]
        .into_iter()
        .chain(cells.into_iter().flatten())
        .collect()
}

/// Returns the simulated error and the paper's error.
fn cell_pair(cell: Option<&Cell>) -> [String; 2] {
    let Some(cell) = cell else { return ["-".into(), String::new()] };
    let spread =
        cell.spread.map(|spread| format!(" ± {}", four_decimals(spread))).unwrap_or_default();
    let simulated = match (cell.mean, cell.diverged) {
        (None, diverged) => format!("∞ ({diverged} diverged)"),
        (Some(mean), 0) => format!("{}{spread}", four_decimals(mean)),
        (Some(mean), diverged) => format!("{}{spread} ({diverged} diverged)", four_decimals(mean)),
    };
    let paper = match cell.paper {
        Some(Paper::Error(error)) => format!("{error:.4}"),
        Some(Paper::Diverged) => "∞".into(),
        None => String::new(),
    };
    [simulated, paper]
}
