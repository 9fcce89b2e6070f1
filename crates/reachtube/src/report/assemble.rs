//! Assembly of a page from a model and recordings.

use super::{
    Band, JointSets, Nominal, Page, RunTrace, SetsTable, Side, SuiteFigure, TightSpot, Verdict,
};
use crate::error::{Error, Result};
use reachtube_conform::Model;
use reachtube_conform::SuiteReach;
use reachtube_conform::{self as conform, Check, Enclosure, Lost, Recordings, Settings, States};
use reachtube_reach::Hyperrectangle;
use reachtube_recordings::DataSet;

/// The sources of a page.
#[derive(Debug, Clone, Copy)]
pub struct Sources<'a> {
    /// The model.
    pub model: &'a Model,
    /// The settings for reading the recordings.
    pub settings: &'a Settings,
    /// The data set to draw.
    pub data: &'a DataSet,
    /// The suites of the data set, as read.
    pub recordings: &'a Recordings,
    /// The reachable sets of the suites.
    pub reach: &'a [SuiteReach],
    /// The check whether the recordings lie in the reachable sets.
    pub check: &'a Check,
}

/// Returns the page of a model over recordings: those that it was made from, or others.
///
/// # Errors
///
/// Fails for a suite without a reachable set, and for defects of a run that has changed since it
/// was read.
pub fn page(sources: &Sources) -> Result<Page> {
    let Sources { model, check, .. } = *sources;
    let figures = sources
        .recordings
        .suites
        .iter()
        .filter(|suite| suite.envelope.len() > 1)
        .map(|suite| figure(sources, suite))
        .collect::<Result<Vec<_>>>()?;
    Ok(Page {
        title: format!("{}: reachset conformance", model.robot.name),
        subtitle: format!(
            "Model {} of order {}, {} recordings in {} test suites",
            u32::from(model.settings.abstraction.model),
            model.settings.abstraction.order,
            check.runs,
            check.suites.len()
        ),
        verdict: verdict(model, check),
        suites: figures,
        sets: vec![sets_table(model)],
        facts: facts(model),
        trust: vec![trust(model, check)],
        caution: caution(model),
        notes: check.notes.clone(),
    })
}

fn verdict(model: &Model, check: &Check) -> Verdict {
    let outer = model.proof.enclosure == Enclosure::Outer;
    let set = if outer { "computed reachable set" } else { "reachable set" };
    let words = match &check.violations.worst {
        _ if check.conformant => {
            format!(
                "All {} recordings lie in the interval hull of the {set} at every sample.",
                check.runs
            )
        }
        None => {
            format!("{} of {} rows have no {set}.", check.violations.count, check.rows)
        }
        Some(worst) => format!(
            "{} of {} rows leave the {set}; the furthest is {} at {:.3} s, {} by {:.3e}.",
            check.violations.count, check.rows, worst.run, worst.time, worst.state, worst.excess
        ),
    };
    let states = match model.settings.states {
        States::All => "position and velocity",
        States::Positions => "position",
    };
    let proved = vec![
        format!(
            "{} of {} rows (suite, time, state) hold, checked with directed rounding: the recorded \
             {states} lies in the interval hull of the {set}.",
            check.rows - check.violations.count,
            check.rows,
        ),
        match model.noise_set {
            None => "The grey band is an outer bound of the reachable set at the samples.".into(),
            Some(_) => "The grey band is an outer bound of the reachable set at the samples, \
                        without the measurement noise V: recordings may leave the band by V."
                .into(),
        },
    ];
    let mut not_proved = vec![
        "The recordings are compared with the set at samples. Between samples only the model's \
         own states are enclosed, in the tube that the command reachtube reach writes."
            .into(),
        "The notion is the hull, which bounds each state separately. A point inside the hull need \
         not be reachable."
            .into(),
    ];
    if outer {
        not_proved.push(
            "The model is not linear: its reachable set was computed as an outer enclosure, as in \
             a formal analysis. A recording inside the enclosure need not be a behaviour of the \
             model itself. The recordings that decide the sets touch the linearised set, not the \
             wider band."
                .into(),
        );
    }
    if let Some((explained, tolerance)) = model.explained.as_ref().zip(model.settings.explain) {
        not_proved.push(format!(
            "Explanations were searched for, not proved: {}.",
            explained.words(tolerance)
        ));
    }
    let end = |lost: &Lost| {
        format!(
            "{}: the reachable set could not be computed beyond {:.3} s ({}).",
            lost.case, lost.time, lost.state
        )
    };
    not_proved.extend(check.lost.iter().map(end));
    Verdict { ok: check.conformant, words, proved, not_proved }
}

fn sets_table(model: &Model) -> SetsTable {
    let n = model.joints();
    let bounds = |set: &Hyperrectangle, i: usize| <[f64; 2]>::from(set.bounds(i));
    let row = |joint: usize| JointSets {
        joint: joint_name(model, joint),
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

fn joint_name(model: &Model, joint: usize) -> String {
    model
        .robot
        .joints
        .get(joint)
        .map_or_else(|| format!("{}", joint + 1), |description| description.name.clone())
}

fn facts(model: &Model) -> Vec<(String, String)> {
    let settings = &model.settings;
    let suites: Vec<&str> = model.data.suites.iter().map(|suite| suite.name.as_str()).collect();
    let runs: usize = model.data.suites.iter().map(|suite| suite.runs.len()).sum();
    let number =
        |value: Option<f64>| value.map_or_else(|| "none".into(), |value| format!("{value:.6}"));
    let cost = match (
        model.cost_lower_bound,
        model.search.as_ref().and_then(|search| search.linearised_cost),
    ) {
        (Some(bound), _) => format!("{} (lower bound {bound:.6})", number(model.cost)),
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
        ("Recorded torque", word(settings.torque)),
        ("Fitted to", format!("{runs} runs of suites {}", suites.join(", "))),
        ("SHA-256 of the data", model.data.sha256.clone()),
        ("Written by", model.tool.clone()),
    ]
    .into_iter()
    .map(|(name, value)| (name.to_string(), value))
    .collect()
}

/// Returns a setting as the model file writes it.
fn word(setting: impl serde::Serialize) -> String {
    let value = serde_json::to_value(setting).unwrap_or_default();
    value.as_str().map_or_else(|| value.to_string(), str::to_string)
}

fn trust(model: &Model, check: &Check) -> String {
    let (trust, role) = match &check.trust {
        Some(held_out) => (held_out, "leave the reachable set"),
        None => (&model.trust, "touch the reachable set"),
    };
    format!(
        "The next motion leaves the reachable set with probability at most {:.3}, at confidence \
         {:.0} %: {} independent motions, of which {} {role}; {}.",
        trust.violation_probability,
        100.0 * trust.confidence,
        trust.motions,
        trust.deciding,
        trust.basis
    )
}

fn caution(model: &Model) -> Vec<String> {
    let mut words = vec![
        "It is a fact about these recordings that the sets enclose them. It implies nothing \
         certain about motions, payloads or temperatures that were not recorded."
            .to_string(),
    ];
    if model.trust.violation_probability > 0.5 {
        words.push(
            "There are too few independent motions for a useful bound on the next motion. Record \
             more motions rather than more runs of the same motions."
                .into(),
        );
    }
    words
}

fn figure(sources: &Sources, suite: &conform::Suite) -> Result<SuiteFigure> {
    let Sources { model, data, check, reach, .. } = *sources;
    let joints = model.joints();
    let own: Vec<&SuiteReach> =
        reach.iter().filter(|reach| reach.suite == suite.entry.name).collect();
    let longest = own.iter().max_by_key(|reach| reach.times.len()).copied();
    let Some(longest) = longest else {
        return Err(Error::Setting(format!(
            "no reachable set was computed for suite {}",
            suite.entry.name
        )));
    };
    let shared = longest.run.is_none();
    let mut runs = Vec::new();
    for (order, summary) in suite.runs.iter().enumerate() {
        let entry = &data.runs()[summary.index];
        let of_run =
            own.iter().find(|reach| reach.run.as_deref().is_none_or(|run| run == entry.file));
        runs.push(trace(sources, summary.index, order, of_run.filter(|_| !shared).copied())?);
    }
    let nominal = columns(&longest.nominal, 2 * joints);
    // Runs with their own nominal solutions share the hull of their deviations.
    let relative = |of: fn(&SuiteReach) -> &[f64], further: fn(f64, f64) -> f64| {
        let deviation = |reach: &&SuiteReach, at: usize| {
            of(reach).get(at).map(|x| if shared { *x } else { x - reach.nominal[at] })
        };
        let hull = |at: usize| own.iter().filter_map(|reach| deviation(reach, at)).reduce(further);
        let values: Vec<f64> = (0..longest.nominal.len()).filter_map(hull).collect();
        columns(&values, 2 * joints)
    };
    let name =
        |file: &String| suite.runs.iter().position(|run| data.runs()[run.index].file == *file);
    let tight = model.tight.iter().filter(|place| place.suite == suite.entry.name);
    let violated = check.suites.iter().filter(|own| own.suite == suite.entry.name);
    let worst = violated.filter_map(|own| own.violations.worst.as_ref());
    let spots: Vec<TightSpot> = tight
        .chain(worst)
        .filter_map(|place| Some(spot(place, name(&place.run)?, joints)))
        .collect();
    for spot in &spots {
        runs[spot.run].touches += 1;
    }
    Ok(SuiteFigure {
        suite: suite.entry.name.clone(),
        joints: (0..joints).map(|joint| joint_name(model, joint)).collect(),
        times: longest.times.clone(),
        band: Band {
            label: "reachable set".into(),
            lower: relative(|reach| &reach.lower, f64::min),
            upper: relative(|reach| &reach.upper, f64::max),
        },
        inner: None,
        nominal: if shared { Nominal::Shared(nominal) } else { Nominal::PerRun },
        runs,
        tight: spots,
    })
}

fn spot(place: &conform::Place, run: usize, joints: usize) -> TightSpot {
    let state =
        if place.state.starts_with("qd") { joints + place.joint - 1 } else { place.joint - 1 };
    let side = match place.side {
        conform::Side::Upper => Side::Upper,
        conform::Side::Lower => Side::Lower,
    };
    TightSpot { run, time_s: place.time, state, side, margin: -place.excess }
}

/// Returns a run as a line, relative to its own nominal solution where it has one.
fn trace(
    sources: &Sources,
    index: usize,
    order: usize,
    own: Option<&SuiteReach>,
) -> Result<RunTrace> {
    let Sources { model, settings, data, .. } = *sources;
    let run = data
        .read(index, Some(model.joints()), settings.gap_limit, settings.until)
        .map_err(reachtube_recordings::Error::Defects)?;
    let mut states = run.states.clone();
    if let Some(own) = own {
        states.iter_mut().zip(&own.nominal).for_each(|(x, nominal)| *x -= nominal);
    }
    Ok(RunTrace {
        name: data.runs()[index].file.clone(),
        order,
        temperature: data.runs()[index].temperature,
        times: run.times.iter().map(|t| t - run.times[0]).collect(),
        states: columns(&states, 2 * model.joints()),
        touches: 0,
    })
}

/// Turns values, row-major samples x states, into one list per state.
fn columns(values: &[f64], states: usize) -> Vec<Vec<f64>> {
    (0..states).map(|i| values.iter().skip(i).step_by(states).copied().collect()).collect()
}
