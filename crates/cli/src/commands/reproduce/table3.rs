//! `reachtube reproduce table3`: the identified model.

use std::fmt::Write;
use std::path::PathBuf;

use clap::Args;
use reachtube::reproduce::{Table3, table3};

use crate::error::Result;
use crate::outcome::Outcome;
use crate::output;
use crate::progress::Progress;
use crate::table::titled;

const HELP: &str = "\
Example:
  reachtube campaign --out campaign
  reachtube reproduce table3 --data campaign

The arm of the campaign is not the paper's: its links are heavier, and it carries a payload. Its
friction has a Stribeck effect and falls while the joints warm up, which the law of Table III cannot
show; the last column names the rows that this moves.";

/// Table III: the model of the LWA 4P, identified from a campaign
///
/// The parameters beside the true ones of the arm, with errors in standard errors, and beside the
/// paper's.
#[derive(Debug, Args)]
#[command(after_help = HELP)]
pub(crate) struct Arguments {
    /// Folder of a campaign
    #[arg(long, value_name = "FOLDER")]
    pub data: PathBuf,
}

/// Runs `reproduce table3`.
pub(super) fn run(args: &Arguments, json: bool) -> Result<Outcome> {
    let bar = Progress::of("identifying");
    let table3 = table3(&args.data, &|done, total| bar.show(done, total))?;
    drop(bar);
    output::show(json, &table3, || summary(&table3))?;
    table3.warnings.iter().for_each(|warning| output::warn(warning));
    Ok(Outcome::Done)
}

/// Returns the three parts of Table III.
fn summary(table3: &Table3) -> String {
    let mut text = format!(
        "Table III: the model of the LWA 4P, identified from {} static poses, slow motions and \
         exciting motions (SI units)\n",
        table3.poses
    );
    for part in table3.tables() {
        let _ = write!(text, "\n{}", titled(&part));
    }
    text
}
