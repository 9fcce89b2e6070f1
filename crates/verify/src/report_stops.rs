//! Distances at which a stop must be triggered, as text.

use reachtube_finding::Table;
use reachtube_scalar::number::at_least;

use crate::verdict::stops::{MotionStops, TriggerDistance};
use crate::verdict::verification::Verification;

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
    let table = Table::new(header, links.into_iter().map(row).collect())
        .titled("stops: how far a person who walks must be when a stop is triggered");
    let count = |of: fn(&MotionStops) -> usize| stops.iter().map(|(_, stops)| of(stops)).sum();
    let (samples, proved): (usize, usize) = (count(|s| s.samples), count(|s| s.proved));
    let skipped: usize = count(|s| s.skipped);
    let mut text = format!("proved for the stops from {proved} of {samples} samples");
    if skipped > 0 {
        text += &format!("; {skipped} are not covered: they end after the motion does");
    }
    Some((table, text))
}
