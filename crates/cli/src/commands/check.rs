//! `reachtube check`: does a model enclose recordings?

use clap::Args;
use reachtube::conform::{Keep, Notion};

use crate::data_arguments::ModelArguments;
use crate::error::Result;
use crate::global::global;
use crate::opened::OpenedCheck;
use crate::option_values::choice;
use crate::outcome::Outcome;
use crate::output;

const HELP: &str = "\
Examples:
  reachtube check --model model.json --data recordings --suites C,F
  reachtube check --model model.json --data recordings --notion exact
      also demands that all states together lie in the reachable set itself

A model that is not linear is compared by its computed outer set, an enclosure of the reachable set.

Exit codes: 0 all recordings are proved to lie in the reachable set, at samples, 1 some are not,
2 error, 3 they are, but the sets do not limit some joint.";

/// Check whether a model encloses other recordings
#[derive(Debug, Args)]
#[command(after_help = HELP)]
pub(crate) struct Arguments {
    #[command(flatten)]
    pub model: ModelArguments,
    /// What must lie in the reachable set [default: as in the model file]
    #[arg(long, value_parser = choice::<Notion>(Notion::NAMES))]
    pub notion: Option<Notion>,
}

pub(crate) fn run(args: &Arguments, json: bool) -> Result<Outcome> {
    let opened = OpenedCheck::new(&args.model, args.notion, Keep::Needed)?;
    let check = opened.check()?;
    output::notes(&check.notes);
    let outcome = Outcome::of_model(check.verdict.conformant, &opened.model);
    if !json && !global().verbose {
        output::print_verdict(&opened.summary(&check).to_string(), &outcome)?;
        return Ok(outcome);
    }
    let warnings = opened.model.warnings.iter();
    warnings.for_each(|warning| output::warn(&format!("of the model itself: {warning}")));
    if json {
        output::print_json(&check)?;
    } else {
        let report = check.report(&opened.model.signals);
        output::print_verdict(&report.to_string(), &outcome)?;
    }
    Ok(outcome)
}
