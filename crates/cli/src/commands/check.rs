//! `reachtube check`: does a model enclose recordings?

use std::fmt::Write;

use clap::Args;
use reachtube::conform::{Check, Place};

use crate::data_arguments::ModelArguments;
use crate::error::Result;
use crate::numbers::number;
use crate::opened::Opened;
use crate::outcome::Outcome;
use crate::output;
use crate::table::{plural, table};
use crate::verdict::{lost, trust};

const HELP: &str = "\
Example:
  reachtube check --model model.json --data recordings --suites C,F --torque compensated

Exit codes: 0 every recording lies in the reachable set, at samples; 1 some value lies outside,
and the result names a witness (suite, run, time, joint, excess); 2 error.";

/// Check whether a model encloses other recordings
#[derive(Debug, Args)]
#[command(after_help = HELP)]
pub struct Arguments {
    #[command(flatten)]
    pub model: ModelArguments,
}

pub fn run(args: &Arguments, json: bool) -> Result<Outcome> {
    let check = Opened::new(&args.model)?.check()?;
    output::notes(&check.notes);
    if json {
        output::print_json(&check)?;
    } else {
        output::print(&summary(&check))?;
    }
    Ok(Outcome::of(check.conformant))
}

/// The result of `check`.
pub fn summary(check: &Check) -> String {
    let mut text = String::new();
    let verdict = if check.conformant { "conformant" } else { "not conformant" };
    let _ = writeln!(
        text,
        "{verdict}: {} {}; {} of {} values (suite, sample, state) outside the reachable set\n",
        check.runs,
        plural(check.runs, "recording"),
        check.violations.count,
        check.rows
    );
    let row = |suite: &reachtube::conform::SuiteCheck| {
        vec![
            suite.suite.clone(),
            suite.runs.to_string(),
            suite.rows.to_string(),
            suite.violations.count.to_string(),
            suite.violations.worst.as_ref().map_or_else(|| "-".into(), witness),
        ]
    };
    let rows: Vec<_> = check.suites.iter().map(row).collect();
    text.push_str(&table(&["suite", "runs", "values", "outside", "furthest"], &rows));
    check.lost.iter().for_each(|lost| text.push_str(&format!("{}\n", self::lost(lost))));
    match &check.trust {
        Some(held_out) => {
            let _ = writeln!(text, "\n{}", trust(held_out, "leave the set"));
        }
        None => text.push_str(
            "\nthe model was fitted to some of these recordings: this says nothing about the next motion\n",
        ),
    }
    text
}

/// A place in one line.
fn witness(place: &Place) -> String {
    let unit = if place.state.starts_with("qd") { "rad/s" } else { "rad" };
    format!(
        "{} at {:.3} s: joint {}, {} {} {unit} beyond the {} side",
        place.run,
        place.time,
        place.joint,
        place.state,
        number(place.excess),
        format!("{:?}", place.side).to_lowercase()
    )
}
