//! What `conform` prints of how far the sets depend on single motions and runs.

use std::fmt::Write;

use reachtube::Model;
use reachtube::conform::{LeftOut, Trend};
use reachtube::number::{at_least, four_decimals, significant};

use crate::table::{plural, table};

/// Largest number of motions in the table.
const MOST_MOTIONS: usize = 12;

/// Returns the sets without each motion, the runs that decide, and trends over the runs.
pub(super) fn dependence(model: &Model) -> String {
    format!("{}{}{}", left_out(model), deciding_runs(model), trends(model))
}

/// Returns the table of the sets without each motion, those that need the most growth first.
fn left_out(model: &Model) -> String {
    let is_linear = model.acceleration.is_empty();
    if model.left_out.is_empty() {
        return match (model.data.motions(), is_linear) {
            (0 | 1, _) | (_, true) => String::new(),
            _ => "\nsets without each motion: computed for --method program and --notion hull \
                  only; run conform with --suites of the other motions, then check the one left \
                  out\n"
                .into(),
        };
    }
    let mut all: Vec<&LeftOut> = model.left_out.iter().collect();
    // What was not computed goes last.
    let size = |left: &LeftOut| match left.cost {
        Some(_) => left.gauge.unwrap_or(f64::INFINITY),
        None => 0.0,
    };
    all.sort_by(|a, b| size(b).total_cmp(&size(a)));
    let row = |left: &&LeftOut| {
        let or = |value: Option<String>, other: &str| value.unwrap_or_else(|| other.into());
        let none = match left.cost {
            None => "not computed",
            Some(_) if is_linear => "none suffices",
            Some(_) => "none found",
        };
        let outside = left.outside.map(|outside| format!("{outside} of {}", left.rows));
        vec![
            left.motion.clone(),
            or(left.cost.map(four_decimals), "not computed"),
            or(outside, "not computed"),
            or(left.gauge.map(|gauge| format!("x {}", at_least(gauge))), none),
        ]
    };
    let rows: Vec<_> = all.iter().take(MOST_MOTIONS).map(row).collect();
    let cost = if is_linear { "cost of the sets" } else { "cost of the linearised sets" };
    let header = ["without motion", cost, "its rows outside", "growth that holds it"];
    let mut text = format!(
        "\nsets found without a motion (a description of these motions, no bound for the next):\n\
         {}",
        table(&header, &rows)
    );
    if all.len() > MOST_MOTIONS {
        let _ = writeln!(text, "  and {} more; --json lists all", all.len() - MOST_MOTIONS);
    }
    if model.fit.is_some() {
        text.push_str(
            "  only the sets were found without the motion; the nominal model was fitted to all\n",
        );
    }
    text
}

/// Names the runs that decide the sets, and what they cost.
fn deciding_runs(model: &Model) -> String {
    let runs = &model.deciding_runs;
    let Some(first) = runs.most.first() else { return String::new() };
    let all: usize = model.data.run_count();
    let decide = if runs.count == 1 { "decides" } else { "decide" };
    let mut text = format!(
        "\n{} of {all} {} {decide} the sets, most of all {} with {} {}",
        runs.count,
        plural(all, "run"),
        first.file,
        first.values,
        plural(first.values, "value")
    );
    if let Some(cost) = runs.cost_without {
        let named = runs.most.len();
        let _ = write!(
            text,
            "; without the {} that {} most the sets would cost about {cost:.0} (estimated from at \
             most 64 samples of each run)",
            if named == 1 { "one".into() } else { named.to_string() },
            if named == 1 { "decides" } else { "decide" },
        );
    }
    text + "\n"
}

/// Names the joints that follow the order of the runs, suite by suite.
fn trends(model: &Model) -> String {
    let kinds = model.robot.kinds();
    let joint = |trend: &Trend| {
        format!(
            "{} {:+.2} ({} {})",
            model.robot.joints[trend.joint - 1].name,
            trend.correlation,
            significant(trend.range, 2),
            kinds[trend.joint - 1].position_unit()
        )
    };
    let mut text = String::new();
    for of_suite in model.trends.chunk_by(|a, b| a.suite == b.suite) {
        let list: Vec<String> = of_suite.iter().map(joint).collect();
        let _ = writeln!(
            text,
            "trend: suite {}, {} runs: {}",
            of_suite[0].suite,
            of_suite[0].runs,
            list.join(", ")
        );
    }
    if !text.is_empty() {
        text.push_str(
            "  (rank correlation of the last position with the order of the runs; largest \
             difference): the robot changed while it was recorded, for example by warming up, so \
             a later motion may lie further out\n",
        );
    }
    text
}
