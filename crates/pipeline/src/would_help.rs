//! Effects of choices that were not applied.

use std::borrow::Cow;

use reachtube_finding::{Finding, FrontEnd, Remedy, Severity};
use reachtube_scalar::number::counted;

use crate::code::Code;

/// Effect of a choice: the ratio of half the widest set, the set of `joint`, to the joint's motion,
/// without the choice and with it, as tried on some windows.
pub(crate) fn would_help(
    setting: &str,
    value: &str,
    joint: &str,
    [before, after]: [f64; 2],
    windows: usize,
) -> Finding {
    let [without, with] = [before, after].map(percent);
    let text = format!(
        "Tried on up to {}, the widest set is {with} of the motion ({joint}) in place of \
         {without}.",
        counted(windows, "window")
    );
    let mut remedy = Remedy::new(setting, value);
    match (setting, value) {
        ("equations", "model") => {
            remedy.effect = Cow::Borrowed("lets the nominal motions follow the linear model.");
        }
        ("equations", "velocity" | "decaying" | "held") => {
            remedy.effect = Cow::Borrowed("needs neither the robot nor its torque.");
        }
        _ => {}
    }
    Finding::new(Severity::Info, Code::WouldHelp, text)
        .at(joint)
        .with("ratio", after)
        .with("ratio_before", before)
        .with("windows", windows as f64)
        .remedied_by(remedy)
}

/// That none of some choices, settings with their values, makes the sets clearly narrower.
pub(crate) fn nothing_helps(tried: &[(&str, &str)]) -> Finding {
    let written = |(setting, value): &(&str, &str)| {
        format!("`{}`", FrontEnd::Choices.setting(setting, Some(value)))
    };
    let tried: Vec<String> = tried.iter().map(written).collect();
    let text = format!("Tried without making the sets clearly narrower: {}.", tried.join(", "));
    Finding::new(Severity::Info, Code::WouldHelp, text)
}

fn percent(ratio: f64) -> String {
    match ratio {
        ratio if !ratio.is_finite() => "of no bounded size".into(),
        ratio if ratio < 100.0 => format!("{:.0} %", 100.0 * ratio),
        ratio => format!("{ratio:.0e} times"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_choice_that_helps_is_written_as_choices_are() {
        let finding = would_help("fit", "inertia", "elbow", [1.3, 0.47], 24);
        let written = finding.written_for(FrontEnd::Choices);
        assert!(written.contains("is 47 % of the motion (elbow) in place of 130 %."), "{written}");
        assert!(
            written.ends_with("`fit = [\"inertia\"]` names the parameters to fit."),
            "{written}"
        );
        let none = nothing_helps(&[("fit", "inertia"), ("horizon", "0.1")]);
        assert!(none.text.ends_with("`fit = [\"inertia\"]`, `horizon = 0.1`."), "{}", none.text);
    }
}
