//! `reachtube check`: does a model enclose recordings?

use std::fmt::Write;

use clap::Args;
use reachtube::conform::{
    Check, Growth, Keep, Model, Notion, PointVerdict, PointWitness, SuiteVerdict, Witness,
};

use crate::data_arguments::ModelArguments;
use crate::error::Result;
use crate::opened::Opened;
use crate::option_values::{NOTIONS, choice};
use crate::outcome::Outcome;
use crate::output;
use crate::table::{plural, table};
use crate::verdict::{lost, notion_words, traces};
use reachtube::number::{at_least, four_decimals};
use reachtube_robot::JointKind;

const HELP: &str = "\
Examples:
  reachtube check --model model.json --data recordings --suites C,F --torque compensated
  reachtube check --model model.json --data recordings --torque compensated --notion exact
      also demands that all states together lie in the reachable set itself

A model that is not linear is compared by its computed outer set, an enclosure of the reachable set.

Exit codes: 0 all recordings were proved to lie in the reachable set, at samples, as --notion says;
1 some were not, and the result names a witness (suite, run, time, joint, excess); 2 error.";

/// Check whether a model encloses other recordings
#[derive(Debug, Args)]
#[command(after_help = HELP)]
pub(crate) struct Arguments {
    #[command(flatten)]
    pub model: ModelArguments,
    /// Directions in which the recordings must lie in the reachable set [default: those of the
    /// model file]
    #[arg(long, value_parser = choice::<Notion>(NOTIONS))]
    pub notion: Option<Notion>,
}

pub(crate) fn run(args: &Arguments, json: bool) -> Result<Outcome> {
    let opened = Opened::new(&args.model, args.notion, Keep::Needed)?;
    let check = opened.check()?;
    output::notes(&check.notes);
    for warning in &opened.model.warnings {
        output::warn(&format!("of the model itself: {}", warning.text));
    }
    output::show(json, &check, || summary(&check, &opened.model))?;
    Ok(Outcome::of(check.verdict.conformant))
}

/// Returns the result of `check` of a model, with one line per suite.
pub(crate) fn summary(check: &Check, model: &Model) -> String {
    let (verdict, kinds) = (&check.verdict, &model.robot.kinds());
    let set = verdict.enclosure.set_name();
    let outcome = if verdict.conformant { "conformant" } else { "not conformant" };
    let mut text = format!(
        "{outcome}: {} {}; {} of {} rows (suite, sample, state) outside the {set}, at samples\n",
        verdict.runs,
        plural(verdict.runs, "recording"),
        verdict.violations.count,
        verdict.rows
    );
    if let Some(points) = &verdict.points {
        let _ = writeln!(text, "{}", outside_points(points, verdict.lost.is_empty(), kinds));
    }
    if let Some(found) = &verdict.traces {
        let _ = writeln!(text, "{}", traces(found, verdict.runs, model.settings.disturbance));
    }
    text.push('\n');
    let rows: Vec<_> = verdict.suites.iter().map(|suite| suite_row(suite, kinds)).collect();
    text.push_str(&table(&["suite", "runs", "rows", "outside", "furthest outside"], &rows));
    for set in &verdict.lost {
        let _ = writeln!(text, "{}", lost(set));
    }
    if let Some(growth) = &check.growth {
        let _ = writeln!(text, "\n{}", growth_words(growth, kinds));
    }
    let next_motion = match &check.trust {
        Some(held_out) => held_out.words(set, "left it"),
        None => {
            "no bound for the next motion: the model was fitted to some of these recordings".into()
        }
    };
    let _ = writeln!(text, "\n{next_motion}");
    if let Some(rates) = &check.rates {
        let _ = writeln!(text, "\n{}", rates.words());
    }
    text
}

/// Says how many recorded points are outside the reachable set, and names the one furthest outside.
fn outside_points(verdict: &PointVerdict, followed: bool, kinds: &[JointKind]) -> String {
    let PointVerdict { points, unproved, outside, .. } = verdict;
    let close = match unproved - outside {
        0 => String::new(),
        lost if !followed => format!(", and {lost} not proved, as the set was lost before"),
        close => format!(
            ", and {close} too close to its boundary to be proved (sets that `conform --notion` \
             fits for this notion leave room for a proof)"
        ),
    };
    let mut text = format!(
        "{outside} of {points} recorded points ({}) outside the set{close}",
        notion_words(verdict.notion)
    );
    if let Some(worst) = &verdict.worst {
        let PointWitness { run, time, combination, value, reach, .. } = worst;
        let state = worst.leading_state();
        let _ = write!(
            text,
            "\nfurthest outside: {run} at {time:.3} s, where {combination} is {} {unit} from the \
             centre of the set, which reaches {}",
            four_decimals(*value),
            four_decimals(*reach),
            unit = state.kind.unit(kinds[state.joint]),
        );
    }
    text
}

/// Factor beyond which widening a set is no remedy.
const MOST_GROWTH: f64 = 100.0;

/// Says which set would have to grow, and by how much.
fn growth_words(growth: &Growth, kinds: &[JointKind]) -> String {
    let set = |name: &str, factor: Option<f64>| match factor {
        Some(factor) if factor > MOST_GROWTH => format!(
            "widening {name} does not help (it would have to be {} times as wide)",
            at_least(factor)
        ),
        Some(factor) => format!("{name} about {} times as wide", at_least(factor)),
        None => format!("no factor of {name} suffices"),
    };
    let noise = format!(
        "V wider by {} {} and {} {}",
        at_least(growth.noise_position),
        JointKind::any_unit(kinds, JointKind::position_unit),
        at_least(growth.noise_velocity),
        JointKind::any_unit(kinds, JointKind::velocity_unit)
    );
    match growth.both_sets {
        None => format!("to enclose these recordings: {noise} (not proved)"),
        both => format!(
            "to enclose these recordings, one of these would be needed: {}; {}; {}; {noise} (not \
             proved)",
            set("U", growth.input_set),
            set("X0", growth.initial_set),
            set("X0 and U", both)
        ),
    }
}

fn suite_row(suite: &SuiteVerdict, kinds: &[JointKind]) -> Vec<String> {
    let worst = suite.violations.worst.as_ref();
    vec![
        suite.suite.clone(),
        suite.runs.to_string(),
        suite.rows.to_string(),
        suite.violations.count.to_string(),
        worst.map_or_else(|| "-".into(), |place| witness(place, kinds)),
    ]
}

/// Describes a value outside the reachable set in one line.
fn witness(place: &Witness, kinds: &[JointKind]) -> String {
    let unit = place.state.kind.unit(kinds[place.state.joint]);
    format!(
        "{} at {:.3} s: joint {}, {} is {} {unit} beyond the {} bound",
        place.run,
        place.time,
        place.joint,
        place.state,
        four_decimals(place.excess),
        format!("{:?}", place.side).to_lowercase()
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_set_that_cannot_grow_enough_is_no_remedy() {
        let growth = Growth {
            initial_set: Some(1.5e6),
            input_set: Some(1.25),
            both_sets: Some(1.2),
            noise_position: 0.1,
            noise_velocity: 0.2,
        };
        let words = growth_words(&growth, &[JointKind::Revolute]);
        assert!(words.contains("U about 1.25"), "{words}");
        assert!(words.contains("widening X0 does not help"), "{words}");
        assert!(!words.contains("X0 about"), "{words}");
    }
}
