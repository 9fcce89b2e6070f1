//! Findings of a check besides its verdict.

use reachtube_scalar::number::{at_least, counted};

use crate::data::recordings::Recordings;
use crate::data::signals::Signals;
use crate::data::suite::Suite;
use crate::model::other_data::{OtherData, Replaced};
use crate::next_motion::growth::Growth;
use crate::result::code::Code;
use reachtube_finding::{Finding, Severity};

/// Factor beyond which widening a set is no remedy.
const MOST_GROWTH: f64 = 100.0;

/// Largest number of recordings that are named.
const MOST_FILES: usize = 3;

/// Which set would have to grow to enclose the recordings, and by how much.
pub(crate) fn growth_needed(growth: &Growth, signals: &Signals) -> Finding {
    let ways = ways(growth, signals);
    let helps = |factor: &f64| *factor <= MOST_GROWTH;
    let useless = |(name, factor): &(&str, Option<f64>)| {
        let set = name.split_once(' ').map_or(*name, |(set, _)| set);
        let is_single = !name.contains("and");
        let is_useless = factor.is_none_or(|factor| !helps(&factor));
        (growth.both_sets.is_some() && is_single && is_useless).then(|| set.to_string())
    };
    let mut text = format!("The recordings are covered if {}.", ways.join(", or if "));
    let useless: Vec<String> = widened(growth).iter().filter_map(useless).collect();
    if !useless.is_empty() {
        text += &format!(" Widening {} alone does not help.", useless.join(" or "));
    }
    text += " This is not proved.";
    let infinite = |factor: Option<f64>| factor.unwrap_or(f64::INFINITY);
    Finding::new(Severity::Info, Code::GrowthNeeded, text)
        .with("input_set", infinite(growth.input_set))
        .with("initial_set", infinite(growth.initial_set))
        .with("both_sets", infinite(growth.both_sets))
        .with("noise_position", growth.noise_position)
        .with("noise_velocity", growth.noise_velocity)
}

/// Returns the first way in which the sets could grow to enclose the recordings.
pub(crate) fn least_growth(growth: &Growth, signals: &Signals) -> String {
    ways(growth, signals).swap_remove(0)
}

pub(crate) fn use_unknown(are_listed: bool) -> Finding {
    let why = if are_listed {
        "The fold does not have the SHA-256 of each recording; fold the recordings to check \
         this model."
    } else {
        "The model file counts its recordings and does not list them; fit the model to fewer \
         to have them listed."
    };
    let text = format!(
        "The model may have been fitted to some of these recordings, so they count as used \
         and give no guarantee for new motions. {why}"
    );
    Finding::new(Severity::Info, Code::UseUnknown, text)
}

pub(crate) fn other_start(suite: &str) -> Finding {
    let text = format!(
        "suite {suite}: none of its recordings starts near the nominal initial state that the \
         model has for a suite of this name. If this is another motion, give the suite another \
         name."
    );
    Finding::new(Severity::Warning, Code::OtherStart, text).at(format!("suite {suite}"))
}

pub(crate) fn other_recordings(other: &OtherData) -> Finding {
    let OtherData { missing, replaced, deciding, added, shares_any, starts_alike } = other;
    let changed: Vec<String> = replaced.iter().map(changed).collect();
    let mut parts = Vec::new();
    if !missing.is_empty() {
        parts.push(format!("missing {}", few(missing)));
    }
    if !changed.is_empty() {
        parts.push(format!("other content in {}", few(&changed)));
    }
    if *added > 0 {
        parts.push(format!("{} that it does not list", counted(*added, "recording")));
    }
    let mut text = format!("The recordings differ from the model's own: {}.", parts.join("; "));
    if !deciding.is_empty() {
        let verb = if deciding.len() == 1 { "decides" } else { "decide" };
        text += &format!(" In the model, {} {verb} the sets.", few(deciding));
    }
    if *starts_alike {
        text += " They start where the model's do, to the last bit. They may be the same \
                 recordings, cut or edited, so they count as used in the fit.";
    }
    let is_doubtful = *shares_any || *starts_alike;
    let severity = if is_doubtful { Severity::Warning } else { Severity::Info };
    Finding::new(severity, Code::OtherRecordings, text)
        .with("missing", missing.len() as f64)
        .with("replaced", replaced.len() as f64)
        .with("deciding", deciding.len() as f64)
        .with("added", *added as f64)
}

pub(crate) fn note(text: &str) -> Finding {
    Finding::new(Severity::Info, Code::Recordings, text)
}

pub(crate) fn at_rest(recordings: &Recordings) -> Option<Finding> {
    let suites = recordings.suites.iter().filter(|suite| suite.is_at_rest());
    let count: usize = suites.map(Suite::run_count).sum();
    let text = format!(
        "In {count} of {} the robot rests; a bound for new motions does not count them.",
        counted(recordings.run_count(), "recording")
    );
    (count > 0).then(|| note(&text))
}

fn changed(run: &Replaced) -> String {
    match run.samples {
        [own, at_hand] if own == at_hand => run.file.clone(),
        [own, at_hand] => format!("{} ({at_hand} samples, {own} in the model's)", run.file),
    }
}

/// Lists the first recordings and counts the others.
fn few(files: &[String]) -> String {
    let named = files[..files.len().min(MOST_FILES)].join(", ");
    match files.len().saturating_sub(MOST_FILES) {
        0 => named,
        others => format!("{named} and {others} more"),
    }
}

fn widened(growth: &Growth) -> [(&'static str, Option<f64>); 3] {
    [("U is", growth.input_set), ("X0 is", growth.initial_set), ("X0 and U are", growth.both_sets)]
}

/// Returns the ways in which the sets could grow to enclose the recordings; V comes last.
fn ways(growth: &Growth, signals: &Signals) -> Vec<String> {
    let wide = |(name, factor): (&str, Option<f64>)| {
        let factor = factor.filter(|factor| *factor <= MOST_GROWTH)?;
        Some(format!("{name} {} times as wide", at_least(factor)))
    };
    let noise = format!(
        "V is wider by {} {} and {} {}",
        at_least(growth.noise_position),
        signals.units_of_state(0).any(),
        at_least(growth.noise_velocity),
        signals.units_of_state(1).any()
    );
    widened(growth).into_iter().filter_map(wide).chain([noise]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_set_that_cannot_grow_enough_is_no_remedy() {
        let growth = Growth {
            initial_set: Some(1.5e6),
            input_set: Some(1.25),
            both_sets: Some(1.2),
            parts: vec![],
            noise_position: 0.1,
            noise_velocity: 0.2,
        };
        let finding = growth_needed(&growth, &Signals::default());
        assert_eq!(finding.numbers["input_set"], 1.25);
        let text = finding.text;
        assert!(text.contains("covered if U is 1.250 times as wide, or if X0 and U"), "{text}");
        assert!(text.contains("Widening X0 alone does not help"), "{text}");
        assert!(!text.contains("X0 is"), "{text}");
    }
}
