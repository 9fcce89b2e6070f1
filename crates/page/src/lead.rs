//! The first lines of a page: the answer in numbers, and one figure of the widest set.

use reachtube_arm::ArmModel;
use reachtube_conform::plausibility::PartWidth;
use reachtube_conform::{Model, SuiteReach};
use reachtube_pipeline::{Built, HorizonWidths, WithoutModel};
use reachtube_robot::JointKind;
use reachtube_scalar::number::{significant, two_digits_up};

use crate::chart::{Area, Chart, Series};
use crate::error::Result;
use crate::page::Lead;
use crate::sources::{Sources, joint_name};
use crate::svg::{BLUE, GREY, INK, RED};
use crate::text::capital;

/// The farthest horizon that is drawn, in multiples of the one that was chosen.
const FARTHEST: f64 = 4.0;

/// Number of recordings of the suite that are drawn.
const MOST_RUNS: usize = 20;

/// Number of samples at which the set is drawn.
const MOST_SAMPLES: usize = 400;

/// Returns the first lines of a page about recordings.
///
/// # Errors
///
/// As [`Problem::run`](reachtube_conform::Problem::run).
pub(super) fn lead(sources: &Sources) -> Result<Lead> {
    let Sources { model, problem, check, .. } = *sources;
    let badges = match (problem.is_simulated(), model.data.simulated) {
        (true, _) => vec!["simulated data".into()],
        (false, true) => vec!["model made of simulated data".into()],
        (false, false) => Vec::new(),
    };
    let verdict = &check.verdict;
    let until = check.provenance.settings.until;
    let mut facts = match until.filter(|until| is_shorter(model, *until)) {
        Some(until) => vec![("Checked".into(), format!("the first {until} s of each recording"))],
        None => facts_of_sets(model),
    };
    let (outside, rows) = (verdict.violations.count, verdict.rows);
    facts.push(("Outside the set".into(), format!("{outside} of {rows} rows")));
    let (figure, caption) = over_time(sources)?.unzip();
    Ok(Lead { badges, facts, figure, caption: caption.unwrap_or_default(), links: Vec::new() })
}

/// Replaces the first lines of the page of a model that was made of logs by the lines about it.
pub(super) fn of_built(built: &Built, lead: &mut Lead) {
    lead.facts = facts_of_sets(&built.answer.model);
    lead.facts.push(("Held out".into(), built.held_out_words()));
    lead.facts.extend(built.allowance_words().map(|words| ("Allowance".into(), words)));
    let without = built.without_model.as_ref().map(WithoutModel::words);
    lead.facts.extend(without.map(|words| ("Without a model".into(), words)));
    lead.facts.push(("New motions".into(), built.next_motion()));
    if let Some((figure, caption)) = over_horizons(built) {
        (lead.figure, lead.caption) = (Some(figure), caption);
    }
}

/// Tells whether a check up to a time ends before the horizon of the model, which the widest set
/// of the model is about.
fn is_shorter(model: &Model, until: f64) -> bool {
    model.usefulness.as_ref().is_some_and(|said| until < said.horizon)
}

fn facts_of_sets(model: &Model) -> Vec<(String, String)> {
    let Some(said) = &model.usefulness else { return Vec::new() };
    let horizon = format!("{} s", significant(said.horizon, 3));
    let widest = said.worst().map(|(joint, _)| {
        let kind = model.arm().robot.joints[joint].kind;
        ("Widest set".into(), words(&joint_name(model, joint), &said.parts[joint], kind))
    });
    [("Horizon".into(), horizon)].into_iter().chain(widest).collect()
}

fn words(name: &str, width: &PartWidth, kind: JointKind) -> String {
    let unit = kind.position_unit();
    match width.half_width {
        None => format!("{name}: it has no bound"),
        Some(half) => format!(
            "{name}: ± {} {unit}, {:.0} % of its motion",
            two_digits_up(half),
            100.0 * width.ratio()
        ),
    }
}

/// Returns the joint, from 0, whose set is the widest beside its motion.
fn worst(model: &Model) -> usize {
    let worst = model.usefulness.as_ref().and_then(|said| said.worst());
    worst.map_or(0, |(joint, _)| joint)
}

/// Draws the sets beside the motion by horizon, and returns the chart with its caption. `None` if
/// fewer than two horizons have sets.
fn over_horizons(built: &Built) -> Option<(Chart, String)> {
    let model = &built.answer.model;
    let (joint, name) = (worst(model), joint_name(model, worst(model)));
    let horizon = built.choices.horizon?;
    // The horizon of the model was tried on some windows too; its own sets hold for all of them.
    let joints = built.joints();
    let percent = |widths: &HorizonWidths, joint: usize| {
        let chosen = joints.get(joint).and_then(|row| row.ratio);
        let tried = widths.ratios.get(joint).copied();
        let ratio = if widths.horizon == horizon { chosen } else { tried };
        Some((widths.horizon, 100.0 * ratio.filter(|ratio| ratio.is_finite())?))
    };
    let shown = built.horizons.iter().filter(|widths| widths.horizon <= FARTHEST * horizon);
    let of = |joint: usize| -> Vec<(f64, f64)> {
        shown.clone().filter_map(|widths| percent(widths, joint)).collect()
    };
    let own = of(joint);
    let ([first, .., last], most) = (&own[..], built.largest_ratio()) else { return None };
    let others = (0..model.inputs()).filter(|other| *other != joint);
    let mut series: Vec<Series> = others.map(|other| Series::line(of(other), GREY)).collect();
    let highest = series.iter().flat_map(|series| &series.points).chain(&own);
    let highest = highest.map(|point| point.1).fold(100.0 * most, f64::max);
    series.push(Series::line([first, last].map(|end| (end.0, 100.0 * most)).to_vec(), RED));
    series.push(Series::line(vec![(horizon, 0.0), (horizon, highest)], INK));
    series.push(Series::line(own.clone(), BLUE));
    series.push(Series::dots(own.clone(), BLUE));
    let reason = built.made.iter().find(|choice| choice.key == "horizon");
    let reason = reason.map_or_else(String::new, |choice| because(horizon, &choice.reason));
    let first = built.horizons.iter().find(|widths| widths.with_fit);
    let without_fit = first.map_or_else(String::new, |first| {
        format!(" Horizons below {} s were tried without the fit.", first.horizon)
    });
    let caption = format!(
        "How wide the sets are beside the motion, by horizon: {name} (blue), whose set is the \
         widest at {horizon} s (vertical line), and the other joints (grey). Up to the red line, \
         {:.0} %, sets are useful. At {horizon} s the sets are for all windows. At other horizons \
         they may be for at most 200 windows, and the sets for all windows may be \
         wider.{reason}{without_fit} The ratio may be compared across horizons; the cost may not: \
         it adds rad to rad/s and grows with the length of the motions, so it is compared only \
         within one data set.",
        100.0 * most
    );
    let title = format!("Half the set of {name} by its motion");
    Some((Chart::new(title, "horizon [s]", "half the set / motion [%]", series), caption))
}

/// Returns why a horizon \[s\] was chosen, as a sentence: windows that are not drawn may decide.
fn because(horizon: f64, reason: &str) -> String {
    match reason {
        "" | "given" => String::new(),
        reason => format!(" Why {horizon} s: {}.", capital(reason)),
    }
}

/// Returns the longest reachable set. Windows are equally long: of several longest sets it is the
/// one in which the joint moves most.
fn longest(reach: &[SuiteReach], joint: usize) -> Option<&SuiteReach> {
    let end = |reach: &SuiteReach| reach.times.last().copied().unwrap_or(0.0);
    let motion = |reach: &SuiteReach| {
        let positions = reach.nominal.iter().skip(joint).step_by(reach.dimension);
        let [low, high] = positions
            .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], q| [low.min(*q), high.max(*q)]);
        high - low
    };
    reach
        .iter()
        .max_by(|a, b| end(a).total_cmp(&end(b)).then_with(|| motion(a).total_cmp(&motion(b))))
}

/// Draws the widest set over time within the longest suite, with its recordings, and returns the
/// chart with its caption.
fn over_time(sources: &Sources) -> Result<Option<(Chart, String)>> {
    let Sources { model, problem, reach, .. } = *sources;
    let joint = worst(model);
    let longest = longest(reach, joint);
    let Some(longest) = longest.filter(|reach| reach.times.len() > 1) else { return Ok(None) };
    let noise = model.sets().noise_radius(joint);
    let column = |values: &[f64]| -> Vec<f64> {
        values.iter().skip(joint).step_by(longest.dimension).copied().collect()
    };
    let [nominal, lower, upper] =
        [&longest.nominal, &longest.lower, &longest.upper].map(|values| column(values));
    if !lower.iter().chain(&upper).all(|bound| bound.is_finite()) {
        return Ok(None);
    }
    // The range of both edges over a few samples, so that the drawn set is not too small.
    let step = longest.times.len().div_ceil(MOST_SAMPLES);
    let edge = |values: &[f64], sign: f64| -> Vec<(f64, f64)> {
        let of = |(times, values): (&[f64], &[f64])| {
            let furthest = values.iter().map(|x| sign * x).fold(f64::MIN, f64::max);
            (times[times.len() - 1], sign * furthest + sign * noise)
        };
        longest.times.chunks(step).zip(values.chunks(step)).map(of).collect()
    };
    let area = Area { lower: edge(&lower, -1.0), upper: edge(&upper, 1.0) };
    let nominal = longest.times.iter().copied().zip(nominal).collect();
    let mut series = vec![Series::line(nominal, GREY)];
    let suites = problem.recordings().suites.iter();
    let runs = suites.filter(|suite| suite.entry.name == longest.suite).flat_map(|s| &s.runs);
    let is_drawn =
        |index: usize| longest.run.as_ref().is_none_or(|run| *run == problem.entry(index).file);
    for summary in runs.filter(|run| is_drawn(run.index)).take(MOST_RUNS) {
        let run = problem.run(summary.index)?;
        let points = (0..run.len()).map(|k| (run.times[k], run.q(k)[joint])).collect();
        series.push(Series::line(points, BLUE));
    }
    let (name, suite) = (joint_name(model, joint), &longest.suite);
    let with = if noise > 0.0 { " with V" } else { "" };
    let caption = format!(
        "The widest set beside the motion, of {name}, in the longest suite: the reachable \
         set{with} (grey area), the nominal motion (grey line) and the recorded motion (blue)."
    );
    let unit = &model.signals.states[joint].unit;
    let title = format!("{name} in suite {suite}");
    let chart = Chart::new(title, "time [s]", format!("position [{unit}]"), series);
    Ok(Some((Chart { areas: vec![area], ..chart }, caption)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_reason_of_a_horizon_is_a_sentence_of_its_caption() {
        let reason =
            "the widest set is 26 % of the motion (J1); at 1 s all windows give 130 % (J1)";
        let sentence = format!(" Why 0.5 s: T{}.", &reason[1..]);
        assert_eq!(because(0.5, reason), sentence);
        assert_eq!([because(0.5, "given"), because(0.5, "")], ["", ""]);
    }
}
