//! The report of a model: what was proved, the sets, and what follows for other motions.

use reachtube_recordings::State;
use reachtube_scalar::number::{interval, significant};
use schemars::JsonSchema;
use serde::Serialize;
use serde_json::json;

use crate::model::file::Model;
use crate::result::dependence_report::dependence;
use crate::result::findings;
use crate::result::fit_report::fit;
use crate::tube::witness::Witness;
use reachtube_finding::{Finding, Report, Section, Table};

/// Largest number of touching values in the table.
const MOST_PLACES: usize = 6;

/// A model, as its file has it, with its findings.
#[derive(Serialize, JsonSchema)]
struct Printed<'a> {
    /// The model.
    #[serde(flatten)]
    model: &'a Model,
    /// What the answer says, statement by statement: the verdict first. The file is without them.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    findings: Vec<Finding>,
}

impl Model {
    /// Returns what the answer says, statement by statement: the verdict first, and last what must
    /// not be concluded, which is not in the report.
    #[must_use]
    pub fn findings(&self) -> Vec<Finding> {
        let mut findings = self.report().findings();
        findings.extend(findings::reach_of_proof(
            &self.proof,
            self.settings.states,
            &self.signals.noun,
        ));
        findings.extend(findings::beyond_recordings(&self.trust));
        findings
    }

    /// Returns the text of the model file with [`findings`](Self::findings) beside the model, as
    /// the command prints it. It can be read as a model file.
    #[must_use]
    pub fn to_json_with_findings(&self) -> String {
        reachtube_files::json::to_lines(&Printed { model: self, findings: self.findings() })
    }

    /// Returns the JSON schema of a model file, with or without findings beside the model.
    #[must_use]
    pub fn schema() -> serde_json::Value {
        let mut schema = reachtube_files::schema::<Printed<'_>>();
        // Only a model that was not proved may have no cost: a reachable set was lost.
        schema["if"] = json!({ "properties": { "verified": { "const": true } } });
        schema["then"] =
            json!({ "required": ["cost"], "properties": { "cost": { "type": "number" } } });
        schema
    }

    /// Returns the answer for people. A table of the sets is like Table II of the paper.
    #[must_use]
    pub fn report(&self) -> Report {
        let mut sections = vec![verdict(self), sets(self), fit(self)];
        if let Some(any) = &self.any_run {
            sections.push(Section { findings: vec![findings::any_run(any)], ..Section::default() });
        }
        sections.extend([touching(self), new_motions(self)]);
        sections.extend(dependence(self));
        sections.retain(|section| !section.is_empty());
        Report { sections }
    }
}

fn verdict(model: &Model) -> Section {
    let proof = &model.proof;
    let mut findings = vec![findings::verdict_of_fit(model)];
    findings.extend(findings::vacuous(model));
    findings.extend(findings::points(proof, model.settings.states));
    findings.extend(proof.lost.iter().map(Finding::from));
    let runs_away = model.search.as_ref().and_then(|search| search.runs_away.as_ref());
    findings.extend(runs_away.map(|(case, time)| findings::unstable(case, *time)));
    findings.push(findings::cost(model));
    let gap = model.gap_of_not_minimal();
    findings.extend(gap.map(findings::not_smallest));
    Section { findings, ..Section::default() }
}

fn sets(model: &Model) -> Section {
    let mut section = Section {
        tables: vec![table_of_sets(model)],
        findings: model.warnings.clone(),
        ..Section::default()
    };
    section.findings.extend(model.finding_of_stiction(&model.stiction));
    if let Some(noise) = &model.sensor_noise {
        let (q, qd) = noise.radius.split_at(model.inputs());
        let [position, velocity] = [0, 1].map(|at| model.signals.units_of_state(at).list());
        let list = |radii: &[f64]| spaced(radii.iter().map(|radius| format!("{radius:.1e}")));
        let source = match noise.estimated {
            true => "estimated from the recordings, 5 standard deviations",
            false => "given",
        };
        let radii = format!("q {} {position}; qd {} {velocity}", list(q), list(qd));
        section.fact(format!("sensor noise ({source})"), radii);
    }
    let (q, qd) = model.nominal_explains.split_at(model.inputs());
    let percent = |part: &Option<f64>| match part {
        Some(part) if *part > 0.0 => format!("{:.1}", 100.0 * part),
        Some(_) => "0".into(),
        None => "-".into(),
    };
    let list = |parts: &[Option<f64>]| spaced(parts.iter().map(percent));
    let by = model.signals.nominal.as_ref().map_or_else(String::new, |by| format!(", by {by}"));
    section.fact(
        format!("variance explained by the nominal motions{by}"),
        format!("q {} %; qd {} %", list(q), list(qd)),
    );
    if let Some(rates) = &model.settings.input_doubling {
        let unit = model.signals.units_of_state(1).list();
        let rates = spaced(rates.iter().map(|rate| significant(*rate, 3)));
        section
            .fact("U is twice that at rest where qd changes by", format!("{rates} {unit} per s"));
    }
    if !model.input_error.is_empty() {
        let unit = model.signals.units_of_inputs().list();
        let errors = spaced(model.input_error.iter().map(|error| format!("{error:.2}")));
        section.fact("RMS torque error", format!("{errors} {unit}"));
    }
    section
}

fn table_of_sets(model: &Model) -> Table {
    let n = model.inputs();
    let [q, qd] = [0, 1].map(|at| model.signals.units_of_state(at));
    let u = model.signals.units_of_inputs();
    let mut header = vec![
        model.signals.noun.clone(),
        q.head("X0 q"),
        qd.head("X0 qd"),
        u.head(model.name_of_input_set()),
    ];
    if model.noise_set.is_some() {
        header.extend([q.head("V q"), qd.head("V qd")]);
    }
    let row = |part: usize| {
        let mut row = vec![
            model.signals.parts[part].name.clone(),
            q.cell(part, interval(model.initial_set.bounds(part))),
            qd.cell(part, interval(model.initial_set.bounds(n + part))),
            u.cell(part, interval(model.input_set.bounds(part))),
        ];
        if let Some(noise) = &model.noise_set {
            row.push(q.cell(part, interval(noise.bounds(part))));
            row.push(qd.cell(part, interval(noise.bounds(n + part))));
        }
        row
    };
    Table::new(header, (0..n).map(row).collect())
}

/// Returns the recorded values that touch the reachable sets.
fn touching(model: &Model) -> Section {
    let signals = &model.signals;
    // Margins of both units stand in one column.
    let [q, qd] = [0, 1].map(|at| signals.units_of_state(at));
    let is_plain = q.shared().is_some() && qd.shared().is_some();
    let unit = |state: &State| match is_plain {
        true => String::new(),
        false => format!(" {}", signals.unit(*state)),
    };
    let row = |place: &Witness| {
        vec![
            place.run.clone(),
            format!("{:.3} s", place.time),
            place.state.to_string(),
            format!("{:?}", place.side).to_lowercase(),
            format!("{:.1e}{}", 0.0 - place.excess, unit(&place.state)),
        ]
    };
    let margin = match (q.shared(), qd.shared()) {
        (Some(q), Some(qd)) => format!("margin [{q}, {qd}]"),
        _ => "margin".into(),
    };
    let rows: Vec<_> = model.tight.iter().map(row).collect();
    let table = Table::new(["run", "time", "state", "side", &margin], rows).cut_to(MOST_PLACES);
    let tables = if model.tight.is_empty() { Vec::new() } else { vec![table] };
    Section { findings: vec![findings::touching(model)], tables, ..Section::default() }
}

fn new_motions(model: &Model) -> Section {
    let calibrated = model.calibration.as_ref().map(findings::calibrated);
    let bound = findings::next_motion_of_fit(model);
    Section { findings: calibrated.into_iter().chain([bound]).collect(), ..Section::default() }
}

fn spaced(values: impl Iterator<Item = String>) -> String {
    values.collect::<Vec<_>>().join(" ")
}
