//! Verdicts as text.

use reachtube_finding::{Report, Section, Table};
use reachtube_scalar::number::at_least;

use crate::body::body::Body;
use crate::report_stops::triggers;
use crate::scene::scenario::Scene;
use crate::verdict::clearance::Clearance;
use crate::verdict::findings::{findings, worst_first};
use crate::verdict::stop_verdict::lower;
use crate::verdict::verification::Verification;

/// Number of undecided motions for which the report says what would decide; JSON has all.
const MOST_ADVICE: usize = 3;

/// Returns the verdicts as a report: the worst first and what would decide, then tables of the
/// motions, of the stops and of the margins.
#[must_use]
pub fn report(all: &[Verification], body: &Body, scene: &Scene) -> Report {
    let order = worst_first(all);
    let mut findings = findings(all, body, scene);
    findings.truncate(1 + MOST_ADVICE);
    let closest = match order[..] {
        [one] => links(one),
        _ => motions(&order),
    };
    let section = |table: Table| Section { tables: vec![table], ..Section::default() };
    let stops = triggers(all).map(|(table, words)| {
        let mut stops = section(table);
        stops.fact("standstill", words);
        stops
    });
    let first = Section { findings, ..section(closest) };
    let others = stops.into_iter().chain([section(margins(all, body))]);
    Report { sections: [first].into_iter().chain(others).collect() }
}

/// Returns how close each link comes to its closest obstacle on one motion, as a table.
fn links(v: &Verification) -> Table {
    let mut seen = Vec::new();
    let closest = v.clearances.iter().filter(|pair| {
        let first = !seen.contains(&&pair.link);
        seen.push(&pair.link);
        first
    });
    let distance = |distance| if distance > 0.0 { lower(distance) } else { "none".into() };
    let row = |pair: &Clearance| {
        let time = format!("{:.3}", pair.time);
        vec![pair.link.clone(), pair.obstacle.clone(), distance(pair.distance), time]
    };
    Table::new(["link of", "obstacle", "distance [m]", "at [s]"], closest.map(row).collect())
        .titled("the smallest proved distance of each link")
}

fn motions(order: &[&Verification]) -> Table {
    let header = ["motion", "answer", "closest link", "obstacle", "proved distance [m]", "at [s]"];
    Table::new(header, order.iter().map(|v| row(v)).collect()).titled("motions, the worst first")
}

fn row(v: &Verification) -> Vec<String> {
    let motion = v.clearances.first().map(|p| (&p.link, &p.obstacle, p.distance, p.time));
    let stop = v.stops.iter().flat_map(|stops| stops.clearances.first());
    let stop = stop.map(|p| (&p.link, &p.obstacle, p.distance, p.from));
    // A stop counts from the sample at which it begins.
    let pair = motion.into_iter().chain(stop).min_by(|a, b| a.2.total_cmp(&b.2));
    let mut row = vec![v.case.clone(), v.answer.to_string()];
    match pair {
        None => row.extend(vec![String::new(); 4]),
        Some((link, obstacle, distance, time)) => row.extend([
            link.clone(),
            obstacle.clone(),
            if distance > 0.0 { lower(distance) } else { "none".into() },
            format!("{time:.3}"),
        ]),
    }
    row
}

fn margins(all: &[Verification], body: &Body) -> Table {
    let mut rows: Vec<Vec<String>> = Vec::new();
    let mut links: Vec<usize> = body.capsules().iter().map(|capsule| capsule.joint).collect();
    links.sort_unstable();
    links.dedup();
    for joint in links {
        let of_link = all.iter().flat_map(|v| v.margins.iter().map(move |m| (v, m)));
        let of_link = of_link.filter(|(_, margin)| margin.joint == joint);
        let Some((v, margin)) = of_link.max_by(|a, b| a.1.distance.total_cmp(&b.1.distance)) else {
            continue;
        };
        let time = format!("{:.3}", margin.time);
        rows.push(vec![
            body.joint_name(joint).into(),
            at_least(margin.distance),
            v.case.clone(),
            time,
        ]);
    }
    Table::new(["link of", "margin [m]", "motion", "at [s]"], rows)
        .titled("margins: how far a link can be from its nominal motion")
}
