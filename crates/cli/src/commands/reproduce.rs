//! `reachtube reproduce`: tables of the paper, and how often bounds for the next motion hold.

use std::fmt::Write;
use std::path::PathBuf;

use clap::{Args, Subcommand};
use reachtube::abstraction::ModelKind;
use reachtube::conform::{Notion, States};
use reachtube::reach::Disturbance;
use reachtube::reproduce::{
    Cell, Coverage, CoverageOptions, CoverageRow, Paper, Speed, Table1, Table1Options, Table2,
    Table2Options, coverage as simulate_coverage, table1 as make_table1, table2 as make_table2,
};
use reachtube::write;

use crate::error::Result;
use crate::lock_arguments::LockArguments;
use crate::option_values::{DISTURBANCES, NOTIONS, choice, trimmed};
use crate::outcome::Outcome;
use crate::output;
use crate::progress::Progress;
use crate::table::table;
use crate::verdict::notion_words;
use reachtube::number::{four_decimals, interval};

/// Reproduce a table of the paper, or put the bounds for the next motion to the test
#[derive(Debug, Subcommand)]
pub enum ReproduceCommand {
    Table1(Table1Arguments),
    Table2(Table2Arguments),
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

const TABLE2_HELP: &str = "\
Example:
  reachtube campaign --out campaign
  reachtube reproduce table2 --data campaign
  reachtube reproduce table2 --data recordings --suites A,B,D,E --notions hull,exact

The paper's recordings are not public but for four suites; `campaign` records as many on a virtual
arm, so only the sizes of the sets can agree. Where only positions have to be enclosed, X0 may take
over what U has in the paper: both let positions spread.

Exit codes: 0 every set proved conformant, 1 one is not, 2 error.";

/// Table II: the uncertainty sets of model 1 for the LWA 4P
///
/// Both halves of the table: sets that enclose positions and velocities, and sets that enclose
/// positions. The sets contain the origin, as the paper's do. Torques are compensated.
#[derive(Debug, Args)]
#[command(after_help = TABLE2_HELP)]
pub struct Table2Arguments {
    /// Folder with runs.csv and the recordings
    #[arg(long, value_name = "FOLDER")]
    pub data: PathBuf,
    /// Names of the test suites to use, separated by commas [default: all]
    #[arg(long, value_name = "NAME,..", value_delimiter = ',', value_parser = trimmed)]
    pub suites: Vec<String>,
    /// Notions of enclosure, separated by commas: hull, phase-plane, exact
    #[arg(
        long,
        value_name = "NOTION,..",
        value_delimiter = ',',
        default_value = "hull",
        value_parser = choice::<Notion>(&NOTIONS[..3])
    )]
    pub notions: Vec<Notion>,
    /// How the disturbance may change in time
    #[arg(long, default_value = "constant", value_parser = choice::<Disturbance>(DISTURBANCES))]
    pub disturbance: Disturbance,
}

/// Runs `reproduce table2`.
pub fn table2(args: &Table2Arguments, json: bool) -> Result<Outcome> {
    let options = Table2Options {
        suites: args.suites.clone(),
        notions: args.notions.clone(),
        disturbance: args.disturbance,
    };
    let bar = Progress::new();
    let table2 = make_table2(&args.data, &options, &bar)?;
    drop(bar);
    output::show(json, &table2, || table2_summary(&table2))?;
    Ok(Outcome::of(table2.cases.iter().all(|case| case.conformant)))
}

/// Returns Table II in the paper's layout, with the paper's bounds beside ours.
fn table2_summary(table2: &Table2) -> String {
    let mut text = format!(
        "Table II: uncertainty sets of model 1 (p = 1) for {} recordings in {} suites\n",
        table2.runs, table2.suites
    );
    for case in &table2.cases {
        let states = match case.states {
            States::All => "velocity conformant",
            States::Positions => "position conformant",
        };
        let proved = if case.conformant { "proved" } else { "NOT PROVED" };
        let notion = notion_words(case.notion);
        let cost = four_decimals(case.cost);
        let _ = writeln!(text, "\n{states}, {notion}: {proved}, cost {cost}\n");
        let paper = case.paper;
        let row = |joint: usize| {
            let papers = [paper.x0_q, paper.x0_qd, paper.u].map(|sets| sets[joint]);
            let pairs = case.bounds(joint).into_iter().zip(papers);
            let cells = pairs
                .flat_map(|(ours, [low, high])| [interval(ours), format!("[{low:.4}, {high:.4}]")]);
            std::iter::once(format!("joint{}", joint + 1)).chain(cells).collect()
        };
        let header = ["joint", "X0 q [rad]", "paper", "X0 qd [rad/s]", "paper", "U [N m]", "paper"];
        text.push_str(&table(&header, &(0..6).map(row).collect::<Vec<Vec<String>>>()));
        for warning in &case.warnings {
            let _ = writeln!(text, "warning: {warning}");
        }
    }
    text
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
