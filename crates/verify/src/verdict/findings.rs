//! Verdicts as findings.

use crate::code::Code;
use reachtube_finding::{Finding, Severity};

use crate::body::body::Body;
use crate::scene::scenario::Scene;
use crate::verdict::decide::NextStep;
use crate::verdict::stop_verdict::{closest_found, lower, stop_verdict};
use crate::verdict::verification::{Answer, Verification};

/// Returns the findings: the verdict about the worst motion, then what would decide about each
/// motion that is undecided.
#[must_use]
pub fn findings(all: &[Verification], body: &Body, scene: &Scene) -> Vec<Finding> {
    let order = worst_first(all);
    let links = match links_without_capsule(body, scene) {
        Some(_) => "each link with a capsule",
        None => "each link",
    };
    let verdict = order.first().map(|worst| verdict(worst, [&until_words(all), links], scene));
    verdict.into_iter().chain(order.iter().filter_map(|v| next(v))).collect()
}

/// Returns a warning that names the links that an obstacle concerns and that have no capsule:
/// nothing is proved of them.
#[must_use]
pub fn links_without_capsule(body: &Body, scene: &Scene) -> Option<Finding> {
    let has_none = |joint: &usize| body.capsules().iter().all(|capsule| capsule.joint != *joint);
    let concerns = |joint: &usize| scene.obstacles.iter().any(|it| it.concerns(*joint));
    let names = (0..body.joint_count()).filter(has_none).filter(concerns);
    let names: Vec<&str> = names.map(|joint| body.joint_name(joint)).collect();
    let text = format!(
        "The links of {} have no capsule: nothing is proved of them, and an obstacle may touch \
         them.",
        names.join(", ")
    );
    let warning = Finding::new(Severity::Warning, Code::LinksLeftOut, text);
    (!names.is_empty()).then_some(warning)
}

/// Returns the verdicts with the worst first: unsafe before undecided before safe, and then by the
/// smallest proved distance.
#[must_use]
pub fn worst_first(all: &[Verification]) -> Vec<&Verification> {
    let mut order: Vec<&Verification> = all.iter().collect();
    order.sort_by(|a, b| b.answer.cmp(&a.answer).then(proved(a).total_cmp(&proved(b))));
    order
}

fn proved(v: &Verification) -> f64 {
    let motion = v.clearances.first().map(|pair| pair.distance);
    let stop = v.stops.as_ref().and_then(|stops| Some(stops.clearances.first()?.distance));
    motion.into_iter().chain(stop).fold(f64::INFINITY, f64::min)
}

/// Returns up to which time the motions last, to follow the word "model".
fn until_words(all: &[Verification]) -> String {
    let ends = all.iter().filter_map(|one| one.reach.times.last().copied());
    let [first, last] = ends.fold([f64::INFINITY, 0.0], |[first, last], end| {
        [f64::min(first, end), f64::max(last, end)]
    });
    match first < last {
        true => format!(" up to {first:.3} to {last:.3} s"),
        false => format!(" up to {last:.3} s"),
    }
}

fn verdict(worst: &Verification, [until, links]: [&str; 2], scene: &Scene) -> Finding {
    let keep = match scene.clearance {
        0.0 => String::new(),
        clearance => format!(" more than {clearance} m"),
    };
    let case = &worst.case;
    let stopped = stop_verdict(worst, &keep, links);
    let (severity, code, text) = match (worst.answer, worst.clearances.first()) {
        (Answer::Unsafe, _) => {
            (Severity::Failure, Code::Unsafe, too_close(worst).unwrap_or_default())
        }
        (Answer::Safe, Some(pair)) => {
            let text = format!(
                "safe: on every motion of the model{until} {links} stays{keep} clear; the \
                 smallest proved distance is {} m, of the link of {} from `{}` at {:.3} s \
                 ({case}).",
                lower(pair.distance),
                pair.link,
                pair.obstacle,
                pair.time
            );
            (Severity::Info, Code::Safe, text)
        }
        (_, Some(pair)) => {
            let text = format!(
                "undecided: no distance{keep} is proved between the link of {} and `{}` at {:.3} s \
                 ({case}){}.",
                pair.link,
                pair.obstacle,
                pair.time,
                closest_found(worst),
            );
            (Severity::Failure, Code::Undecided, text)
        }
        (_, None) => {
            let text = format!("undecided: the reachable set ends before the motion ({case}).");
            (Severity::Failure, Code::Undecided, text)
        }
    };
    let simulated = worst.closest.as_ref().map_or(f64::INFINITY, |found| found.distance);
    let finding = Finding::new(severity, code, stopped.unwrap_or(text));
    finding.at(case).with("proved_distance", proved(worst)).with("simulated_distance", simulated)
}

fn too_close(worst: &Verification) -> Option<String> {
    let found = worst.closest.as_ref()?;
    let how = match found.distance {
        overlap if overlap < 0.0 => format!("overlaps `{}` by {:.4} m", found.obstacle, -overlap),
        near => format!("is {near:.4} m from `{}`", found.obstacle),
    };
    let (link, time, case) = (&found.link, found.time, &worst.case);
    let when = match (&found.stop, &worst.stops) {
        (Some(stop), Some(stops)) => {
            format!("after a stop of category {} at {:.3} s", stops.category, stop.from)
        }
        _ => "on a motion of the model".into(),
    };
    Some(format!("unsafe: {when}, the link of {link} {how} at {time:.3} s ({case})."))
}

fn next(v: &Verification) -> Option<Finding> {
    let case = &v.case;
    let info = |code: reachtube_finding::Code, text: String| {
        Finding::new(Severity::Info, code, text).at(case)
    };
    Some(match v.advice? {
        NextStep::Refine(parts) => info(
            Code::StepsTooLong.into(),
            format!("{case}: `refine = {parts}` in the scenario proves that all links stay clear."),
        )
        .with("refine", parts.into()),
        NextStep::SmallerSets(factor) => info(
            Code::SetsTooLarge.into(),
            format!(
                "{case}: with uncertainty sets {factor:.2} times as wide, all links would be \
                 proved to stay clear; a better model or cleaner recordings give smaller sets."
            ),
        )
        .with("factor", factor),
        NextStep::Slower(part) => info(
            Code::PlanTooFast.into(),
            format!(
                "{case}: at {} % of its speed, all links are proved to stay clear.",
                (100.0 * part).floor()
            ),
        )
        .with("part", part),
        NextStep::Nominal => info(
            Code::NominalTooClose.into(),
            format!(
                "{case}: without any uncertainty no distance is proved either; move the obstacle \
                 or the motion."
            ),
        ),
        NextStep::Brakes => info(
            Code::BrakeWeak.into(),
            format!(
                "{case}: without any uncertainty no standstill is proved either; the brakes may \
                 be too weak for the load, or the span of `delay` too long."
            ),
        ),
        NextStep::SetLost => info(
            reachtube_conform::Code::SetLost.into(),
            format!(
                "{case}: the reachable set ends before the motion; `until` in the scenario uses \
                 only the samples before."
            ),
        ),
        NextStep::NotTried => info(
            Code::SetsNotTried.into(),
            format!(
                "{case}: smaller sets may decide; they were not tried, as each takes long to \
                 compute for a model that is not linear."
            ),
        ),
    })
}
