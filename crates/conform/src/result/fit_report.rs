//! What a report says of a fit of the nominal model.

use reachtube_scalar::number::four_decimals;

use crate::fit::record::{FitRecord, FittedParameter, TorquePrediction, UnseenMotion};
use crate::model::file::Model;
use crate::result::findings;
use reachtube_finding::{Section, Table};

/// The column of standard errors in the table of parameters.
const STANDARD_ERROR: usize = 3;

pub(super) fn fit(model: &Model) -> Section {
    let Some(record) = &model.fit else { return Section::default() };
    let mut section = Section::default();
    section.findings.push(findings::fitted(record, !model.a.is_empty()));
    section.findings.extend(findings::parameters_moved(record));
    let all = record.parameters.iter();
    let changed: Vec<&FittedParameter> = all.filter(|p| p.has_changed()).collect();
    if !changed.is_empty() {
        section.tables.push(parameters(model, record, &changed));
    }
    let kept = record.parameters.len() - changed.len();
    if kept > 0 {
        section.fact("unchanged", format!("{kept} of {} parameters", record.parameters.len()));
    }
    let list = |all: Vec<String>| all.join(", ");
    let groups = record.groups.iter();
    let groups = groups.map(|group| format!("{} {}", group.group.name(), cost(group.cost_without)));
    section.fact("cost without a group, the others fitted again", list(groups.collect()));
    if !record.dropped.is_empty() {
        let dropped = record.dropped.iter().map(|group| group.name().to_string()).collect();
        section
            .fact("groups that were not fitted, since the fit carries over better", list(dropped));
    }
    let of = |left: &UnseenMotion| format!("{} {}", left.motion, cost(left.cost));
    let each = list(record.leave_one_out.iter().map(of).collect());
    section.fact(
        "cost with one motion left out of the fit",
        format!("{each}; mean {}", cost(record.left_out_mean())),
    );
    if let [Some(identified), Some(fitted)] = record.carried_over() {
        section.fact(
            "cost of the sets without a motion, grown until they enclose it",
            format!(
                "mean {}, with the identified model {}",
                four_decimals(fitted),
                four_decimals(identified)
            ),
        );
    }
    if let Some(before) = record.identified_calibrated_cost {
        section.fact("cost of calibrated sets with the identified model", four_decimals(before));
    }
    let noun = &model.signals.noun;
    let name = |when: &str| format!("RMS torque error {when}, {noun} by {noun}");
    section.fact(name("before"), torque(record, |t| t.identified));
    section.fact(name("after"), torque(record, |t| t.fitted));
    section
}

fn cost(cost: Option<f64>) -> String {
    cost.map_or_else(|| "none (a nominal motion runs away)".into(), four_decimals)
}

fn parameters(model: &Model, record: &FitRecord, changed: &[&FittedParameter]) -> Table {
    let row = |p: &&FittedParameter| {
        vec![
            model.signals.parts[p.part - 1].name.clone(),
            p.name.clone(),
            format!("{} {}", four_decimals(p.identified), p.unit),
            p.standard_error.map_or_else(|| "-".into(), four_decimals),
            four_decimals(p.fitted),
            p.factor.map_or_else(String::new, |factor| format!("{factor:.3}")),
            if p.is_beyond_error() { "beyond error".into() } else { String::new() },
        ]
    };
    let header = [&model.signals.noun, "parameter", "identified", "±", "fitted", "factor", ""];
    let mut table = Table::new(header, changed.iter().map(row).collect());
    if record.parameters.iter().all(|p| p.standard_error.is_none()) {
        table.rows.iter_mut().for_each(|row| drop(row.remove(STANDARD_ERROR)));
        table.header.remove(STANDARD_ERROR);
    }
    table
}

fn torque(record: &FitRecord, of: fn(&TorquePrediction) -> f64) -> String {
    let values = record.torque.iter().map(|torque| format!("{:.2}", of(torque)));
    values.collect::<Vec<_>>().join(" ")
}
