//! What an answer says of motions that were not recorded.

use reachtube_scalar::number::{at_least, counted, plural};

use crate::model::file::Model;
use crate::next_motion::calibration::{Calibration, Gauge};
use crate::next_motion::trust::Trust;
use crate::next_motion::trust_kind::TrustKind;
use crate::result::code::Code;
use reachtube_finding::{Finding, Remedy, Severity};

/// Largest number of gauges that are listed.
const MOST_GAUGES: usize = 12;

/// Bounds above this are worth holding motions out for.
const LITTLE: f64 = 0.5;

/// A bound above this probability is none.
const LARGEST_BOUND: f64 = 0.999;

pub(crate) fn calibrated(calibration: &Calibration) -> Finding {
    let Calibration { fitted, gauges, factor, input_only, .. } = calibration;
    let gauge = |gauge: &Gauge| format!("{} {}", gauge.motion, at_least(gauge.gauge));
    let mut list: Vec<String> = gauges.iter().take(MOST_GAUGES).map(gauge).collect();
    if gauges.len() > MOST_GAUGES {
        list.push(format!("{} more", gauges.len() - MOST_GAUGES));
    }
    let text = format!(
        "{} of the smallest sets for {} was scaled about the centres by {}, the largest \
         factor that a held-out motion needs ({}).",
        if *input_only { "U" } else { "Each of X0 and U" },
        counted(fitted.len(), "motion"),
        at_least(*factor),
        list.join(", ")
    );
    Finding::new(Severity::Info, Code::Calibrated, text).with("factor", *factor)
}

pub(crate) fn next_motion_of_fit(model: &Model) -> Finding {
    let Model { trust, proof, calibration, settings, data, .. } = model;
    let can_calibrate = calibration.is_none() && !settings.notion.asks_points();
    let could_say_more = can_calibrate && trust.violation_probability > LITTLE;
    let remedy =
        (could_say_more && data.motions() > 1).then(|| Remedy::new("calibrate", "MOTION,.."));
    next_motion(trust, proof.enclosure.set_name(), "touched the set").remedied_by(remedy)
}

/// The bound for the next motion; `set` names the set, and `role` says what the deciding
/// motions did.
pub(crate) fn next_motion(trust: &Trust, set: &str, role: &str) -> Finding {
    let Trust { motions, deciding, violation_probability: bound, confidence, .. } = trust;
    let basis = &trust.basis;
    let of_motions = plural(*motions, "motion");
    let percent = 100.0 * confidence;
    let with_numbers = |code, text: String| {
        Finding::new(Severity::Info, code, text)
            .with("motions", *motions as f64)
            .with("deciding", *deciding as f64)
            .with("probability", *bound)
            .with("confidence", *confidence)
    };
    if let Some(average) = trust.average_probability.filter(|average| *average < 1.0) {
        let (m, of) = (trust.candidates(), motions + 1);
        let several = match m {
            1 => String::new(),
            m => {
                format!(
                    " This counts the {m} models in the folder that these motions calibrated, and \
                     models that were replaced."
                )
            }
        };
        let text = format!(
            "The next motion leaves the {set} with probability at most {average:.3} ({m} in \
             {of}), on average over the {motions} held-out {of_motions}; given these, at most \
             {bound:.3} at confidence {percent:.0} %.{several} Basis: {basis}.",
        );
        return with_numbers(Code::NextMotion, text).with("average_probability", average);
    }
    if *bound > LARGEST_BOUND && *deciding == 0 {
        return with_numbers(Code::NoGuarantee, format!("No guarantee for new motions: {basis}."));
    }
    let counted = format!("{deciding} of {motions} independent {of_motions} {role}");
    if *bound > LARGEST_BOUND {
        let few = match motions {
            1 => "one recorded motion is too few".into(),
            2 => "two recorded motions are too few".into(),
            motions => format!("{motions} recorded motions are too few"),
        };
        let text = format!(
            "No guarantee for new motions: {few} for a bound below 99.9 % ({counted}). More \
             motions may give one; more runs of the same motions do not. Basis: {basis}."
        );
        return with_numbers(Code::NoGuarantee, text);
    }
    let leaves = match trust.kind {
        Some(TrustKind::Indication) => "An indication and no guarantee: the next motion leaves",
        _ => "The next motion leaves",
    };
    let text = format!(
        "{leaves} the {set} with probability at most {bound:.3}, at confidence {percent:.0} \
         %: {counted}. Basis: {basis}."
    );
    with_numbers(Code::NextMotion, text)
}

/// Returns the strongest statement about the next motion in a few words; `role` says what the
/// deciding motions do.
pub(crate) fn next_motion_in_brief(trust: &Trust, role: &str) -> String {
    let Trust { motions, deciding, violation_probability: bound, confidence, .. } = trust;
    let of_motions = counted(*motions, "motion");
    if trust.average_probability.is_some_and(|average| average < 1.0) {
        let (most, verb) = match trust.candidates() {
            1 => (1, "leaves"),
            several => (several, "leave"),
        };
        return format!(
            "at most {most} in {} {verb} the sets, on average over the {of_motions} held out",
            motions + 1
        );
    }
    match *bound > LARGEST_BOUND {
        true if *deciding == 0 => format!("no guarantee: {}", trust.basis),
        true if *motions == 1 => "no guarantee: 1 motion is too few".into(),
        true => format!("no guarantee: {of_motions} are too few"),
        false => format!(
            "{}the next leaves the sets with probability at most {bound:.3}, at confidence \
             {:.0} % ({deciding} of {of_motions} {role})",
            match trust.kind {
                Some(TrustKind::Indication) => "an indication and no guarantee: ",
                _ => "",
            },
            100.0 * confidence
        ),
    }
}

/// That there is no bound, because recordings of the check were used in the fit.
pub(crate) fn fitted_to_these() -> Finding {
    let text = "No guarantee for new motions: the model was fitted to some of these recordings.";
    Finding::new(Severity::Info, Code::NoGuarantee, text)
}
