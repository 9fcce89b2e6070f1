//! Limits of an answer: how far a proof reaches, and what must not be concluded.

use crate::claim::verdict::Verdict;
use crate::data::notion::Notion;
use crate::data::settings::States;
use crate::next_motion::trust::Trust;
use crate::result::code::Code;
use crate::tube::tube::Enclosure;
use reachtube_finding::{Finding, Severity};

/// A bound above this probability is not useful.
const USELESS: f64 = 0.5;

pub(crate) fn reach_of_proof(verdict: &Verdict, states: States, noun: &str) -> Vec<Finding> {
    let info = |code, text: String| Finding::new(Severity::Info, code, text);
    let Verdict { rows, violations, enclosure, .. } = verdict;
    let compared = match states {
        States::All => "position and velocity lie",
        States::Positions => "position lies",
    };
    let hold = rows - violations.count;
    let text = format!(
        "{hold} of {rows} rows (suite, sample, state) hold, checked with directed rounding: \
         the recorded {compared} in the interval hull of the {}.",
        enclosure.set_name()
    );
    let rows = info(Code::Rows, text)
        .with("rows", *rows as f64)
        .with("rows_outside", violations.count as f64);
    let samples = "The recordings are compared with the set at samples. Between samples only \
                   the model's own states are enclosed, in the tube that `reachtube reach` \
                   writes.";
    let notion = verdict.points.as_ref().map_or_else(Notion::default, |points| points.notion);
    let outer = "The model is not linear: its reachable set was computed as an outer \
                 enclosure, which is what a formal analysis uses. A recording in it need not \
                 be a behaviour of the model itself. The recordings that decide the sets touch \
                 the linearised set, not the wider outer set.";
    let mut all = vec![rows, info(Code::AtSamples, samples.into())];
    all.push(info(Code::Notion, notion.limit_words(noun)));
    if *enclosure == Enclosure::Outer {
        all.push(info(Code::OuterSet, outer.into()));
    }
    all
}

pub(crate) fn beyond_recordings(trust: &Trust) -> Vec<Finding> {
    let recorded = "It is a fact about recordings that sets enclose them. It implies nothing \
                    certain about motions, payloads or temperatures that were not recorded.";
    let few = "There are too few independent motions for a useful bound on the next motion. \
               Record more motions rather than more runs of the same motions.";
    let mut all = vec![Finding::new(Severity::Info, Code::RecordedOnly, recorded)];
    if trust.violation_probability > USELESS {
        all.push(Finding::new(Severity::Info, Code::FewMotions, few));
    }
    all
}
