//! Verdicts as text.

use reachtube_conform::result::Table;
use reachtube_scalar::number::at_least;

use crate::body::body::Body;
use crate::report_stops::{lower, stop_verdict, triggers};
use crate::scene::scenario::Scene;
use crate::verdict::decide::Advice;
use crate::verdict::verification::{Answer, Verification};

/// Returns the verdicts as text: the worst first, a table of the motions, the margins, and what to
/// do next.
#[must_use]
pub fn report(all: &[Verification], body: &Body, scene: &Scene) -> String {
    let order = worst_first(all);
    let mut lines: Vec<String> =
        order.first().map(|worst| verdict(worst, scene)).into_iter().collect();
    lines.push(String::new());
    lines.push(motions(&order).to_string());
    lines.extend(triggers(all).map(|(table, words)| format!("{table}{words}\n")));
    lines.push(margins(all, body).to_string());
    let advice: Vec<String> = order.iter().filter_map(|v| next(v)).collect();
    lines.extend(advice.into_iter().take(3));
    lines.join("\n").trim_end().to_string() + "\n"
}

/// Returns the verdicts with the worst first: unsafe before undecided before safe, and then by the
/// smallest proved distance.
#[must_use]
pub fn worst_first(all: &[Verification]) -> Vec<&Verification> {
    let smallest = |v: &Verification| {
        let motion = v.clearances.first().map(|pair| pair.distance);
        let stop = v.stops.as_ref().and_then(|stops| Some(stops.clearances.first()?.distance));
        motion.into_iter().chain(stop).fold(f64::INFINITY, f64::min)
    };
    let mut order: Vec<&Verification> = all.iter().collect();
    order.sort_by(|a, b| b.answer.cmp(&a.answer).then(smallest(a).total_cmp(&smallest(b))));
    order
}

/// Returns the verdict about the worst motion as a sentence, and tables of the motions with the
/// worst first, of the stops and of the margins.
#[must_use]
pub fn summary(all: &[Verification], body: &Body, scene: &Scene) -> (String, Vec<Table>) {
    let order = worst_first(all);
    let sentence = order.first().map_or_else(String::new, |worst| verdict(worst, scene));
    let stops = triggers(all).map(|(table, _)| table);
    let first = Table { title: "motions, the worst first".into(), ..motions(&order) };
    let tables = [first].into_iter().chain(stops).chain([margins(all, body)]);
    (sentence, tables.collect())
}

fn motions(order: &[&Verification]) -> Table {
    let header = ["motion", "answer", "closest link", "obstacle", "proved distance [m]", "at [s]"];
    Table::new(header, order.iter().map(|v| row(v)).collect())
}

/// Returns the verdict about the worst motion as a sentence.
fn verdict(worst: &Verification, scene: &Scene) -> String {
    let keep = match scene.clearance {
        0.0 => String::new(),
        clearance => format!(" more than {clearance} m"),
    };
    let case = &worst.case;
    if let Some(sentence) = stop_verdict(worst, &keep) {
        return sentence;
    }
    match (worst.answer, worst.clearances.first(), &worst.closest) {
        (Answer::Unsafe, _, Some(found)) => {
            let how = match found.distance {
                overlap if overlap < 0.0 => {
                    format!("overlaps `{}` by {:.4} m", found.obstacle, -overlap)
                }
                near => format!("is {near:.4} m from `{}`", found.obstacle),
            };
            format!(
                "unsafe: on a motion of the model, the link of {} {how} at {:.3} s ({case}).",
                found.link, found.time
            )
        }
        (Answer::Safe, Some(pair), _) => format!(
            "safe: on every motion of the model each link stays{keep} clear; the smallest proved \
             distance is {} m, of the link of {} from `{}` at {:.3} s ({case}).",
            lower(pair.distance),
            pair.link,
            pair.obstacle,
            pair.time
        ),
        (Answer::Safe, None, _) => "safe: no obstacle concerns a link.".into(),
        (_, Some(pair), found) => format!(
            "undecided: no distance{keep} is proved between the link of {} and `{}` at {:.3} s \
             ({case}); the closest motion found stays {} m away.",
            pair.link,
            pair.obstacle,
            pair.time,
            found.as_ref().map_or("?".into(), |found| format!("{:.4}", found.distance)),
        ),
        (_, None, _) => format!("undecided: the reachable set ends before the motion ({case})."),
    }
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

/// Returns the largest margin of each link as a table.
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

/// Returns what would decide an open question, as a sentence.
fn next(v: &Verification) -> Option<String> {
    let case = &v.case;
    Some(match v.advice? {
        Advice::Refine(parts) => {
            format!("{case}: `refine = {parts}` in the scenario proves that all links stay clear.")
        }
        Advice::SmallerSets(factor) => format!(
            "{case}: with X0 and U {factor:.2} times as wide, all links would be proved to stay \
             clear; a better model or cleaner recordings give smaller sets."
        ),
        Advice::Nominal => format!(
            "{case}: without any uncertainty no distance is proved either; move the obstacle or \
             the motion."
        ),
        Advice::SetLost => format!(
            "{case}: the reachable set ends before the motion; `until` in the scenario uses only \
             the samples before."
        ),
        Advice::NotTried => format!(
            "{case}: smaller sets may decide; they were not tried, as each takes long to compute \
             for a model that is not linear."
        ),
    })
}
