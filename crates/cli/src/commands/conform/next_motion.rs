//! What `conform` prints of motions that were not recorded.

use std::fmt::Write;

use reachtube::Model;
use reachtube::conform::{Calibration, LeftOut};
use reachtube::number::{at_least, four_decimals};

use crate::table::{plural, table};

/// Largest number of motions in a table.
const MOST_MOTIONS: usize = 12;

/// Returns the sentence about the next motion and the tables that describe how far the sets depend
/// on single motions.
pub fn next_motion(model: &Model) -> String {
    let set = model.proof.enclosure.set_name();
    let mut text = String::new();
    if let Some(calibration) = &model.calibration {
        let _ = writeln!(text, "\n{}", calibrated(calibration));
    }
    let _ = writeln!(text, "\n{}", model.trust.words(set, "touched the set"));
    if model.calibration.is_none() && model.trust.violation_probability > 0.5 && motions(model) > 1
    {
        text.push_str(
            "--calibrate MOTION,.. keeps n motions back and gives a bound of 1 in n + 1\n",
        );
    }
    text.push_str(&left_out(model));
    text
}

/// Returns the number of motions that the recordings are of.
fn motions(model: &Model) -> usize {
    let of = |suite: &reachtube::conform::SuiteRecord| {
        suite.motion.clone().unwrap_or_else(|| suite.name.clone())
    };
    model.data.suites.iter().map(of).collect::<std::collections::BTreeSet<_>>().len()
}

fn calibrated(calibration: &Calibration) -> String {
    let Calibration { fitted, gauges, factor, input_only } = calibration;
    let sets = if *input_only { "U" } else { "X0 and U" };
    let list: Vec<String> = gauges
        .iter()
        .take(MOST_MOTIONS)
        .map(|gauge| format!("{} {}", gauge.motion, at_least(gauge.gauge)))
        .collect();
    let more = gauges.len().saturating_sub(MOST_MOTIONS);
    format!(
        "calibrated: the sets found on {} {} were scaled about their centres by {} ({sets}) to \
         hold the {} kept back (gauges: {}{})",
        fitted.len(),
        plural(fitted.len(), "motion"),
        at_least(*factor),
        gauges.len(),
        list.join(", "),
        if more == 0 { String::new() } else { format!(", and {more} more") }
    )
}

/// Returns the table of the sets without each motion, those that need the most growth first.
fn left_out(model: &Model) -> String {
    if model.left_out.is_empty() {
        return match motions(model) {
            0 | 1 => String::new(),
            _ => "\nsets without each motion: not computed for a model that is not linear; run \
                  conform with --suites of the other motions, then check the one left out\n"
                .into(),
        };
    }
    let mut all: Vec<&LeftOut> = model.left_out.iter().collect();
    let size = |left: &LeftOut| left.gauge.unwrap_or(f64::INFINITY);
    all.sort_by(|a, b| size(b).total_cmp(&size(a)));
    let row = |left: &&LeftOut| {
        let number = |value: Option<String>| value.unwrap_or_else(|| "not computed".into());
        let none = left.cost.map(|_| "none suffices".into());
        vec![
            left.motion.clone(),
            number(left.cost.map(four_decimals)),
            number(left.outside.map(|outside| format!("{outside} of {}", left.rows))),
            number(left.gauge.map(at_least).or(none)),
        ]
    };
    let rows: Vec<_> = all.iter().take(MOST_MOTIONS).map(row).collect();
    let mut text = String::from(
        "\nsets found without a motion: a description of these motions, no bound for the next\n",
    );
    text.push_str(&table(
        &["without", "cost", "its rows outside", "growth that would hold it"],
        &rows,
    ));
    if all.len() > MOST_MOTIONS {
        let _ = writeln!(text, "  and {} more; --json lists all", all.len() - MOST_MOTIONS);
    }
    text
}
