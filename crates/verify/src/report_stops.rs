//! Verdicts about stops as text.

use reachtube_conform::result::Table;
use reachtube_scalar::number::{at_least, outward};

use crate::verdict::stops::{MotionStops, TriggerDistance};
use crate::verdict::verification::{Answer, Verification};

/// Returns the verdict about a motion as a sentence if its stops decide: always if a stop is
/// triggered at a distance, and else if they come closer than the motion without a stop.
pub(crate) fn stop_verdict(worst: &Verification, keep: &str) -> Option<String> {
    let stops = worst.stops.as_ref()?;
    let closest = stops.clearances.first();
    let motion = worst.clearances.first();
    let decides = match (closest, motion) {
        _ if stops.triggered_at.is_some() => true,
        (Some(stop), Some(motion)) => stop.distance <= motion.distance,
        _ => stops.samples == 0,
    };
    if worst.answer == Answer::Unsafe || !decides && worst.answer != Answer::Safe {
        return None;
    }
    let case = &worst.case;
    let category = stops.category;
    if stops.samples == 0 {
        return Some(format!(
            "undecided: no stop of category {category} ends before the motion does ({case})."
        ));
    }
    let when = match stops.triggered_at {
        Some(distance) => format!("that is triggered at {distance} m"),
        None => "from any sample".into(),
    };
    let Some(stop) = closest else { return Some("safe: no obstacle concerns a link.".into()) };
    let (link, obstacle, from) = (&stop.link, &stop.obstacle, stop.from);
    if worst.answer != Answer::Safe {
        let why = if stop.distance == f64::NEG_INFINITY {
            "no standstill is proved".into()
        } else {
            format!("no distance{keep} is proved between the link of {link} and `{obstacle}`")
        };
        return Some(format!(
            "undecided: after a stop of category {category} at {from:.3} s, {why} ({case})."
        ));
    }
    let closest = match motion {
        Some(motion) if !decides => format!(
            "{} m, of the link of {} from `{}` at {:.3} s without a stop",
            lower(motion.distance),
            motion.link,
            motion.obstacle,
            motion.time
        ),
        _ => format!(
            "{} m, of the link of {link} from `{obstacle}` after a stop at {from:.3} s",
            lower(stop.distance)
        ),
    };
    Some(format!(
        "safe: up to a stop of category {category} {when} and until standstill, each link \
         stays{keep} clear; the smallest proved distance is {closest} ({case})."
    ))
}

/// Returns the distances at which a stop must be triggered as a table, and which samples are
/// covered as sentences; `None` if no motion has stops.
pub(crate) fn triggers(all: &[Verification]) -> Option<(Table, String)> {
    let stops: Vec<(&str, &MotionStops)> =
        all.iter().filter_map(|v| Some((v.case.as_str(), v.stops.as_ref()?))).collect();
    let mut links: Vec<(&str, &TriggerDistance)> = Vec::new();
    for (case, link) in stops.iter().flat_map(|(case, s)| s.trigger.iter().map(|t| (*case, t))) {
        match links.iter_mut().find(|(_, known)| known.link == link.link) {
            Some((_, known)) if known.distance >= link.distance => {}
            Some(known) => *known = (case, link),
            None => links.push((case, link)),
        }
    }
    let row = |(case, link): (&str, &TriggerDistance)| {
        let of = |value: f64| if value.is_finite() { at_least(value) } else { "none".into() };
        let from = format!("{:.3}", link.from);
        vec![link.link.clone(), of(link.distance), of(link.way), of(link.time), case.into(), from]
    };
    if stops.is_empty() {
        return None;
    }
    let header = ["link of", "trigger at [m]", "way [m]", "time [s]", "motion", "stop at [s]"];
    let table = Table {
        title: "stops: how far a person who walks must be when a stop is triggered".into(),
        ..Table::new(header, links.into_iter().map(row).collect())
    };
    let count = |of: fn(&MotionStops) -> usize| stops.iter().map(|(_, stops)| of(stops)).sum();
    let (samples, proved): (usize, usize) = (count(|s| s.samples), count(|s| s.proved));
    let skipped: usize = count(|s| s.skipped);
    let mut text =
        format!("Standstill is proved for the stops from {proved} of {samples} samples.");
    if skipped > 0 {
        text += &format!(
            " Stops from {skipped} samples are not covered: they end after the motion does."
        );
    }
    Some((table, text))
}

/// Formats a proved distance with four decimals, rounded down.
pub(crate) fn lower(distance: f64) -> String {
    let [low, _] = outward([distance, distance], 4);
    low
}
