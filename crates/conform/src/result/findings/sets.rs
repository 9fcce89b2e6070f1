//! What is implausible about the sets, what decides them, and motions near the recordings.

use reachtube_robot::JointKind;

use crate::data::settings::Tolerance;
use crate::hulls::Enclosure;
use crate::model::file::{MOST_TIGHT, Model};
use crate::model::records::{Explained, Residual};
use crate::plausibility::{Warning, WarningKind};
use crate::result::code::Code;
use crate::result::finding::{Finding, Severity};
use crate::result::findings::words::{listed, plural};
use crate::result::front_end::mentions;
use crate::result::remedy::Remedy;

impl From<&Warning> for Finding {
    /// Makes the finding of a warning, as model files have it. What its text says of settings in
    /// brackets becomes the remedy.
    fn from(warning: &Warning) -> Self {
        let mut text = without_settings_in_brackets(&warning.text);
        if !text.ends_with('.') {
            text.push('.');
        }
        let joints: Vec<String> = warning.joints.iter().map(ToString::to_string).collect();
        let place = format!("{} {}", plural(joints.len(), "joint"), listed(&joints));
        let remedy = Remedy::mentioned_in(&warning.text);
        // What the sentence says already is not said twice.
        let is_said = remedy.as_ref().is_some_and(|remedy| {
            mentions(&text).iter().any(|mention| mention.setting == remedy.setting)
        });
        Self {
            place: (!joints.is_empty()).then_some(place),
            ..Self::new(Severity::Warning, code(warning.kind), text)
        }
        .remedied_by(remedy.filter(|_| !is_said))
    }
}

impl Finding {
    /// How many recorded values touch the reachable set.
    pub(crate) fn touching(model: &Model) -> Self {
        let set = match model.proof.enclosure {
            Enclosure::Inner => "reachable set",
            Enclosure::Outer => "linearised set",
        };
        let text = match model.tight.len() {
            1 => format!("1 recorded value touches the {set} and decides X0 and U"),
            count => {
                let more = if count == MOST_TIGHT { " or more" } else { "" };
                format!("{count}{more} recorded values touch the {set} and decide X0 and U")
            }
        };
        let text = if model.tight.is_empty() { text } else { text + ":" };
        Self::new(Severity::Info, Code::Touching, text).with("values", model.tight.len() as f64)
    }

    /// How close motions of the model come to the recordings; `tolerance` comes from the settings.
    pub(crate) fn explanations(
        explained: &Explained,
        tolerance: Tolerance,
        kinds: &[JointKind],
    ) -> Self {
        let Explained { runs, residuals } = explained;
        let size = |residual: &&Residual| residual.in_tolerances(tolerance);
        let worst = residuals.iter().max_by(|a, b| size(a).total_cmp(&size(b)));
        let Some(worst) = worst else {
            let text = "There is no recording to explain.";
            return Self::new(Severity::Info, Code::Explanations, text);
        };
        let q = JointKind::any_unit(kinds, JointKind::position_unit);
        let qd = JointKind::any_unit(kinds, JointKind::velocity_unit);
        let median = |of: fn(&Residual) -> Option<f64>| {
            let mut values: Vec<f64> =
                residuals.iter().map(|r| of(r).unwrap_or(f64::INFINITY)).collect();
            values.sort_by(f64::total_cmp);
            values[values.len() / 2]
        };
        let size = |value: Option<f64>| {
            value.map_or_else(|| "infinitely far".into(), |value| format!("{value:.2e}"))
        };
        let [of_q, of_qd] = [median(|r| r.position), median(|r| r.velocity)];
        let text = format!(
            "For {runs} of the {count} recordings, a motion of the model itself (start in X0, \
             input in U, held over each sample) was found within {} {q} and {} {qd}. The closest \
             motions found differ by {of_q:.2e} {q} and {of_qd:.2e} {qd} in the median, and by {} \
             {q} and {} {qd} for {}.",
            tolerance.position,
            tolerance.velocity,
            size(worst.position),
            size(worst.velocity),
            worst.file,
            count = residuals.len(),
        );
        Self::new(Severity::Info, Code::Explanations, text)
            .with("explained", *runs as f64)
            .with("recordings", residuals.len() as f64)
            .with("median_position", of_q)
            .with("median_velocity", of_qd)
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
        WarningKind::NoiseSetSize => Code::NoiseSetSize,
        WarningKind::Unexplained => Code::Unexplained,
        WarningKind::Cause => Code::Cause,
        WarningKind::Overfitted => Code::Overfitted,
    }
}

/// Drops what stands in brackets and begins with a setting.
fn without_settings_in_brackets(text: &str) -> String {
    let mut parts = text.split(" (--");
    let first = parts.next().unwrap_or_default().to_string();
    parts.fold(first, |kept, part| match part.split_once(')') {
        Some((_, rest)) => kept + rest,
        None => kept + " (--" + part,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(text: &str) -> Finding {
        Finding::from(&Warning { kind: WarningKind::Cause, joints: vec![], text: text.into() })
    }

    #[test]
    fn the_setting_in_brackets_is_the_remedy() {
        let finding = of("the torques are of the kind `motor` (--torque motor). So read, 7 %");
        assert_eq!(finding.text, "the torques are of the kind `motor`. So read, 7 %.");
        let remedy = finding.remedy.unwrap();
        assert_eq!((&*remedy.setting, &*remedy.value), ("torque", "motor"));
        let finding = of("with --equations robot the nominal motions follow the robot");
        assert_eq!(finding.remedy, None);
    }
}
