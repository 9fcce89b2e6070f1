//! The text that `conform` prints.

use std::fmt::Write;

use reachtube::Model;
use reachtube::conform::{Enclosure, MOST_TIGHT, Place};

use crate::numbers::{interval, number};
use crate::table::{plural, table};
use crate::verdict::{lost, trust};

/// The result of `conform`, with a table like Table II of the paper.
pub fn summary(model: &Model) -> String {
    let runs: usize = model.data.suites.iter().map(|suite| suite.runs.len()).sum();
    let mut text = String::new();
    let verdict = if model.verified { "conformant" } else { "NOT PROVED conformant" };
    let (suites, proof) = (model.data.suites.len(), &model.proof);
    let how = match proof.enclosure {
        Enclosure::Inner => "proved with directed rounding",
        Enclosure::Outer => {
            "in the computed reachable set, an outer enclosure with directed rounding"
        }
    };
    let _ = writeln!(
        text,
        "{verdict}: {runs} {} in {suites} {}; {} of {} bounds (suite, sample, state, side) {how}, at samples",
        plural(runs, "recording"),
        plural(suites, "suite"),
        proof.proved,
        proof.rows
    );
    proof.lost.iter().for_each(|lost| text.push_str(&format!("{}\n", self::lost(lost))));
    if let Some((case, time)) = model.search.as_ref().and_then(|search| search.runs_away.as_ref()) {
        let _ = writeln!(
            text,
            "{case}: a simulated motion under nearly these sets ran away before {time:.3} s: the model is unstable there"
        );
    }
    let _ = writeln!(text, "{}\n", cost(model));
    text.push_str(&sets(model));
    let touched = match proof.enclosure {
        Enclosure::Inner => "the reachable set",
        Enclosure::Outer => "the linearised set",
    };
    let _ = writeln!(
        text,
        "\n{} {touched} and decide X0 and U:",
        match model.tight.len() {
            1 => "1 recorded value touches".into(),
            MOST_TIGHT => format!("{MOST_TIGHT} recorded values or more touch"),
            touching => format!("{touching} recorded values touch"),
        }
    );
    text.push_str(&places(&model.tight, 6));
    if let Some((explained, tolerance)) = model.explained.as_ref().zip(model.settings.explain) {
        let _ = writeln!(text, "\n{}", explained.words(tolerance));
    }
    let _ = writeln!(text, "\n{}", trust(&model.trust, "touch the set"));
    text
}

/// What the sets cost, and how near that is to the least.
fn cost(model: &Model) -> String {
    let Some(cost) = model.cost else { return "no cost: a reachable set was lost".into() };
    let widths = "weighted widths of the reachable set, summed over states and samples";
    match (model.cost_lower_bound, &model.search) {
        (Some(bound), _) => {
            let gap = match (cost - bound).max(0.0) / cost {
                part if part > 0.0 => format!("at most {part:.0e} above the least"),
                _ => "the least there is to the solver's accuracy".into(),
            };
            format!("cost {} ({widths}), {gap}", number(cost))
        }
        (None, Some(search)) => {
            let linearised = search
                .linearised_cost
                .map(|cost| format!(", {} of the linearised set", number(cost)));
            format!(
                "cost {} ({widths}){}; {} {}, the reachable sets of all suites computed {} {}",
                number(cost),
                linearised.unwrap_or_default(),
                search.rounds,
                plural(search.rounds, "round"),
                search.reachable_sets,
                plural(search.reachable_sets, "time")
            )
        }
        (None, None) => format!("cost {} ({widths})", number(cost)),
    }
}

/// The sets, joint by joint, as in Table II of the paper.
fn sets(model: &Model) -> String {
    let n = model.joints();
    let mut header = vec!["joint", "X0 q [rad]", "X0 qd [rad/s]", "U [N m]"];
    if model.noise_set.is_some() {
        header.extend(["V q [rad]", "V qd [rad/s]"]);
    }
    let row = |joint: usize| {
        let mut row = vec![
            model.robot.joints[joint].name.clone(),
            interval(model.initial_set.bounds(joint)),
            interval(model.initial_set.bounds(n + joint)),
            interval(model.input_set.bounds(joint)),
        ];
        if let Some(noise) = &model.noise_set {
            row.extend([interval(noise.bounds(joint)), interval(noise.bounds(n + joint))]);
        }
        row
    };
    table(&header, &(0..n).map(row).collect::<Vec<_>>())
}

fn places(places: &[Place], most: usize) -> String {
    let row = |place: &Place| {
        vec![
            place.run.clone(),
            format!("{:.3} s", place.time),
            place.state.clone(),
            format!("{:?}", place.side).to_lowercase(),
            format!("{:.1e}", 0.0 - place.excess),
        ]
    };
    let rows: Vec<_> = places.iter().take(most).map(row).collect();
    let mut text = table(&["run", "time", "state", "side", "inside by"], &rows);
    if places.len() > most {
        let _ = writeln!(text, "  and {} more, which --json lists", places.len() - most);
    }
    text
}
