//! Tables of a nominal model that was fitted, and facts about calibrated sets.

use reachtube_conform::Code;
use reachtube_conform::Model;
use reachtube_conform::fit::{FitRecord, FittedParameter};
use reachtube_finding::Finding;

use crate::cost::{change, cost_unit};
use reachtube_finding::Table;
use reachtube_scalar::number::four_decimals;

/// The column of standard errors in the table of parameters.
const STANDARD_ERROR: usize = 2;

/// Returns the facts about the calibration and the sets for any run: name and value.
pub(super) fn nominal_facts(model: &Model) -> Vec<(String, String)> {
    let mut facts = Vec::new();
    let mut add = |name: &str, value: String| facts.push((name.to_string(), value));
    let calibrated = |found: &Finding| found.code == Code::Calibrated;
    if let Some(calibrated) = model.report().findings().into_iter().find(calibrated) {
        add("Calibration", calibrated.text);
    }
    if let Some(any) = &model.any_run {
        let unit = cost_unit(model);
        add(&format!("Cost of the sets for any run {unit}"), four_decimals(any.cost));
    }
    facts
}

/// Returns the tables about a fitted nominal model: what the sets cost, and its parameters.
pub(super) fn nominal_tables(model: &Model) -> Vec<Table> {
    let Some(fit) = &model.fit else { return Vec::new() };
    let changed = fit.parameters.iter().filter(|p| p.has_changed());
    let header = ["Parameter", "Identified", "Standard error", "Fitted", "Factor"];
    let mut parameters = Table::new(header, changed.map(|p| parameter(model, p)).collect())
        .titled("Parameters that changed");
    if fit.parameters.iter().all(|p| p.standard_error.is_none()) {
        parameters.header.remove(STANDARD_ERROR);
        parameters.rows.iter_mut().for_each(|row| drop(row.remove(STANDARD_ERROR)));
    }
    vec![costs(model, fit), parameters]
}

fn costs(model: &Model, fit: &FitRecord) -> Table {
    let row = |name: String, cost: Option<f64>| {
        let change = |cost| change(cost, fit.identified_cost);
        let none = || "a nominal motion runs away".into();
        vec![name, cost.map_or_else(none, four_decimals), cost.map_or_else(String::new, change)]
    };
    let first = [("Identified", fit.identified_cost), ("Fitted", fit.cost)];
    let groups = fit.groups.iter().map(|group| {
        row(format!("Fitted, {} as identified", group.group.name()), group.cost_without)
    });
    let left_out = fit
        .leave_one_out
        .iter()
        .map(|left| row(format!("Fitted without motion {}", left.motion), left.cost));
    let mean = row("Mean of the fits without a motion".into(), fit.left_out_mean());
    let calibrated = fit
        .identified_calibrated_cost
        .map(|cost| row("Identified, calibrated (not the smallest)".into(), Some(cost)));
    let first = first.map(|(name, cost)| row(name.into(), Some(cost))).into_iter();
    let rows = first.chain(groups).chain(left_out).chain([mean]).chain(calibrated).collect();
    Table::new(["Nominal model", &format!("Cost {}", cost_unit(model)), "Change"], rows)
        .titled("Cost of the smallest sets")
}

fn parameter(model: &Model, p: &FittedParameter) -> Vec<String> {
    vec![
        format!("{}: {} [{}]", model.signals.parts[p.part - 1].name, p.name, p.unit),
        four_decimals(p.identified),
        p.standard_error.map_or_else(|| "-".into(), four_decimals),
        four_decimals(p.fitted),
        p.factor.map_or_else(|| "-".into(), |factor| format!("{factor:.3}")),
    ]
}
