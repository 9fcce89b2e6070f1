//! What `conform` prints of motions that were not recorded.

use std::fmt::Write;

use reachtube::Model;
use reachtube::conform::{Calibration, Notion};
use reachtube::number::at_least;

use crate::table::plural;

/// Largest number of gauges that are listed.
const MOST_GAUGES: usize = 12;

/// Returns how the sets were calibrated, and the strongest statement about the next motion.
pub(super) fn next_motion(model: &Model) -> String {
    let mut text = String::new();
    if let Some(calibration) = &model.calibration {
        let _ = writeln!(text, "\n{}", calibrated(calibration));
    }
    let set = model.proof.enclosure.set_name();
    let _ = writeln!(text, "\n{}", model.trust.words(set, "touched the set"));
    let can_calibrate = model.calibration.is_none() && model.settings.notion == Notion::Hull;
    let says_little = can_calibrate && model.trust.violation_probability > 0.5;
    if says_little && model.data.motions() > 1 {
        text.push_str(
            "a bound that says more: --calibrate MOTION,.. keeps n motions back from the fit, and \
             the next one then leaves the sets with probability at most 1 in n + 1\n",
        );
    }
    text
}

/// Says which motions calibrated the sets, and by what factor.
fn calibrated(calibration: &Calibration) -> String {
    let Calibration { fitted, gauges, factor, input_only } = calibration;
    let gauge =
        |gauge: &reachtube::conform::Gauge| format!("{} {}", gauge.motion, at_least(gauge.gauge));
    let mut list: Vec<String> = gauges.iter().take(MOST_GAUGES).map(gauge).collect();
    if gauges.len() > MOST_GAUGES {
        list.push(format!("{} more", gauges.len() - MOST_GAUGES));
    }
    format!(
        "calibrated: {} of the smallest sets for {} {} was scaled about the centres by {}, the \
         largest that a motion kept back needs ({})",
        if *input_only { "U" } else { "each of X0 and U" },
        fitted.len(),
        plural(fitted.len(), "motion"),
        at_least(*factor),
        list.join(", ")
    )
}
