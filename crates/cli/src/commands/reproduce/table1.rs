//! `reachtube reproduce table1`: the errors of the abstracted models in simulation.

use std::fmt::Write;
use std::path::PathBuf;

use clap::Args;
use reachtube::number::four_decimals;
use reachtube::reproduce::{Table1, Table1Options, table1};
use reachtube::write;

use crate::error::Result;
use crate::lock_arguments::LockArguments;
use crate::outcome::Outcome;
use crate::output;
use crate::progress::Progress;
use crate::table::untitled;

const HELP: &str = "\
Example:
  reachtube reproduce table1 --motions 50 --seed 1 --out table1.csv

The paper's trajectories are unpublished, so only the sizes and the order of the errors can agree.";

/// Table I: velocity errors of models 1, 2 and 3 in simulation
#[derive(Debug, Args)]
#[command(after_help = HELP)]
pub(crate) struct Arguments {
    /// Robot: the embedded lwa4p, or a TOML or URDF file
    #[arg(long, default_value = "lwa4p")]
    pub robot: String,
    #[command(flatten)]
    pub lock: LockArguments,
    /// Number of random point-to-point motions, each slow and fast
    #[arg(long, default_value_t = 50, value_name = "COUNT")]
    pub motions: usize,
    /// Seed of the motions
    #[arg(long, default_value_t = 1)]
    pub seed: u64,
    /// Orders p of the models, separated by commas, each 1 or more
    #[arg(long, value_delimiter = ',', default_value = "1,3,5,7", value_name = "P,..")]
    pub orders: Vec<u32>,
    /// Highest order at which model 3 is simulated
    #[arg(long, default_value_t = 5, value_name = "P")]
    pub model3_up_to: u32,
    /// Largest distance of a joint from q = 0, rad
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

/// Runs `reproduce table1`.
pub(super) fn run(args: &Arguments, json: bool) -> Result<Outcome> {
    let robot = args.lock.load(&args.robot)?;
    robot.check_physical()?;
    if let Some(path) = &args.out {
        output::claim(path)?;
    }
    let bar = Progress::of("simulating");
    let table1 = table1(&robot, &options(args), &|done, total| bar.show(done, total))?;
    drop(bar);
    if let Some(path) = &args.out {
        write::atomically(path, |out| table1.write_csv(out))?;
        output::wrote(path);
    }
    output::show(json, &table1, || summary(&table1))?;
    Ok(Outcome::Done)
}

fn options(args: &Arguments) -> Table1Options {
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
    text.push_str(&untitled(&table1.table()));
    if options.orders.iter().any(|order| *order > options.model3_up_to) {
        let _ = writeln!(
            text,
            "\n-: not simulated; --model3-up-to {} limits the order of model 3",
            options.model3_up_to
        );
    }
    text
}
