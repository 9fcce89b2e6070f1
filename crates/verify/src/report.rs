//! Verdicts as text.

use reachtube_finding::Table;
use reachtube_scalar::number::at_least;

use crate::body::body::Body;
use crate::report_stops::triggers;
use crate::scene::scenario::Scene;
use crate::verdict::clearance::Clearance;
use crate::verdict::findings::{findings, worst_first};
use crate::verdict::stop_verdict::lower;
use crate::verdict::verification::{Answer, Verification};

/// Returns the verdicts as text: the worst first, a table of the motions, the margins, and what to
/// do next.
#[must_use]
pub fn report(all: &[Verification], body: &Body, scene: &Scene) -> String {
    let order = worst_first(all);
    let findings = findings(all, body, scene);
    let (verdict, advice) = findings.split_at(findings.len().min(1));
    let mut lines: Vec<String> = verdict.iter().map(|finding| finding.text.clone()).collect();
    lines.push(String::new());
    lines.push(match order[..] {
        [one] => links(one).to_string(),
        _ => motions(&order).to_string(),
    });
    lines.extend(triggers(all).map(|(table, words)| format!("{table}{words}\n")));
    lines.push(margins(all, body).to_string());
    lines.extend(advice.iter().take(3).map(|finding| finding.text.clone()));
    lines.join("\n").trim_end().to_string() + "\n"
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
    Table {
        title: "the smallest proved distance of each link".into(),
        ..Table::new(["link of", "obstacle", "distance [m]", "at [s]"], closest.map(row).collect())
    }
}

/// Returns the verdict about the worst motion and what would decide as sentences, and tables of the
/// motions with the worst first, of the stops and of the margins.
#[must_use]
pub fn summary(all: &[Verification], body: &Body, scene: &Scene) -> (Vec<String>, Vec<Table>) {
    let order = worst_first(all);
    let mut sentences: Vec<String> =
        findings(all, body, scene).into_iter().map(|finding| finding.text).collect();
    let stops = triggers(all).map(|(table, words)| {
        sentences.push(words);
        table
    });
    let first = Table { title: "motions, the worst first".into(), ..motions(&order) };
    let tables = [first].into_iter().chain(stops).chain([margins(all, body)]);
    let tables = tables.collect();
    (sentences, tables)
}

fn motions(order: &[&Verification]) -> Table {
    let header = ["motion", "answer", "closest link", "obstacle", "proved distance [m]", "at [s]"];
    Table::new(header, order.iter().map(|v| row(v)).collect())
}

fn row(v: &Verification) -> Vec<String> {
    let answer = match v.answer {
        Answer::Safe => "safe",
        Answer::Undecided => "undecided",
        Answer::Unsafe => "unsafe",
    };
    let motion = v.clearances.first().map(|p| (&p.link, &p.obstacle, p.distance, p.time));
    let stop = v.stops.iter().flat_map(|stops| stops.clearances.first());
    let stop = stop.map(|p| (&p.link, &p.obstacle, p.distance, p.from));
    // A stop counts from the sample at which it begins.
    let pair = motion.into_iter().chain(stop).min_by(|a, b| a.2.total_cmp(&b.2));
    let mut row = vec![v.case.clone(), answer.into()];
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
    Table {
        title: "margins: how far a link can be from its nominal motion".into(),
        ..Table::new(["link of", "margin [m]", "motion", "at [s]"], rows)
    }
}
