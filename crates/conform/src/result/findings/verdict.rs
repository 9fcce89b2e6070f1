//! Findings about the proof, its counterexamples, and the cost of the sets.

use reachtube_scalar::number::{counted, four_decimals, plural};

use crate::claim::verdict::Verdict;
use crate::claim::witness::{PointVerdict, PointWitness};
use crate::data::settings::{Settings, States};
use crate::data::signals::Signals;
use crate::model::file::Model;
use crate::result::code::Code;
use crate::search::found::SearchSummary;
use crate::tube::strand::Lost;
use crate::tube::tube::Enclosure;
use crate::tube::witness::Witness;
use reachtube_finding::{Finding, Remedy, Severity};

fn outcome(is_conformant: bool) -> (Severity, Code) {
    match is_conformant {
        true => (Severity::Info, Code::Conformant),
        false => (Severity::Failure, Code::NotConformant),
    }
}

impl From<&Lost> for Finding {
    /// Reports where a reachable set ends before its suite.
    fn from(lost: &Lost) -> Self {
        let Lost { case, time, state, nominal } = lost;
        let (code, what) = match nominal {
            true => (Code::Unstable, "the nominal motion runs away after"),
            false => (Code::SetLost, "the reachable set could not be computed beyond"),
        };
        let text = format!(
            "{case}: {what} {time:.3} s, where {state} grew fastest; later samples are not \
             enclosed."
        );
        Self::new(Severity::Failure, code, text)
            .at(case)
            .with("time", *time)
            .remedied_by(Remedy::until(*time))
    }
}

pub(crate) fn verdict_of_fit(model: &Model) -> Finding {
    let Verdict { enclosure, rows, violations, runs, .. } = &model.proof;
    let how = match enclosure {
        Enclosure::Inner => "proved with directed rounding",
        Enclosure::Outer => "lie in the computed outer set, an enclosure with directed rounding",
    };
    let text = format!(
        "{}: {}; {} of {rows} rows{} (suite, sample, state) {how}, at samples{}",
        outcome_of_fit(model),
        recordings_of_fit(model),
        rows - violations.count,
        model.settings.states.of_words(),
        model.settings.until_words(),
    );
    let (severity, code) = outcome(model.verified);
    Finding::new(severity, code, text)
        .with("until", model.settings.until.unwrap_or(f64::INFINITY))
        .with("recordings", *runs as f64)
        .with("rows", *rows as f64)
        .with("rows_outside", violations.count as f64)
}

pub(crate) fn outcome_of_fit(model: &Model) -> &'static str {
    match (model.verified, model.gap_of_not_minimal()) {
        _ if model.is_vacuous() => "conformant, but vacuous",
        (false, _) => "NOT PROVED conformant",
        (true, Some(_)) => "conformant, not minimal",
        (true, None) => "conformant",
    }
}

pub(crate) fn recordings_of_fit(model: &Model) -> String {
    format!(
        "{} in {}",
        counted(model.data.run_count(), "recording"),
        counted(model.data.suites.len(), "suite")
    )
}

/// Returns where the first reachable set ends before its suite, and the number of the others.
pub(crate) fn lost_in_brief(lost: &[Lost]) -> Option<String> {
    let (Lost { case, time, state, nominal }, others) = lost.split_first()?;
    let more = match others.len() {
        0 => String::new(),
        others => format!("; so do {others} more"),
    };
    let what = if *nominal { "the nominal motion runs away after" } else { "the set ends at" };
    Some(format!("{case}: {what} {time:.3} s, where {state} grew fastest{more}"))
}

pub(crate) fn verdict_of_check(verdict: &Verdict, settings: &Settings) -> Finding {
    let Verdict { runs, rows, violations, .. } = verdict;
    let (severity, code) = outcome(verdict.conformant);
    let text = format!(
        "{}: {}; {} of {rows} rows{} (suite, sample, state) outside the {}, at samples{}",
        if verdict.conformant { "conformant" } else { "not conformant" },
        counted(*runs, "recording"),
        violations.count,
        settings.states.of_words(),
        verdict.enclosure.set_name(),
        settings.until_words(),
    );
    Finding::new(severity, code, text)
        .with("until", settings.until.unwrap_or(f64::INFINITY))
        .with("recordings", *runs as f64)
        .with("rows", *rows as f64)
        .with("rows_outside", violations.count as f64)
}

pub(crate) fn points(verdict: &Verdict, states: States) -> Option<Finding> {
    let PointVerdict { points, unproved, outside, notion, .. } = verdict.points.as_ref()?;
    let (set, are_lost) = (verdict.enclosure.set_name(), !verdict.lost.is_empty());
    let rest = match (unproved - outside, outside) {
        (0, 0) => String::new(),
        (0, outside) => format!("; {outside} lie outside"),
        (lost, outside) if are_lost => {
            format!("; {outside} lie outside, and {lost} were not judged because a set was lost")
        }
        (close, outside) => format!(
            "; {outside} lie outside, and {close} lie too close to the boundary to be proved \
             (sets that were found for this notion leave room for a proof)"
        ),
    };
    let severity = if *unproved == 0 { Severity::Info } else { Severity::Failure };
    let text = format!(
        "{} of {points} recorded points ({}) proved to lie in the {set}{rest}",
        points - unproved,
        states.together(*notion),
    );
    let finding = Finding::new(severity, Code::Points, text)
        .with("points", *points as f64)
        .with("unproved", *unproved as f64)
        .with("outside", *outside as f64);
    Some(finding)
}

pub(crate) fn furthest_point(worst: &PointWitness, signals: &Signals) -> Finding {
    let PointWitness { run, time, combination, value, reach, .. } = worst;
    let state = worst.leading_state();
    let text = format!(
        "Furthest outside: {run} at {time:.3} s, where {combination} is {} {unit} from the \
         centre of the set, which reaches {} {unit}.",
        four_decimals(*value),
        four_decimals(*reach),
        unit = signals.unit(state),
    );
    Finding::new(Severity::Failure, Code::FurthestOutside, text)
        .at(run)
        .with("time", *time)
        .with("value", *value)
        .with("reach", *reach)
}

pub(crate) fn furthest_value(worst: &Witness, signals: &Signals) -> Finding {
    let text = format!("Furthest outside: {}.", place_outside(worst, signals));
    Finding::new(Severity::Failure, Code::FurthestOutside, text)
        .at(&worst.run)
        .with("time", worst.time)
        .with("part", worst.part as f64)
        .with("excess", worst.excess)
}

/// Describes a value outside the reachable set in one line.
pub(crate) fn place_outside(place: &Witness, signals: &Signals) -> String {
    let unit = signals.unit(place.state);
    format!(
        "{} at {:.3} s: {} {}, {} is {} {unit} beyond the {} bound",
        place.run,
        place.time,
        signals.noun,
        place.part,
        place.state,
        four_decimals(place.excess),
        format!("{:?}", place.side).to_lowercase()
    )
}

pub(crate) fn unstable(case: &str, time: f64) -> Finding {
    let text = format!(
        "{case}: a simulated motion under nearly these sets diverged before {time:.3} s; the \
         model is unstable there."
    );
    Finding::new(Severity::Warning, Code::Unstable, text).at(case).with("time", time)
}

/// The cost of the sets, and its distance from the optimum if it is known.
pub(crate) fn cost(model: &Model) -> Finding {
    let (Some(cost), Some(of_samples)) = (model.cost, model.cost_of_samples) else {
        let text = "no cost: a reachable set could not be computed to the end";
        return Finding::new(Severity::Info, Code::Cost, text);
    };
    let quality = match (model.cost_lower_bound, &model.search) {
        (Some(bound), _) => {
            let optimal = match (model.gap_of_not_minimal(), model.optimality_gap) {
                (Some(_), _) => "NOT optimal".into(),
                (None, Some(gap)) if gap > 0.0 => format!("optimal to a relative {gap:.0e}"),
                (None, _) => "optimal".into(),
            };
            // A fit ends in a local optimum: other nominal models may have smaller sets.
            let optimal = match &model.fit {
                Some(fit) if fit.taken => format!("{optimal} for this nominal model"),
                _ => optimal,
            };
            // A bound with the digits of the cost is not printed.
            match four_decimals(bound) {
                bound if bound == four_decimals(cost) => format!(" ({optimal})"),
                bound => format!(" ({optimal}; lower bound {bound})"),
            }
        }
        (None, Some(search)) => format!(" ({})", search_words(search)),
        (None, None) if model.calibration.is_some() => " (calibrated, not the smallest)".into(),
        (None, None) if !model.allowance.is_empty() => {
            " (with an allowance, not the smallest)".into()
        }
        (None, None) => String::new(),
    };
    let text = format!(
        "cost {}{quality}: weighted widths of the reachable sets, summed over states and \
         integrated over time; summed over samples, as in the paper: {}",
        four_decimals(cost),
        four_decimals(of_samples)
    );
    Finding::new(Severity::Info, Code::Cost, text)
        .with("cost", cost)
        .with("cost_of_samples", of_samples)
        .with("lower_bound", model.cost_lower_bound.unwrap_or(f64::NAN))
}

pub(crate) fn not_smallest(gap: f64) -> Finding {
    let text = format!(
        "The sets enclose the recordings but are not the smallest: the solver stopped above \
         its lower bound (relative gap {gap:.1e})."
    );
    Finding::new(Severity::Warning, Code::NotSmallest, text).with("gap", gap)
}

fn search_words(search: &SearchSummary) -> String {
    let SearchSummary { linearised_cost, rounds, reachable_sets, .. } = search;
    let linearised = linearised_cost
        .map(|cost| format!("{} for the linearised sets; ", four_decimals(cost)))
        .unwrap_or_default();
    format!(
        "{linearised}{}, the reachable sets of all suites computed {reachable_sets} {}",
        counted(*rounds, "round"),
        plural(*reachable_sets, "time")
    )
}
