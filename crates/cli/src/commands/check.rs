//! `reachtube check`: does a model enclose recordings?

use clap::Args;
use reachtube::conform::{Check, Keep, Notion};
use reachtube::systems::SystemModel;
use reachtube::tracking::TrackingModel;
use reachtube_files::SealedFile;

use crate::commands::{system, tracking};
use crate::data_arguments::ModelArguments;
use crate::error::{Error, Result};
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
    if TrackingModel::is_at(&args.model.model) {
        return match args.notion {
            Some(_) => Err(Error::setting(tracking::NO_TORQUES)),
            None => tracking::check(&args.model, json),
        };
    }
    if SystemModel::is_at(&args.model.model) {
        return match args.notion {
            Some(_) => Err(Error::setting(system::NO_ROBOT)),
            None => system::check(&args.model, json),
        };
    }
    let (opened, check, outcome) = compared(args)?;
    match json {
        true => {
            warn_of_model(&opened);
            output::print_json(&check)?;
        }
        false => print(&opened, &check, &outcome)?,
    }
    Ok(outcome)
}

/// Compares recordings with a model, and prints the notes about them.
pub(crate) fn compared(args: &Arguments) -> Result<(OpenedCheck, Check, Outcome)> {
    let opened = OpenedCheck::new(&args.model, args.notion, Keep::Needed)?;
    let check = opened.check()?;
    output::notes(&check.notes);
    let outcome = Outcome::of_model(check.verdict.conformant, &opened.model);
    Ok((opened, check, outcome))
}

/// Prints a check on a few lines, or as a whole if the user asks for it.
pub(crate) fn print(opened: &OpenedCheck, check: &Check, outcome: &Outcome) -> Result<()> {
    if !global().verbose {
        return output::print_verdict(&opened.summary(check).to_string(), outcome);
    }
    warn_of_model(opened);
    output::print_verdict(&check.report(&opened.model.signals).to_string(), outcome)
}

fn warn_of_model(opened: &OpenedCheck) {
    let warnings = opened.model.warnings.iter();
    warnings.for_each(|warning| output::warn(&format!("of the model itself: {warning}")));
}
