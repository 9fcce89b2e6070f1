//! `reachtube reproduce table2`: the uncertainty sets of model 1.

use std::fmt::Write;
use std::path::PathBuf;

use clap::Args;
use reachtube::conform::Notion;
use reachtube::conform::settings::InitialLimit;
use reachtube::reach::Disturbance;
use reachtube::reproduce::{Table2, Table2Options, table2};

use crate::error::Result;
use crate::option_values::{DISTURBANCES, INITIAL_LIMITS, choice, trimmed};
use crate::outcome::Outcome;
use crate::output;
use crate::progress::Progress;
use crate::table::titled;

const HELP: &str = "\
Example:
  reachtube campaign --out campaign
  reachtube reproduce table2 --data campaign
  reachtube reproduce table2 --data recordings --suites A,B,D,E --notions hull,exact

The paper's recordings are not public but for four suites; `campaign` records as many on a virtual
arm, so only the sizes of the sets can agree. The positions of X0 reach no further than the recorded
starts, as they seem to in the paper; with --initial-limit none they may take over what U has there.

Exit codes: 0 every set proved conformant, 1 one is not, 2 error.";

/// Table II: the uncertainty sets of model 1 for the LWA 4P
///
/// Sets that enclose positions and velocities, and sets that enclose positions, from compensated
/// torques.
#[derive(Debug, Args)]
#[command(after_help = HELP)]
pub(crate) struct Arguments {
    /// Folder with runs.csv and the recordings
    #[arg(long, value_name = "FOLDER")]
    pub data: PathBuf,
    /// Test suites to use, separated by commas, such as A*,B? [default: all]
    #[arg(long, value_name = "NAME,..", value_delimiter = ',', value_parser = trimmed)]
    pub suites: Vec<String>,
    /// Notions of enclosure, separated by commas
    #[arg(
        long,
        value_name = "NOTION,..",
        value_delimiter = ',',
        default_value = "hull",
        value_parser = choice::<Notion>(&Notion::NAMES[..3])
    )]
    pub notions: Vec<Notion>,
    /// How the disturbance may change in time [default: constant for the hull, as in the paper;
    /// otherwise sample]
    #[arg(long, value_parser = choice::<Disturbance>(DISTURBANCES))]
    pub disturbance: Option<Disturbance>,
    /// How far X0 may reach
    #[arg(
        long,
        default_value = "positions",
        value_parser = choice::<InitialLimit>(INITIAL_LIMITS)
    )]
    pub initial_limit: InitialLimit,
}

/// Runs `reproduce table2`.
pub(super) fn run(args: &Arguments, json: bool) -> Result<Outcome> {
    let options = Table2Options {
        suites: args.suites.clone(),
        notions: args.notions.clone(),
        disturbance: args.disturbance,
        initial_limit: args.initial_limit,
    };
    let bar = Progress::new();
    let table2 = table2(&args.data, &options, &bar)?;
    drop(bar);
    output::show(json, &table2, || summary(&table2))?;
    Ok(Outcome::of(table2.cases.iter().all(|case| case.conformant)))
}

/// Returns Table II in the paper's layout, with the paper's bounds beside ours.
fn summary(table2: &Table2) -> String {
    let mut text = format!(
        "Table II: uncertainty sets of model 1 (p = 1) for {} recordings in {} suites\n",
        table2.runs, table2.suites
    );
    for case in &table2.cases {
        text.push('\n');
        text.push_str(&titled(&case.table()));
        for warning in &case.warnings {
            let _ = writeln!(text, "warning: {warning}");
        }
    }
    text
}
