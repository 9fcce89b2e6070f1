//! What a page says of a nominal model that was fitted, and of calibrated sets.

use reachtube_conform::{FittedParameter, Model};

use crate::number::{at_least, four_decimals};

/// Returns the facts about the nominal model and the calibration: name and value.
pub(super) fn nominal_facts(model: &Model) -> Vec<(String, String)> {
    let mut facts = Vec::new();
    let mut add = |name: &str, value: String| facts.push((name.to_string(), value));
    if let Some(fit) = &model.fit {
        let groups: Vec<&str> = fit.groups.iter().map(|group| group.group.name()).collect();
        add(
            "Nominal model",
            format!(
                "fitted for small sets ({}): the smallest sets cost {} before and {} after; {} in \
                 the mean with one motion left out of the fit",
                groups.join(", "),
                four_decimals(fit.identified_cost),
                four_decimals(fit.cost),
                four_decimals(fit.left_out_mean())
            ),
        );
        let changed = fit.parameters.iter().filter(|p| p.has_changed());
        let words: Vec<String> = changed.map(|p| parameter(model, p)).collect();
        add("Fitted parameters", words.join("; "));
    }
    if let Some(calibration) = &model.calibration {
        let gauge = |g: &reachtube_conform::Gauge| format!("{} {}", g.motion, at_least(g.gauge));
        let gauges: Vec<String> = calibration.gauges.iter().map(gauge).collect();
        add(
            "Calibration",
            format!(
                "the smallest sets of {} motions, scaled by {}, the largest that a motion kept \
                 back needs: {}",
                calibration.fitted.len(),
                at_least(calibration.factor),
                gauges.join(", ")
            ),
        );
    }
    if let Some(any) = &model.any_run {
        add("Cost of the sets for any run", four_decimals(any.cost));
    }
    facts
}

/// Returns what must not be concluded from a fitted nominal model.
pub(super) fn nominal_caution(model: &Model) -> Option<String> {
    model.fit.as_ref().map(|_| {
        "The parameters of the nominal model were chosen for small sets. They are no measurements \
         of the robot, and predict its torque worse than the identified ones may."
            .into()
    })
}

fn parameter(model: &Model, p: &FittedParameter) -> String {
    format!(
        "{} of {} {} in place of {} {}",
        p.name,
        model.robot.joints[p.joint - 1].name,
        four_decimals(p.fitted),
        four_decimals(p.identified),
        p.unit
    )
}
