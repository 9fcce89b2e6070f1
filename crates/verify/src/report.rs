//! Verdicts as text.

use reachtube_conform::result::Table;
use reachtube_scalar::number::at_least;

use crate::body::body::Body;
use crate::scene::scenario::Scene;
use crate::verdict::findings::{findings, lower, worst_first};
use crate::verdict::verification::{Answer, Verification};

/// Returns the verdicts as text: the worst first, a table of the motions, the margins, and what to
/// do next.
#[must_use]
pub fn report(all: &[Verification], body: &Body, scene: &Scene) -> String {
    let order = worst_first(all);
    let findings = findings(all, scene);
    let (verdict, advice) = findings.split_at(findings.len().min(1));
    let mut lines: Vec<String> = verdict.iter().map(|finding| finding.text.clone()).collect();
    lines.push(String::new());
    let header = ["motion", "answer", "closest link", "obstacle", "proved distance [m]", "at [s]"];
    lines.push(Table::new(header, order.iter().map(|v| row(v)).collect()).to_string());
    lines.push(margins(all, body));
    lines.extend(advice.iter().take(3).map(|finding| finding.text.clone()));
    lines.join("\n").trim_end().to_string() + "\n"
}

fn row(v: &Verification) -> Vec<String> {
    let answer = match v.answer {
        Answer::Safe => "safe",
        Answer::Undecided => "undecided",
        Answer::Unsafe => "unsafe",
    };
    let mut row = vec![v.case.clone(), answer.into()];
    match v.clearances.first() {
        None => row.extend(vec![String::new(); 4]),
        Some(pair) => row.extend([
            pair.link.clone(),
            pair.obstacle.clone(),
            if pair.distance > 0.0 { lower(pair.distance) } else { "none".into() },
            format!("{:.3}", pair.time),
        ]),
    }
    row
}

/// Returns the largest margin of each link as a table.
fn margins(all: &[Verification], body: &Body) -> String {
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
    .to_string()
}
