//! `reachtube stop`: how far a robot moves after its brakes were applied.

use std::path::PathBuf;

use clap::Args;
use clap::builder::RangedU64ValueParser;
use reachtube::Keep;
use reachtube::number::at_least;
use reachtube::robot::JointKind;
use reachtube::verify::{Brakes, WorstStop, stops_along};
use serde_json::json;

use crate::data_arguments::ModelArguments;
use crate::error::Result;
use crate::opened::OpenedCheck;
use crate::outcome::Outcome;
use crate::output;
use crate::progress::Progress;
use crate::table::table;

const HELP: &str = "\
Example:
  reachtube stop --model model.json --data recordings --suites A --brakes brakes.toml

brakes.toml gives the least and the greatest torque of each brake, in N m at the output side of the
gear, and when the brakes hold at the earliest and at the latest, in s (docs/verify.md):
  torque = [[40, 60], [40, 60], [40, 60], [40, 60], [20, 30], [20, 30]]
  delay = [0.01, 0.03]

Prints the greatest proved way and the latest proved standstill of each joint, for stops of
category 0 (drives off, brakes on) from every recorded sample.

Exit codes: 0 every stop is proved, 2 error, 3 not proved from some samples.";

/// Enclose how far and how long a robot moves after a stop by its brakes
#[derive(Debug, Args)]
#[command(after_help = HELP)]
pub(crate) struct Arguments {
    #[command(flatten)]
    pub model: ModelArguments,
    /// Brakes: a TOML file with torque and delay
    #[arg(long, value_name = "FILE")]
    pub brakes: PathBuf,
    /// Stop from every Nth sample
    #[arg(long, value_name = "N", default_value_t = 1)]
    #[arg(value_parser = RangedU64ValueParser::<usize>::new().range(1..))]
    pub every: usize,
}

pub(crate) fn run(args: &Arguments, json: bool) -> Result<Outcome> {
    let text =
        reachtube_files::read_text(&args.brakes, "write the brakes, as docs/verify.md says")?;
    let opened = OpenedCheck::new(&args.model, None, Keep::Needed)?;
    let robot = opened.problem.robot();
    let brakes = Brakes::from_toml(&text, &args.brakes.display().to_string(), robot)?;
    output::notes(&opened.problem.recordings().notes);
    let all = {
        let _bar = Progress::new();
        stops_along(&opened.problem, &brakes, args.every)
    };
    let proved = all.iter().all(|worst| worst.proved == worst.samples);
    let outcome = if proved { Outcome::Done } else { Outcome::Undecided };
    if json {
        output::print_json(&json!({ "stops": all }))?;
    } else {
        let kinds = robot.kinds();
        let unit = JointKind::any_unit(&kinds, JointKind::position_unit);
        output::print_verdict(&text_of(&all, &unit), &outcome)?;
    }
    Ok(outcome)
}

fn text_of(all: &[WorstStop], unit: &str) -> String {
    let (proved, samples) = all
        .iter()
        .fold((0, 0), |(proved, samples), worst| (proved + worst.proved, samples + worst.samples));
    let joints = all.iter().filter(|worst| worst.suite == all[0].suite).count().max(1);
    let verdict = if proved == samples {
        format!(
            "stands: from each of {} samples every joint comes to a standstill",
            samples / joints
        )
    } else {
        format!(
            "not proved: from {} of {} samples no standstill is proved; the brakes may be too weak \
             for the load, or the recorded states too far apart",
            (samples - proved) / joints,
            samples / joints
        )
    };
    let way = format!("greatest way [{unit}]");
    let header = ["suite", "joint", &way, "from [s]", "latest standstill [s]", "from [s]"];
    let bound = |value: f64| if value.is_finite() { at_least(value) } else { "none".into() };
    let row = |worst: &WorstStop| {
        vec![
            worst.suite.clone(),
            worst.joint.clone(),
            bound(worst.way),
            format!("{:.3}", worst.way_from),
            bound(worst.time),
            format!("{:.3}", worst.time_from),
        ]
    };
    format!("{verdict}\n\n{}", table(&header, &all.iter().map(row).collect::<Vec<_>>()))
}
