//! The verdict about a motion whose stops decide, as a sentence.

use reachtube_scalar::number::outward;

use crate::verdict::verification::{Answer, Verification};

/// Returns the verdict about a motion as a sentence if its stops decide: always if a stop is
/// triggered at a distance, and else if they come closer than the motion without a stop. `keep`
/// names the distance to keep, and `links` the links.
pub(crate) fn stop_verdict(worst: &Verification, keep: &str, links: &str) -> Option<String> {
    let stops = worst.stops.as_ref()?;
    let closest = stops.clearances.first();
    let motion = worst.clearances.first();
    let decides = match (closest, motion) {
        _ if stops.covered_until.is_none() || stops.triggered_at.is_some() => true,
        (Some(stop), Some(motion)) => stop.distance <= motion.distance,
        _ => false,
    };
    if worst.answer == Answer::Unsafe || !decides && worst.answer != Answer::Safe {
        return None;
    }
    let case = &worst.case;
    let category = stops.category;
    let (Some(until), Some(stop)) = (stops.covered_until, closest) else {
        return Some(format!(
            "undecided: the stop of category {category} from the first sample ends after the \
             motion does ({case})."
        ));
    };
    let when = match stops.triggered_at {
        Some(distance) => format!("that is triggered at {distance} m up to {until:.3} s"),
        None => format!("from any sample up to {until:.3} s"),
    };
    let (link, obstacle, from) = (&stop.link, &stop.obstacle, stop.from);
    if worst.answer != Answer::Safe {
        let (why, found) = if stop.distance == f64::NEG_INFINITY {
            ("no standstill is proved".into(), String::new())
        } else {
            let why =
                format!("no distance{keep} is proved between the link of {link} and `{obstacle}`");
            (why, closest_found(worst))
        };
        return Some(format!(
            "undecided: after a stop of category {category} at {from:.3} s, {why} ({case}){found}."
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
        "safe: up to a stop of category {category} {when} and until standstill, {links} \
         stays{keep} clear; the smallest proved distance is {closest} ({case})."
    ))
}

/// Returns how close the motion comes that was found, to follow a sentence; empty without one.
pub(crate) fn closest_found(worst: &Verification) -> String {
    worst.closest.as_ref().map_or(String::new(), |found| {
        format!(
            "; on the closest motion found, the link of {} stays {:.4} m from `{}`",
            found.link, found.distance, found.obstacle
        )
    })
}

/// Formats a proved distance with four decimals, rounded down.
pub(crate) fn lower(distance: f64) -> String {
    let [low, _] = outward([distance, distance], 4);
    low
}
