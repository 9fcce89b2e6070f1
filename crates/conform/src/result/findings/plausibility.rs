//! What is implausible about the sets, and why.

use crate::fit::record::Overfit;
use crate::plausibility::warning::{Remark, Warning, WarningKind};
use crate::result::code::Code;
use crate::result::findings::words::listed;
use reachtube_finding::{Finding, Remedy, Severity};
use reachtube_scalar::number::{four_decimals, plural};

impl From<&Warning> for Finding {
    /// Makes the finding of a warning, as model files have it.
    fn from(warning: &Warning) -> Self {
        let Warning { kind, joints, text, remedy } = warning;
        // Files of earlier versions have texts without a full stop.
        let end = if text.ends_with('.') { "" } else { "." };
        let listed = listed(&joints.iter().map(ToString::to_string).collect::<Vec<_>>());
        let place = format!("{} {listed}", plural(joints.len(), "joint"));
        Self {
            place: (!joints.is_empty()).then_some(place),
            remedy: remedy.clone(),
            ..Self::new(Severity::Warning, code(*kind), format!("{text}{end}"))
        }
    }
}

/// Returns the code of a kind of warning.
fn code(kind: WarningKind) -> Code {
    match kind {
        WarningKind::ReachableSetSize => Code::ReachableSetSize,
        WarningKind::InitialSetSize => Code::InitialSetSize,
        WarningKind::InitialSetStarts => Code::InitialSetStarts,
        WarningKind::InitialSetOffset => Code::InitialSetOffset,
        WarningKind::InputSetSize => Code::InputSetSize,
        WarningKind::InputSetOffset => Code::InputSetOffset,
        WarningKind::InputSetZero => Code::InputSetZero,
        WarningKind::NoiseSetSize => Code::NoiseSetSize,
        WarningKind::Unexplained => Code::Unexplained,
        WarningKind::FrictionRange => Code::FrictionRange,
        WarningKind::FallingFriction => Code::FallingFriction,
        WarningKind::Cause => Code::Cause,
        WarningKind::Overfitted => Code::Overfitted,
    }
}

impl Warning {
    /// Makes the warning of one kind about joints.
    pub(crate) fn of_remarks(kind: WarningKind, remarks: &[&Remark]) -> Self {
        let texts: Vec<String> = remarks.iter().map(|remark| remark.text.clone()).collect();
        let mut joints: Vec<usize> = remarks.iter().map(|remark| remark.joint).collect();
        joints.sort_unstable();
        joints.dedup();
        let remedy = (kind == WarningKind::InitialSetStarts)
            .then(|| Remedy::new("initial-limit", "positions"));
        Self { kind, joints, text: format!("{}: {}.", words(kind), texts.join("; ")), remedy }
    }

    /// Makes the warning that names the most likely cause of others.
    #[must_use]
    pub fn of_cause(text: String, remedy: Option<Remedy>) -> Self {
        Self::about_all(WarningKind::Cause, text, remedy)
    }

    /// Names a motion that was held out, and made calibration scale the sets.
    pub(crate) fn of_held_out(motion: &str, fitted: &[String], factor: f64) -> Self {
        let text = format!(
            "The most likely cause: motion {motion}, which was held out, is unlike the motions \
             that the sets were found with ({}), so that calibration scaled these sets by \
             {factor:.2}. Record more motions to find the sets with, among them some like \
             {motion}.",
            listed(fitted)
        );
        Self::of_cause(text, None)
    }

    fn about_all(kind: WarningKind, text: String, remedy: Option<Remedy>) -> Self {
        Self { kind, joints: Vec::new(), text, remedy }
    }
}

/// Returns the words before the list of states or joints.
fn words(kind: WarningKind) -> &'static str {
    match kind {
        WarningKind::ReachableSetSize => {
            "The reachable set is more than twice as wide as the recorded motion (largest width, \
             range of the recordings)"
        }
        WarningKind::InitialSetSize => {
            "X0 is wider than the recorded motion and covers what the model does not explain \
             (width, range of the recordings)"
        }
        WarningKind::InitialSetStarts => {
            "X0 reaches much further than the recorded starts and covers what happens later, which \
             a limit of X0 would leave to U (reach, furthest start)"
        }
        WarningKind::InitialSetOffset => {
            "X0 does not contain 0, so that no nominal motion starts in it (distance)"
        }
        WarningKind::InputSetSize => {
            "U reaches beyond the recorded inputs (reach, largest recorded input)"
        }
        WarningKind::InputSetOffset => {
            "U lies away from 0 by more than its radius: a constant torque that the model does not \
             have, such as a counterweight or an offset of the sensor (centre, radius)"
        }
        WarningKind::InputSetZero => {
            "U is 0 although the input has an error, which the U of other joints covers (U, RMS \
             error of the input)"
        }
        WarningKind::NoiseSetSize => {
            "V is so wide that hardly any motion is left to explain (width, range of the \
             recordings)"
        }
        WarningKind::Unexplained => {
            "The nominal motions explain little of the recorded velocities (part of the variance)"
        }
        WarningKind::FrictionRange => {
            "The recordings are faster than the ones that friction was fitted to, where it is not \
             known (highest speed, highest speed of the fit)"
        }
        WarningKind::FallingFriction => {
            "Viscous friction falls with speed, so that nominal motions may run away (from which \
             speed on, highest speed of the joint)"
        }
        WarningKind::Cause | WarningKind::Overfitted => "",
    }
}

impl From<&Overfit> for Warning {
    /// Reports that a fit suits its own motions only.
    fn from(overfit: &Overfit) -> Self {
        let fact = match overfit {
            Overfit::Calibrated { identified, fitted } => format!(
                "Calibrated sets cost {} with the fitted nominal model and {} with the identified \
                 one",
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
        Self::about_all(WarningKind::Overfitted, text, Some(Remedy::new("pull", "")))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_warning_of_an_earlier_version_is_read() {
        let old = r#"{"kind": "cause", "joints": [], "text": "the cause: x (--torque motor)"}"#;
        let finding = Finding::from(&serde_json::from_str::<Warning>(old).unwrap());
        assert_eq!(finding.text, "the cause: x (--torque motor).");
    }
}
