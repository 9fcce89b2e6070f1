//! Assembly of a page from a model and recordings.

use reachtube_conform::{
    self as conform, Check, Code, Enclosure, Equations, Finding, LeftOut, Model, Notion, States,
};
use reachtube_reach::Hyperrectangle;

use crate::cost::{cost_charts, cost_tables};
use crate::error::Result;
use crate::nominal::{nominal_caution, nominal_facts, nominal_tables};
use crate::notion::{outside_points, phase_planes, place, together, traces};
use crate::page::{JointSets, Page, SetsTable, Verdict};
use crate::sources::{Sources, joint_name};
use crate::suites::suite_figures;
use reachtube_scalar::number::at_least;

/// Makes the page of a model over recordings: the recordings that it was made from, or others.
///
/// # Errors
///
/// As [`Problem::run`](reachtube_conform::Problem::run);
/// [`Error::NoReachableSet`](super::Error::NoReachableSet) for a suite without one.
pub fn page(sources: &Sources) -> Result<Page> {
    let Sources { model, problem, check, .. } = *sources;
    let figures = suite_figures(sources)?;
    Ok(Page {
        title: format!("{}: reachset conformance", model.robot.name),
        subtitle: format!(
            "Model {} of order {}{}, {} recordings in {} test suites",
            u32::from(model.settings.abstraction.model),
            model.settings.abstraction.order,
            match model.settings.equations {
                Equations::Model => "",
                Equations::Robot => " about nominal motions by the robot's own equations",
            },
            check.verdict.runs,
            check.verdict.suites.len()
        ),
        verdict: verdict(model, check),
        cost: cost_tables(model, &figures),
        cost_charts: cost_charts(&figures),
        suites: figures,
        phase_planes: phase_planes(problem, model)?,
        nominal: nominal_tables(model),
        sets: vec![sets_table(model)],
        facts: [nominal_facts(model), facts(model)].concat(),
        trust: vec![trust(model, check)],
        caution: caution(model),
        notes: check.notes.clone(),
    })
}

fn verdict(model: &Model, check: &Check) -> Verdict {
    let answer = &check.verdict;
    let outer = answer.enclosure == Enclosure::Outer;
    let set = answer.enclosure.set_name();
    let (outside, rows) = (answer.violations.count, answer.rows);
    let words = match &answer.violations.worst {
        _ if answer.conformant => format!(
            "All {} recordings lie in {} at every sample{}.",
            answer.runs,
            place(answer),
            together(answer)
        ),
        _ if outside == 0 => outside_points(answer, model),
        None => format!("{outside} of {rows} rows have no {set}."),
        Some(worst) => format!(
            "{outside} of {rows} rows leave the {set}; the furthest is {} at {:.3} s, {} by \
             {:.3e}.",
            worst.run, worst.time, worst.state, worst.excess
        ),
    };
    let states = match model.settings.states {
        States::All => "position and velocity",
        States::Positions => "position",
    };
    let points = answer.points.as_ref().map(|points| {
        format!(
            "{} of {} recorded points lie in {}{}, proved with directed rounding.",
            points.points - points.unproved,
            points.points,
            place(answer),
            together(answer)
        )
    });
    let band = "The grey band is an outer bound of the model's reachable set at the samples";
    let rows_hold = [
        format!(
            "{} of {rows} rows (suite, sample, state) hold, checked with directed rounding: the \
             recorded {states} lies in the interval hull of the {set}.",
            rows - outside,
        ),
        match model.noise_set {
            None => format!("{band}."),
            Some(_) => {
                format!("{band}, without the measurement noise V: recordings may leave it by V.")
            }
        },
    ];
    let proved = traces(answer).into_iter().chain(points).chain(rows_hold).collect();
    let mut not_proved = not_proved(model, answer, outer);
    not_proved.extend(answer.lost.iter().map(|lost| sentence(&Finding::from(lost))));
    let warnings = model.warnings.iter().map(|warning| sentence(&Finding::from(warning))).collect();
    Verdict { ok: answer.conformant, words, warnings, proved, not_proved }
}

/// Returns what a reader must not take for proved.
fn not_proved(model: &Model, answer: &conform::Verdict, outer: bool) -> Vec<String> {
    let notion = match answer.points.as_ref().map_or(Notion::Hull, |points| points.notion) {
        Notion::Hull => {
            "The notion is the hull, which bounds each state separately. A point inside the hull \
             need not be reachable."
        }
        Notion::PhasePlane => {
            "The notion is the phase plane, which takes position and velocity of each joint \
             together, and each joint by itself. States of several joints need not be reachable \
             together."
        }
        Notion::Exact => {
            "The notion is exact: all states at one sample are reachable together. Whether one \
             motion of the model passes through the states of all samples is not said."
        }
        Notion::Trace => {
            "The notion is trace: up to V, one motion of the model passes through the states of \
             all samples. V is what the recordings were allowed to be wrong by."
        }
    };
    let mut words = vec![
        "The recordings are compared with the set at samples. Between samples only the model's own \
         states are enclosed, in the tube that the command reachtube reach writes."
            .into(),
        notion.into(),
    ];
    if outer {
        words.push(
            "The model is not linear: its reachable set was computed as an outer enclosure, which \
             is what a formal analysis uses. A recording in it need not be a behaviour of the \
             model itself. The recordings that decide the sets touch the linearised set, not the \
             wider band."
                .into(),
        );
    }
    let explanations = of_codes(&model.findings(), &[Code::Explanations]);
    words.extend(explanations.map(|found| format!("Searched for, not proved: {found}")));
    words
}

fn sets_table(model: &Model) -> SetsTable {
    let n = model.joints();
    let bounds = |set: &Hyperrectangle, i: usize| <[f64; 2]>::from(set.bounds(i));
    let row = |joint: usize| JointSets {
        joint: joint_name(model, joint),
        kind: model.robot.joints[joint].kind,
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
    let volume = model.hull_volume.map_or_else(|| "none".into(), |volume| format!("{volume:.4e}"));
    [
        ("Cost", cost),
        ("The paper's sum (21)", number(model.cost_paper)),
        ("Volume of the hull, eq. (2)", volume),
        ("Sets found by", word(settings.method)),
        ("Notion of conformance", word(settings.notion)),
        ("Disturbance", word(settings.disturbance)),
        ("Centres of the sets", word(settings.centre)),
        ("States enclosed", word(settings.states)),
        ("Weights", word(&settings.weights)),
        ("Measurement noise", word(&settings.noise)),
        ("Nominal solution starts at", word(settings.nominal)),
        ("Nominal solution satisfies the equations of", word(settings.equations)),
        ("Recorded torque", word(settings.torque)),
        ("Fitted to", format!("{runs} runs of suites {}", suites.join(", "))),
        ("SHA-256 of the data", model.data.sha256.clone()),
        ("Written by", model.tool.clone()),
    ]
    .into_iter()
    .map(|(name, value)| (name.to_string(), value))
    .collect()
}

/// Returns a setting in the word that the model file has for it.
fn word(setting: impl serde::Serialize) -> String {
    let value = serde_json::to_value(setting).unwrap_or_default();
    value.as_str().map_or_else(|| value.to_string(), str::to_string)
}

fn trust(model: &Model, check: &Check) -> String {
    let bounds = [Code::NextMotion, Code::NoGuarantee];
    let of_check = of_codes(&check.findings, &bounds).filter(|_| check.trust.is_some());
    of_check.or_else(|| of_codes(&model.findings(), &bounds)).unwrap_or_default()
}

/// Returns the first finding of some codes as a sentence.
fn of_codes(findings: &[Finding], codes: &[Code]) -> Option<String> {
    findings.iter().find(|finding| codes.contains(&finding.code)).map(sentence)
}

/// Returns a finding as a sentence.
fn sentence(finding: &Finding) -> String {
    let words = finding.to_string();
    let (first, rest) = words.split_at(words.chars().next().map_or(0, char::len_utf8));
    format!("{}{rest}", first.to_uppercase())
}

fn caution(model: &Model) -> Vec<String> {
    let mut words = vec![
        "It is a fact about these recordings that the sets enclose them. It implies nothing \
         certain about motions, payloads or temperatures that were not recorded."
            .to_string(),
    ];
    let findings = model.findings();
    words.extend(of_codes(&findings, &[Code::NotSmallest]));
    if model.trust.violation_probability > 0.5 {
        words.push(
            "There are too few independent motions for a useful bound on the next motion. Record \
             more motions rather than more runs of the same motions."
                .into(),
        );
    }
    words.extend(nominal_caution(model));
    words.extend(furthest_motion(model));
    words.extend(of_codes(&findings, &[Code::RobotChanged]));
    words
}

/// Says how far the motion that the others foretell least lies outside their sets.
fn furthest_motion(model: &Model) -> Option<String> {
    let growth = |left: &LeftOut| left.gauge.unwrap_or(f64::INFINITY);
    let computed = model.left_out.iter().filter(|left| left.cost.is_some());
    let left = computed.max_by(|a, b| growth(a).total_cmp(&growth(b)))?;
    let motion = &left.motion;
    let words = match left.gauge {
        Some(gauge) if gauge > 1.0 => format!(
            "The sets found without motion {motion} would have to grow {} times to hold it.",
            at_least(gauge)
        ),
        Some(_) => return None,
        None => format!(
            "No growth was found under which the sets found without motion {motion} hold it."
        ),
    };
    Some(format!(
        "{words} Another motion may lie as far out. This describes the recorded motions and bounds \
         no probability."
    ))
}
