//! What a report says of single motions and runs.

use reachtube_scalar::number::{at_least, four_decimals, significant};

use crate::model::file::Model;
use crate::next_motion::trends::Trend;
use crate::next_motion::without_motion::LeftOut;
use crate::result::findings;
use reachtube_finding::{Section, Table};

/// Largest number of motions in the table.
const MOST_MOTIONS: usize = 12;

/// Returns the sets without each motion, and trends over the runs.
pub(super) fn dependence(model: &Model) -> [Section; 2] {
    let mut left_out = Section::default();
    left_out.findings.extend(findings::left_out(model));
    left_out.tables.extend((!model.left_out.is_empty()).then(|| table_of_left_out(model)));
    let mut changed = Section::default();
    changed.findings.extend(findings::robot_changed(&model.trends, &model.signals.noun));
    for of_suite in model.trends.chunk_by(|a, b| a.suite == b.suite) {
        let (name, value) = trend(model, of_suite);
        changed.fact(name, value);
    }
    [left_out, changed]
}

/// Returns the table of the sets without each motion, the motions that need the most growth first.
fn table_of_left_out(model: &Model) -> Table {
    let is_linear = !model.a.is_empty();
    let mut all: Vec<&LeftOut> = model.left_out.iter().collect();
    // The notion `hull` of a linear model has the factors of X0 and of U in turn.
    let in_turn = all.iter().any(|left| left.initial_gauge.is_some());
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
        let times =
            |gauge: Option<f64>| or(gauge.map(|gauge| format!("x {}", at_least(gauge))), none);
        let mut row = vec![
            left.motion.clone(),
            or(left.cost.map(four_decimals), "not computed"),
            or(outside, "not computed"),
            times(left.gauge),
        ];
        if in_turn {
            row.extend([left.initial_gauge, left.input_gauge, left.wider].map(times));
        }
        row
    };
    let cost = if is_linear { "cost of the sets" } else { "cost of the linearised sets" };
    let mut header = vec!["without motion", cost, "its rows outside", "factor needed"];
    if in_turn {
        header.extend(["X0 at start", "then U", "sets wider"]);
    }
    Table::new(header, all.iter().map(row).collect()).cut_to(MOST_MOTIONS)
}

/// Returns the parts of one suite that follow the order of the runs.
fn trend(model: &Model, of_suite: &[Trend]) -> (String, String) {
    let signals = &model.signals;
    let part = |trend: &Trend| {
        format!(
            "{} {:+.2} ({} {})",
            model.signals.parts[trend.part - 1].name,
            trend.correlation,
            significant(trend.range, 2),
            signals.states[trend.part - 1].unit
        )
    };
    let list: Vec<String> = of_suite.iter().map(part).collect();
    let Trend { suite, runs, .. } = &of_suite[0];
    let name = format!(
        "suite {suite}, rank correlation of the last position with the order of {runs} runs \
         (largest difference)"
    );
    (name, list.join(", "))
}
