//! The text about a fit of the nominal model.

use std::fmt::Write;

use reachtube::Model;
use reachtube::conform::{FitRecord, FittedParameter, MOST_ERRORS};
use reachtube::number::four_decimals;

use crate::table::table;

/// Beyond this factor, or below 1 over it, a parameter is said to be no longer what its name says.
const MOST_FACTOR: f64 = 1.5;

/// Returns how the nominal model was fitted, for a model that was.
pub(super) fn fit_summary(model: &Model) -> String {
    let Some(record) = &model.fit else { return String::new() };
    let linear = if model.a.is_empty() { " of the linear model" } else { "" };
    let mut text = format!(
        "\nnominal model fitted for small sets: cost{linear} {} before, {} after ({:+.1} %), with \
         a pull of {} toward the identified values\n",
        four_decimals(record.identified_cost),
        four_decimals(record.cost),
        100.0 * (record.cost / record.identified_cost - 1.0),
        record.pull
    );
    let groups = record.groups.iter();
    let groups = groups.map(|group| format!("{} {}", group.group.name(), cost(group.cost_without)));
    let _ = writeln!(text, "cost without a group: {}", groups.collect::<Vec<_>>().join(", "));
    text.push_str(&left_out(record));
    text.push_str(&parameters(model, record));
    text.push_str(&torque(record));
    text
}

/// Returns a cost in words.
fn cost(cost: Option<f64>) -> String {
    cost.map_or_else(|| "none (a nominal motion runs away)".into(), four_decimals)
}

/// Returns what the fit is worth for motions that it has not seen.
fn left_out(record: &FitRecord) -> String {
    let of =
        |left: &reachtube::conform::UnseenMotion| format!("{} {}", left.motion, cost(left.cost));
    let each: Vec<String> = record.leave_one_out.iter().map(of).collect();
    let mut text = format!(
        "cost with one motion left out of the fit: {}; mean {}\n",
        each.join(", "),
        cost(record.left_out_mean())
    );
    if let Some(before) = record.identified_calibrated_cost {
        let before = four_decimals(before);
        let _ = writeln!(text, "cost of calibrated sets with the identified model: {before}");
    }
    text
}

/// Returns the parameters that changed, with a remark where one no longer is what its name says.
fn parameters(model: &Model, record: &FitRecord) -> String {
    let all = record.parameters.iter();
    let changed: Vec<&FittedParameter> = all.filter(|p| p.has_changed()).collect();
    let row = |p: &&FittedParameter| {
        vec![
            model.robot.joints[p.joint - 1].name.clone(),
            p.name.clone(),
            format!("{} {}", four_decimals(p.identified), p.unit),
            p.standard_error.map_or_else(|| "-".into(), four_decimals),
            four_decimals(p.fitted),
            p.factor.map_or_else(String::new, |factor| format!("{factor:.3}")),
            if p.is_beyond_error() { "covers".into() } else { String::new() },
        ]
    };
    let mut rows: Vec<Vec<String>> = changed.iter().map(row).collect();
    let mut header = vec!["joint", "parameter", "identified", "±", "fitted", "factor", ""];
    if record.parameters.iter().all(|p| p.standard_error.is_none()) {
        rows.iter_mut().for_each(|row| drop(row.remove(3)));
        header.remove(3);
    }
    let mut text = if rows.is_empty() { String::new() } else { table(&header, &rows) };
    let kept = record.parameters.len() - changed.len();
    if kept > 0 {
        let _ = writeln!(text, "  {kept} of {} keep their values", record.parameters.len());
    }
    if changed.iter().any(|p| p.is_beyond_error()) {
        let _ = writeln!(
            text,
            "  \"covers\": the value moved by more than {MOST_ERRORS} standard errors (±), so it \
             covers what the model leaves out and measures nothing"
        );
    }
    let is_far = |p: &&FittedParameter| {
        p.factor.is_some_and(|factor| !(1.0 / MOST_FACTOR..=MOST_FACTOR).contains(&factor))
    };
    if changed.iter().any(is_far) {
        let _ = writeln!(
            text,
            "  a factor beyond {MOST_FACTOR} is no measurement: such a parameter stands for what \
             the model leaves out, and only the model as a whole has a meaning"
        );
    }
    text
}

/// Returns what a user of the model must know of the run, and what holds without it.
pub(super) fn any_run(model: &Model) -> String {
    let Some(any) = &model.any_run else { return String::new() };
    let radii = any.sets.input_set.radius.iter().map(|radius| format!("{radius:.3}"));
    format!(
        "\nfriction depends on the run: to use this model one must know the order of the run in \
         its suite, or the temperatures; for any run the sets cost {}, around the nominal motion \
         of run {} ({}; radii of U {}); the model file has them as any_run\n",
        four_decimals(any.cost),
        any.condition.place,
        if any.verified { "proved" } else { "NOT proved" },
        radii.collect::<Vec<_>>().join(" ")
    )
}

fn torque(record: &FitRecord) -> String {
    let list = |of: fn(&reachtube::conform::TorquePrediction) -> f64| {
        let values = record.torque.iter().map(|torque| format!("{:.2}", of(torque)));
        values.collect::<Vec<_>>().join(" ")
    };
    format!(
        "error of the predicted input, root mean square, joint by joint: {} before, {} after\n",
        list(|torque| torque.identified),
        list(|torque| torque.fitted)
    )
}
