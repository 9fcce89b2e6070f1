//! What is implausible about the sets, and why.

use crate::data::signals::Signals;
use crate::fit::record::Overfit;
use crate::plausibility::remark::Remark;
use crate::result::code::Code;
use reachtube_finding::{Finding, Remedy, Severity};
use reachtube_scalar::number::four_decimals;

/// Makes the warning with one code about parts; `None` without remarks.
pub(crate) fn of_remarks(code: Code, remarks: &[&Remark], signals: &Signals) -> Option<Finding> {
    let texts: Vec<&str> = remarks.iter().map(|remark| remark.text.as_str()).collect();
    let text = format!("{}: {}.", words(code, &signals.noun), texts.join("; "));
    let starts = code == Code::InitialSetStarts;
    let remedy = starts.then(|| Remedy::new("initial-limit", "positions"));
    let warning = Finding::new(Severity::Warning, code, text).remedied_by(remedy);
    let place = signals.place(remarks.iter().map(|remark| remark.part));
    (!remarks.is_empty()).then(|| warning.at(place))
}

pub(crate) fn of_held_out(motion: &str, fitted: &[String], factor: f64) -> Finding {
    let text = format!(
        "The most likely cause: motion {motion}, which was held out, is unlike the motions that \
         the sets were found with ({}), so that calibration scaled these sets by {factor:.2}. \
         Record more motions to find the sets with, among them some like {motion}.",
        fitted.join(", ")
    );
    Finding::new(Severity::Warning, Code::Cause, text)
}

/// Returns the words before the list of states or parts.
fn words(code: Code, noun: &str) -> String {
    let words = match code {
        Code::ReachableSetSize => {
            "The reachable set is more than twice as wide as the recorded motion (largest width, \
             range of the recordings)"
        }
        Code::InitialSetSize => {
            "X0 is wider than the recorded motion and covers what the model does not explain \
             (width, range of the recordings)"
        }
        Code::InitialSetStarts => {
            "X0 reaches much further than the recorded starts and covers what happens later, which \
             a limit of X0 would leave to U (reach, furthest start)"
        }
        Code::InitialSetOffset => {
            "X0 does not contain 0, so that no nominal motion starts in it (distance)"
        }
        Code::InputSetSize => {
            "U reaches beyond the recorded inputs (reach, largest recorded input)"
        }
        Code::InputSetOffset => {
            "U lies away from 0 by more than its radius: a constant torque that the model does not \
             have, such as a counterweight or an offset of the sensor (centre, radius)"
        }
        Code::InputSetZero => {
            return format!(
                "U is 0 although the input has an error, which the U of other {noun}s covers (U, \
                 RMS error of the input)"
            );
        }
        Code::NoiseSetSize => {
            "V is so wide that hardly any motion is left to explain (width, range of the \
             recordings)"
        }
        Code::Unexplained => {
            "The nominal motions explain little of the recorded velocities (part of the variance)"
        }
        Code::FrictionRange => {
            "The recordings are faster than the ones that friction was fitted to, where it is not \
             known (highest speed, highest speed of the fit)"
        }
        Code::FallingFriction => {
            return format!(
                "Viscous friction falls with speed, so that nominal motions may run away (from \
                 which speed on, highest speed of the {noun})"
            );
        }
        _ => "",
    };
    words.into()
}

pub(crate) fn overfitted(overfit: &Overfit) -> Finding {
    let fact = match overfit {
        Overfit::Calibrated { identified, fitted } => format!(
            "Calibrated sets cost {} with the fitted nominal model and {} with the identified one",
            four_decimals(*fitted),
            four_decimals(*identified),
        ),
        Overfit::LeftOut { identified, fitted } => {
            let size = |cost: &Option<f64>| cost.map(four_decimals);
            let costs = size(fitted).zip(size(identified));
            let costs = costs.map(|(fitted, before)| format!(" (cost {fitted}, {before})"));
            format!(
                "With a motion left out the fitted nominal model needs larger sets than the \
                 identified one{}",
                costs.unwrap_or_default()
            )
        }
    };
    let text = format!(
        "{fact}: the fit suits its own motions only. Fit to more motions, fit fewer groups, or \
         give a larger weight to the pull."
    );
    Finding::new(Severity::Warning, Code::Overfitted, text).remedied_by(Remedy::new("pull", ""))
}
