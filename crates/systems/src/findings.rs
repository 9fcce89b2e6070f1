//! What speaks against the model of a system.

use std::collections::HashMap;

use reachtube_finding::{Finding, Severity};
use reachtube_scalar::number::significant;

use crate::code::Code;
use crate::description::SystemParameter;
use crate::model::SystemModel;
use crate::run::SystemRun;

/// A parameter within this part of its range of a bound is at the bound.
const BOUND: f64 = 1e-6;

/// Returns what speaks against a model.
pub(crate) fn against(
    model: &SystemModel,
    runs: &[SystemRun],
    is_unobserved: bool,
) -> Vec<Finding> {
    let mut found = Vec::new();
    if let Some(without) = model.without_model.as_ref().filter(|of| of.narrower <= 1.0) {
        let text = format!(
            "Without a model, where {}, sets are {} times as wide, so the system adds nothing; \
             look at its matrices, units and delays, and at the inputs.",
            without.how,
            significant(without.narrower, 2)
        );
        found.push(Finding::new(Severity::Warning, Code::NotNarrower, text));
    }
    for output in model.outputs.iter().filter(|output| output.mean > output.motion) {
        let text = format!(
            "The set of {} is {} wide on average, and the output moves by {} in all recordings.",
            output.name,
            significant(output.mean, 2),
            significant(output.motion, 2)
        );
        found.push(Finding::new(Severity::Warning, Code::WiderThanMotion, text));
    }
    if model.recordings.len() < 3 {
        let text = "With fewer than 3 recordings, the sets describe these only; record more.";
        found.push(Finding::new(Severity::Warning, Code::FewMotions, text));
    }
    found.extend(model.system.parameters.iter().filter_map(at_bound));
    found.extend(copies(runs));
    if is_unobserved {
        let text = "The first samples of the outputs do not tell all states; the others start at \
                    0. Give columns of all states, or set start.";
        found.push(Finding::new(Severity::Warning, Code::Unobserved, text));
    }
    found
}

/// Returns a finding for a parameter that a bound keeps from going further.
fn at_bound((name, of): (&String, &SystemParameter)) -> Option<Finding> {
    let near = BOUND * (of.high - of.low);
    let bound = [of.low, of.high].into_iter().find(|end| (of.start - end).abs() <= near)?;
    let text = format!(
        "The parameter {name} is at its bound {bound}, and the least errors may be beyond it; \
         widen its bounds, or look at the formulas."
    );
    Some(Finding::new(Severity::Warning, Code::AtBound, text))
}

/// Returns a finding for recordings of the same numbers.
fn copies(runs: &[SystemRun]) -> Option<Finding> {
    let bits = |numbers: &[f64]| numbers.iter().map(|x| x.to_bits()).collect::<Vec<u64>>();
    let mut seen = HashMap::new();
    let mut copies = runs.iter().filter_map(|run| {
        let first = seen.insert([bits(&run.outputs), bits(&run.inputs)], &run.name);
        first.map(|first| format!("{} is a copy of {first}", run.name))
    });
    let first = copies.next()?;
    let more = match copies.count() {
        0 => String::new(),
        more => format!("; {more} more are copies, too"),
    };
    let text = format!(
        "{first}{more}. A copy lies in sets of the recording that it is a copy of, so that fewer \
         were left out than is stated; leave copies out."
    );
    Some(Finding::new(Severity::Warning, Code::Copies, text))
}
