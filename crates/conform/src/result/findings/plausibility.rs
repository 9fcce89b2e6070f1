//! What is implausible about the sets, and why.

use crate::fit::record::Overfit;
use crate::plausibility::cause::Cause;
use crate::plausibility::warning::{Remark, Warning, WarningKind};
use crate::result::code::Code;
use crate::result::findings::words::listed;
use reachtube_finding::{Finding, Remedy, Severity};
use reachtube_scalar::number::{four_decimals, plural};

/// The horizon that is proposed for long recordings, s.
const FIRST_HORIZON: f64 = 0.5;

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

impl From<&Cause> for Warning {
    /// Reports the most likely cause of other warnings.
    fn from(cause: &Cause) -> Self {
        let mut remedy = None;
        let text = match cause {
            Cause::Reading { clause, kind, unexplained, as_stated } => {
                remedy = kind.map(|kind| Remedy::new("torque", format!("{kind:?}").to_lowercase()));
                format!(
                    "The most likely cause: {clause}. So read, {} of the recorded input is not \
                     explained by the recorded motion, and {} as stated.",
                    percent(*unexplained),
                    percent(*as_stated)
                )
            }
            Cause::HeldOut { motion, fitted, factor } => format!(
                "The most likely cause: motion {motion}, which was held out, is unlike the motions \
                 that the sets were found with ({}), so that calibration scaled these sets by \
                 {factor:.2}. Record more motions to find the sets with, among them some like \
                 {motion}.",
                listed(fitted)
            ),
            Cause::ExpansionPoint { distance, mean } => {
                remedy = Some(Remedy::new("expansion", point(mean)));
                format!(
                    "The nominal motions follow the robot, and deviations from them the inertia at \
                     the expansion point, from which the positions lie up to {distance:.2} rad. \
                     The mean of the positions is a better point."
                )
            }
            Cause::ConstantInertia { about_mean, can_follow_robot, .. } => {
                remedy = Some(match (about_mean, can_follow_robot) {
                    (Some((mean, _)), _) => Remedy::new("expansion", point(mean)),
                    (None, true) => Remedy::new("equations", "robot"),
                    (None, false) => Remedy::new("paper-model", "3"),
                });
                constant_inertia_words(cause)
            }
            Cause::Horizon { unexplained, longest } => {
                remedy = Some(Remedy::new("horizon", format!("{FIRST_HORIZON}")));
                format!(
                    "The robot explains the recorded input but for {}. A prediction from the \
                     recorded input alone widens with time, and the recordings last up to \
                     {longest:.1} s. Predict over a shorter time.",
                    percent(*unexplained)
                )
            }
            Cause::Parameters { .. } => {
                let (words, setting, value) = parameters_words(cause);
                remedy = Some(Remedy::new(setting, value));
                words
            }
        };
        Self::about_all(WarningKind::Cause, text, remedy)
    }
}

/// Returns the sentences about parameters that do not explain the recordings, and the setting that
/// helps. What was done already is not proposed again.
fn parameters_words(cause: &Cause) -> (String, &'static str, String) {
    let Cause::Parameters { unexplained, is_identified, is_fitted, longest } = cause else {
        return Default::default();
    };
    let (what_to_do, setting, value) = match (is_fitted, is_identified) {
        (true, _) => (
            "The nominal model was fitted for small sets already, so record more motions, or \
             predict over a shorter time.",
            "horizon",
            half(*longest),
        ),
        (false, true) => (
            "The robot was identified already, so fit the nominal model for small sets.",
            "fit",
            String::new(),
        ),
        (false, false) => (
            "Check the robot's parameters, for example with `reachtube identify`, or fit the \
             nominal model for small sets.",
            "fit",
            String::new(),
        ),
    };
    let words = format!(
        "Units, signs, kind of torque, order of joints and lags fit, but {} of the recorded input \
         does not follow from the recorded motion. {what_to_do}",
        percent(*unexplained)
    );
    (words, setting, value)
}

/// Returns the sentences about a model whose inertia is constant.
fn constant_inertia_words(cause: &Cause) -> String {
    let Cause::ConstantInertia { by_robot, by_model, distance, about_mean, can_follow_robot } =
        cause
    else {
        return String::new();
    };
    let better = about_mean.as_ref().map(|(mean, unexplained)| {
        let also = match can_follow_robot {
            true => "Nominal motions by the robot's own equations follow the robot.",
            false => "Model 3 of order 2 follows how the inertia changes.",
        };
        format!(
            " About {}, the mean of the positions, {} is not explained. {also}",
            point(mean),
            percent(*unexplained)
        )
    });
    format!(
        "The robot explains the recordings, and model 1 does not: {} of the recorded input is not \
         explained by the robot, and {} by the inertia at the expansion point, from which the \
         positions lie up to {distance:.2} rad.{} Shorter windows lessen the error.",
        percent(*by_robot),
        percent(*by_model),
        better.unwrap_or_default(),
    )
}

/// Returns about half of a time, s.
fn half(time: f64) -> String {
    let half = 0.5 * time;
    let unit = 10f64.powi(half.max(1e-3).log10().floor() as i32);
    let text = format!("{:.3}", unit * (half / unit).floor().max(1.0));
    text.trim_end_matches('0').trim_end_matches('.').into()
}

/// Returns a position as settings have it.
fn point(q: &[f64]) -> String {
    q.iter().map(|q| format!("{q:.2}")).collect::<Vec<_>>().join(",")
}

fn percent(part: f64) -> String {
    match part {
        ..0.01 => "less than 1 %".into(),
        _ => format!("{:.0} %", 100.0 * part.min(1.0)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use reachtube_finding::FrontEnd;

    #[test]
    fn a_small_part_is_not_printed_as_none() {
        assert_eq!([0.004, 0.02, 7.0].map(percent), ["less than 1 %", "2 %", "100 %"]);
    }

    #[test]
    fn a_cause_names_its_remedy_as_data() {
        let kind = Some(reachtube_recordings::Torque::Motor);
        let clause = "the torques are of the kind `motor`".into();
        let cause = Cause::Reading { clause, kind, unexplained: 0.07, as_stated: 3.0 };
        let finding = Finding::from(&Warning::from(&cause));
        let written = finding.written_for(FrontEnd::Python);
        assert!(written.contains("of the kind `motor`. So read, 7 % of"), "{written}");
        assert!(written.contains("and 100 % as stated. `torque=\"motor\"` reads"), "{written}");
    }

    #[test]
    fn what_was_applied_is_not_proposed_again() {
        let written = |cause: &Cause| Finding::from(&Warning::from(cause)).to_string();
        let long = written(&Cause::Horizon { unexplained: 0.1, longest: 31.2 });
        assert!(
            long.contains("last up to 31.2 s") && long.contains("`--horizon 0.5` cuts"),
            "{long}"
        );
        let parameters = |is_identified, is_fitted| {
            let (unexplained, longest) = (0.1, 0.5);
            written(&Cause::Parameters { unexplained, is_identified, is_fitted, longest })
        };
        let first = parameters(false, false);
        assert!(first.contains("`reachtube identify`") && first.contains("`--fit`"), "{first}");
        let identified = parameters(true, false);
        assert!(!identified.contains("`reachtube identify`"), "{identified}");
        assert!(identified.ends_with("`--fit` names the parameters to fit."), "{identified}");
        let fitted = parameters(true, true);
        assert!(!fitted.contains("--fit") && fitted.contains("`--horizon 0.2`"), "{fitted}");
    }

    #[test]
    fn a_warning_of_an_earlier_version_is_read() {
        let old = r#"{"kind": "cause", "joints": [], "text": "the cause: x (--torque motor)"}"#;
        let finding = Finding::from(&serde_json::from_str::<Warning>(old).unwrap());
        assert_eq!(finding.text, "the cause: x (--torque motor).");
    }
}
