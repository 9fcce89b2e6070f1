//! Verdicts as findings.

use reachtube_conform::Finding;
use reachtube_conform::result::{Code, Severity};

use crate::scene::scenario::Scene;
use crate::verdict::decide::Advice;
use crate::verdict::stop_verdict::{lower, stop_verdict};
use crate::verdict::verification::{Answer, Verification};

/// Returns the findings: the verdict about the worst motion, then what would decide about each
/// motion that is undecided.
#[must_use]
pub fn findings(all: &[Verification], scene: &Scene) -> Vec<Finding> {
    let order = worst_first(all);
    let verdict = order.first().map(|worst| verdict(worst, scene));
    verdict.into_iter().chain(order.iter().filter_map(|v| next(v))).collect()
}

/// Returns the verdicts with the worst first: unsafe before undecided before safe, and then by the
/// smallest proved distance.
#[must_use]
pub fn worst_first(all: &[Verification]) -> Vec<&Verification> {
    let mut order: Vec<&Verification> = all.iter().collect();
    order.sort_by(|a, b| b.answer.cmp(&a.answer).then(proved(a).total_cmp(&proved(b))));
    order
}

/// Returns the smallest proved distance of a motion and its stops \[m\].
fn proved(v: &Verification) -> f64 {
    let motion = v.clearances.first().map(|pair| pair.distance);
    let stop = v.stops.as_ref().and_then(|stops| Some(stops.clearances.first()?.distance));
    motion.into_iter().chain(stop).fold(f64::INFINITY, f64::min)
}

/// Returns the verdict about the worst motion.
fn verdict(worst: &Verification, scene: &Scene) -> Finding {
    let keep = match scene.clearance {
        0.0 => String::new(),
        clearance => format!(" more than {clearance} m"),
    };
    let case = &worst.case;
    let until = scene.until.map_or_else(String::new, |until| format!(" up to {until} s"));
    let stopped = stop_verdict(worst, &keep, &until);
    let finding = match worst.answer {
        Answer::Unsafe => {
            Finding::new(Severity::Failure, Code::Unsafe, too_close(worst).unwrap_or_default())
        }
        Answer::Safe => {
            let text = match worst.clearances.first() {
                Some(pair) => format!(
                    "safe: on every motion of the model{until} each link stays{keep} clear; the \
                     smallest proved distance is {} m, of the link of {} from `{}` at {:.3} s \
                     ({case}).",
                    lower(pair.distance),
                    pair.link,
                    pair.obstacle,
                    pair.time
                ),
                None => "safe: no obstacle concerns a link.".into(),
            };
            Finding::new(Severity::Info, Code::Safe, text)
        }
        Answer::Undecided => {
            let found = worst.closest.as_ref();
            let text = match worst.clearances.first() {
                Some(pair) => format!(
                    "undecided: no distance{keep} is proved between the link of {} and `{}` at \
                     {:.3} s ({case}); the closest motion found stays {} m away.",
                    pair.link,
                    pair.obstacle,
                    pair.time,
                    found.map_or("?".into(), |found| format!("{:.4}", found.distance)),
                ),
                None => format!("undecided: the reachable set ends before the motion ({case})."),
            };
            Finding::new(Severity::Warning, Code::Undecided, text)
        }
    };
    let simulated = worst.closest.as_ref().map_or(f64::INFINITY, |found| found.distance);
    let finding = Finding { text: stopped.unwrap_or(finding.text.clone()), ..finding };
    finding.at(case).with("proved_distance", proved(worst)).with("simulated_distance", simulated)
}

/// Returns how close the witness comes, as a sentence.
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

/// Returns what would decide an open question.
fn next(v: &Verification) -> Option<Finding> {
    let case = &v.case;
    let info = |code: Code, text: String| Finding::new(Severity::Info, code, text).at(case);
    Some(match v.advice? {
        Advice::Refine(parts) => info(
            Code::StepsTooLong,
            format!("{case}: `refine = {parts}` in the scenario proves that all links stay clear."),
        )
        .with("refine", parts.into()),
        Advice::SmallerSets(factor) => info(
            Code::SetsTooLarge,
            format!(
                "{case}: with X0 and U {factor:.2} times as wide, all links would be proved to \
                 stay clear; a better model or cleaner recordings give smaller sets."
            ),
        )
        .with("factor", factor),
        Advice::Nominal => info(
            Code::NominalTooClose,
            format!(
                "{case}: without any uncertainty no distance is proved either; move the obstacle \
                 or the motion."
            ),
        ),
        Advice::Brakes => info(
            Code::BrakeWeak,
            format!(
                "{case}: without any uncertainty no standstill is proved either; the brakes are \
                 too weak for the load."
            ),
        ),
        Advice::SetLost => info(
            Code::SetLost,
            format!(
                "{case}: the reachable set ends before the motion; `until` in the scenario uses \
                 only the samples before."
            ),
        ),
        Advice::NotTried => info(
            Code::SetsNotTried,
            format!(
                "{case}: smaller sets may decide; they were not tried, as each takes long to \
                 compute for a model that is not linear."
            ),
        ),
    })
}
