//! Assembly of a page from a model and recordings.

use reachtube_arm::ArmModel;
use reachtube_arm::Equations;
use reachtube_conform::Code;
use reachtube_conform::Model;
use reachtube_conform::model::Provenance;
use reachtube_conform::settings::States;
use reachtube_finding::Finding;
use reachtube_reach::Hyperrectangle;
use reachtube_recordings::{Preparation, Torque};
use reachtube_scalar::number::counted;

use crate::cost::{cost_charts, cost_tables, cost_unit, sum_unit};
use crate::error::Result;
use crate::lead::lead;
use crate::nominal::{nominal_facts, nominal_tables};
use crate::page::{JointSets, Page, SetsTable, Verdict};
use crate::phase_planes::phase_planes;
use crate::sources::{Sources, joint_name};
use crate::suites::suite_figures;

/// Makes the page of a model over recordings: the recordings that it was made from, or others.
///
/// # Errors
///
/// As [`Problem::run`](reachtube_conform::Problem::run);
/// [`Error::NoReachableSet`](super::Error::NoReachableSet) for a suite without one.
pub fn page(sources: &Sources) -> Result<Page> {
    let Sources { model, problem, check, .. } = *sources;
    let (figures, arm) = (suite_figures(sources)?, model.arm());
    Ok(Page {
        title: format!("{}: reachset conformance", arm.robot.name),
        subtitle: format!(
            "Model {} of order {}{}, {} in {}",
            u32::from(arm.settings.abstraction.model),
            arm.settings.abstraction.order,
            match arm.settings.equations {
                Equations::Model => "",
                Equations::Robot => " about nominal motions by the robot's own equations",
                _ => " of accelerations, without the robot",
            },
            counted(check.verdict.runs, "recording"),
            counted(check.verdict.suites.len(), "test suite")
        ),
        verdict: verdict(sources),
        lead: lead(sources)?,
        cost: cost_tables(model, &figures),
        cost_charts: cost_charts(&figures),
        suites: figures,
        phase_planes: phase_planes(problem, model)?,
        nominal: nominal_tables(model),
        sets: vec![sets_table(model)],
        facts: [nominal_facts(model), facts(model), compared(sources)].concat(),
        trust: trust(sources),
        caution: caution(sources),
        notes: check.notes.clone(),
    })
}

/// Sets what the library found about the answer among the figures: the verdict and what lies
/// furthest outside, warnings, and what was proved and what was not.
fn verdict(sources: &Sources) -> Verdict {
    let Sources { model, check, .. } = *sources;
    let of_check = |codes: &[Code]| of_codes(sources, &check.findings, codes);
    let said = [Code::Vacuous, Code::FurthestOutside];
    let beside = check
        .findings
        .iter()
        .filter(|found| Code::of(&found.code).is_some_and(|code| said.contains(&code)));
    let headline = check.findings.first().into_iter().chain(beside);
    let words: Vec<String> = headline.map(|found| sentence(sources, found)).collect();
    let warnings = model.warnings.iter().cloned();
    let mut proved = of_check(&[Code::Points, Code::Rows]);
    let band = "The grey band is an outer bound of the model's reachable set at the samples";
    proved.push(match model.noise_set {
        None => format!("{band}."),
        Some(_) => {
            format!("{band}, without the measurement noise V: recordings may leave it by V.")
        }
    });
    let mut not_proved = of_check(&[Code::AtSamples, Code::Notion, Code::OuterSet]);
    if model.settings.states == States::Positions {
        not_proved.push("Velocities are not compared with the set, and may lie outside it.".into());
    }
    not_proved.extend(of_check(&[Code::SetLost]));
    Verdict {
        ok: check.verdict.conformant,
        vacuous: model.is_vacuous(),
        useful: None,
        words: words.join(" "),
        warnings: warnings.map(|warning| sentence(sources, &warning)).collect(),
        proved,
        not_proved,
    }
}

fn sets_table(model: &Model) -> SetsTable {
    let n = model.inputs();
    let bounds = |set: &Hyperrectangle, i: usize| <[f64; 2]>::from(set.bounds(i));
    let row = |joint: usize| JointSets {
        joint: joint_name(model, joint),
        kind: model.arm().robot.joints[joint].kind,
        x0_q: bounds(&model.initial_set, joint),
        x0_qd: bounds(&model.initial_set, n + joint),
        u: bounds(&model.input_set, joint),
        noise: model
            .noise_set
            .as_ref()
            .map(|noise| [bounds(noise, joint), bounds(noise, n + joint)]),
    };
    let notion = match model.settings.states {
        States::All => "Position and velocity conformant",
        States::Positions => "Position conformant",
    };
    SetsTable { notion: notion.into(), joints: (0..n).map(row).collect() }
}

/// The name of the radii that were added to the sets.
const ALLOWANCE: &str = "Allowance added to the smallest X0, then U [SI units]";

/// The name of the rates at which U is twice what it is at rest.
const DOUBLING: &str =
    "U, given at rest, is twice as large where the nominal motion has [rad/s² or m/s²]";

fn facts(model: &Model) -> Vec<(String, String)> {
    let settings = &model.settings;
    let suites: Vec<&str> = model.data.suites.iter().map(|suite| suite.name.as_str()).collect();
    let runs: usize = model.data.run_count();
    let number =
        |value: Option<f64>| value.map_or_else(|| "none".into(), |value| format!("{value:.6}"));
    let cost = match (
        model.cost_lower_bound,
        model.search.as_ref().and_then(|search| search.linearised_cost),
    ) {
        (Some(bound), _) => {
            let gap = model.gap_of_not_minimal();
            let not = gap.map_or_else(String::new, |gap| format!("; not minimal, gap {gap:.1e}"));
            format!("{} (lower bound {bound:.6}{not})", number(model.cost))
        }
        (None, Some(linearised)) => format!("{} (linearised {linearised:.6})", number(model.cost)),
        (None, None) => number(model.cost),
    };
    let arm = model.arm();
    let volume = model.hull_volume.map_or_else(|| "none".into(), |volume| format!("{volume:.4e}"));
    let cost_name = format!("Cost {}", cost_unit(model));
    let samples_name = format!("Cost summed over samples, as in the paper {}", sum_unit(model));
    let paper_name = format!("The paper's sum (21), with E for |E| {}", sum_unit(model));
    [
        (&*cost_name, cost),
        (&samples_name, number(model.cost_of_samples)),
        (&paper_name, number(model.cost_paper)),
        ("Volume of the hull, eq. (2) [s times the states' SI units]", volume),
        ("Sets found by", word(settings.method)),
        ("Notion of conformance", word(settings.notion)),
        ("Disturbance", word(settings.disturbance)),
        ("Centres of the sets", word(settings.centre)),
        ("States enclosed", word(settings.states)),
        ("Weights [SI units]", word(&settings.weights)),
        ("Measurement noise [SI units]", word(&settings.noise)),
        ("Nominal motion starts at", word(settings.nominal)),
        ("Nominal motion satisfies the equations of", word(arm.settings.equations)),
        ("Recorded torque", recorded_torque(arm.settings.torque, model.preparation.as_ref())),
        ("Fitted to", format!("{runs} runs of suites {}", suites.join(", "))),
        ("SHA-256 of the data", model.data.sha256.clone()),
        ("Written by", model.tool.clone()),
        ("SHA-256 of the model", model.sha256.clone()),
    ]
    .into_iter()
    .chain(settings.input_doubling.iter().map(|rates| (DOUBLING, word(rates))))
    .chain((!model.allowance.is_empty()).then(|| (ALLOWANCE, word(&model.allowance))))
    .map(|(name, value)| (name.to_string(), value))
    .collect()
}

/// Returns the kind of the recorded torques. A model that was made of logs has an input that was
/// prepared from the torques of the logs.
fn recorded_torque(of_input: Torque, preparation: Option<&Preparation>) -> String {
    match preparation.filter(|done| done.torque != of_input) {
        Some(done) => format!("{}, prepared as {} input", word(done.torque), word(of_input)),
        None => word(of_input),
    }
}

/// Returns what of the verdict is not the model's own: the recordings, the notion, and the end of
/// the recordings.
fn compared(sources: &Sources) -> Vec<(String, String)> {
    let Sources { model, check, .. } = *sources;
    let Provenance { settings, data, .. } = &check.provenance;
    let mut facts = Vec::new();
    let mut add = |name: &str, value: String| facts.push((name.to_string(), value));
    if let Some(until) = settings.until {
        add("Samples used", format!("up to {until} s after the first"));
    }
    if settings.notion != model.settings.notion {
        add("Notion of this verdict", word(settings.notion));
    }
    if data.sha256 != model.data.sha256 {
        let suites: Vec<&str> = data.suites.iter().map(|suite| suite.name.as_str()).collect();
        let runs = data.run_count();
        add("Compared with", format!("{runs} runs of suites {}", suites.join(", ")));
        add("SHA-256 of these recordings", data.sha256.clone());
    }
    facts
}

/// Returns a setting in the word that the model file has for it.
fn word(setting: impl serde::Serialize) -> String {
    let value = serde_json::to_value(setting).unwrap_or_default();
    value.as_str().map_or_else(|| value.to_string(), str::to_string)
}

/// Returns the bound for the next motion: from the check if it has one, or else from the fit.
fn trust(sources: &Sources) -> Vec<String> {
    let Sources { model, check, .. } = *sources;
    let bounds = [Code::NextMotion, Code::NoGuarantee];
    match check.trust {
        Some(_) => of_codes(sources, &check.findings, &bounds),
        None => of_codes(sources, &model.findings(), &bounds),
    }
}

fn caution(sources: &Sources) -> Vec<String> {
    let codes = [
        Code::RecordedOnly,
        Code::NotSmallest,
        Code::FewMotions,
        Code::ParametersMoved,
        Code::LeftOut,
        Code::RobotChanged,
    ];
    of_codes(sources, &sources.model.findings(), &codes)
}

/// Returns the findings of some codes as sentences, in the order of the codes.
fn of_codes(sources: &Sources, findings: &[Finding], codes: &[Code]) -> Vec<String> {
    let of = |code: Code| findings.iter().filter(move |finding| finding.code == code);
    codes.iter().copied().flat_map(of).map(|finding| sentence(sources, finding)).collect()
}

fn sentence(sources: &Sources, finding: &Finding) -> String {
    as_sentence(&finding.written_for(sources.front_end))
}

/// Returns words with a capital letter in front and a full stop at the end.
pub(super) fn as_sentence(words: &str) -> String {
    let (first, rest) = words.split_at(words.chars().next().map_or(0, char::len_utf8));
    let end = if rest.ends_with(['.', ':']) { "" } else { "." };
    format!("{}{rest}{end}", first.to_uppercase())
}

#[cfg(test)]
mod tests {
    use super::*;
    use reachtube_recordings::{ColumnSettings, LogSettings};

    #[test]
    fn the_torque_of_a_prepared_model_is_that_of_its_logs() {
        let prepared = |torque| Preparation {
            torque,
            gains: Vec::new(),
            cut_off: None,
            window: Some(0.5),
            differentiated: false,
            columns: ColumnSettings::default(),
            log: LogSettings::default(),
        };
        let words = |torque| recorded_torque(Torque::Compensated, Some(&prepared(torque)));
        assert_eq!(words(Torque::Motor), "motor, prepared as compensated input");
        assert_eq!(words(Torque::Compensated), "compensated");
        assert_eq!(recorded_torque(Torque::Link, None), "link");
    }
}
