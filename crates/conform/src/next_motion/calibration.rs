use std::collections::BTreeSet;
use std::path::Path;

use reachtube_recordings::matching;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::claim::look::Look;
use crate::claim::notion::{claim, plant};
use crate::data::problem::Problem;
use crate::error::{Error, Result};
use crate::next_motion::left_out::LeftOutMotions;
use crate::next_motion::motions::Motions;
use crate::next_motion::outer_gauge::{OuterGauge, STEP, outer_gauge};
use crate::next_motion::point_gauge::point_gauge;
use crate::program::program::{Program, TIGHT};
use crate::progress::Progress;
use crate::search::found::{Deciding, Found};
use crate::search::prove::prove;
use crate::search::smallest_sets::smallest_sets;
use crate::sets::UncertaintySets;
use crate::tube::flowpipes::Effort;
use crate::tube::tube::Tube;
use reachtube_finding::Advice;

/// Sets that were found on some motions and then scaled so that they enclose the others, which were
/// held out: split conformal calibration.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Calibration {
    /// The motions that the sets were found on.
    pub fitted: Vec<String>,
    /// The motions that were held out, each with its gauge.
    pub gauges: Vec<Gauge>,
    /// The factor of the radii: the largest gauge.
    pub factor: f64,
    /// Whether only U was scaled, because the noise of the sensors limits X0.
    pub input_only: bool,
    /// Number of models in the folder of the model file, with this one, that were calibrated by
    /// some of the same recordings. The bound counts them, because the best of several models is
    /// not one that was chosen beforehand.
    #[serde(default = "one", skip_serializing_if = "is_one")]
    pub candidates: usize,
}

impl Calibration {
    pub(crate) fn held_out(&self) -> impl Iterator<Item = &str> {
        self.gauges.iter().map(|gauge| gauge.motion.as_str())
    }
}

/// The gauge of a motion.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Gauge {
    /// The motion.
    pub motion: String,
    /// The factor, at least 1, by which the radii must grow about their centres so that the sets
    /// enclose the motion.
    pub gauge: f64,
}

fn one() -> usize {
    1
}

fn is_one(count: &usize) -> bool {
    *count == 1
}

/// Finds the smallest sets for the motions that the settings do not hold out, and scales their
/// radii until they enclose the others too. V is not scaled, because it is the noise of the
/// sensors; nor is X0 where that noise limits it.
///
/// # Errors
///
/// A motion that is unknown, none left to find the sets with, a motion that no factor suffices
/// for; as [`conform`](crate::conform).
pub(crate) fn calibrate(
    problem: &Problem,
    left_out: Option<LeftOutMotions>,
    how: (&dyn Progress, Option<&Path>),
) -> Result<(Found, Calibration)> {
    let motions = Motions::new(problem.recordings());
    let held_out = held_out(problem, &motions)?;
    let fit = problem.with_suites(|suite| !held_out.contains(motions.of_suite(suite)));
    let first = smallest_sets(&fit, &*claim(&fit)?, left_out, how)?;
    let Found { tube: Tube { sets: fitted, .. }, search, left_out, .. } = first;
    let input_only = problem.settings().nominal.is_measured();
    let linear =
        problem.dynamics().linear_system().map(|_| Program::of_problem(problem)).transpose()?;
    let grown = |factor: f64| fitted.grown(factor, input_only);
    let gauge = |motion: &&str| {
        let suites: Vec<bool> = (0..problem.recordings().suites.len())
            .map(|s| motions.of_suite(s) == *motion)
            .collect();
        let gauge = match &linear {
            Some(program) => {
                let rows = linear_gauge(problem, program, &fitted, &suites, input_only)?;
                let own = problem.with_suites(|suite| suites[suite]);
                rows.map_or(Ok(None), |rows| point_gauge(&own, rows, &grown))
            }
            None => match outer_gauge(problem, &suites, Effort::Whole, (1.0, 1), &grown)? {
                OuterGauge::Factor(factor) => Ok(Some(factor)),
                OuterGauge::None => Ok(None),
                OuterGauge::Lost(factor) => {
                    let lost = Advice::from(lost(motion, factor));
                    Err(Error::Calibration(lost.with("until", "")))
                }
            },
        }?;
        let gauge =
            gauge.ok_or_else(|| Error::Calibration(no_factor(motion, input_only).into()))?;
        Ok(Gauge { motion: (*motion).to_string(), gauge })
    };
    let gauges = held_out.iter().map(gauge).collect::<Result<Vec<_>>>()?;
    let scale = linear.as_ref().map(Program::scale);
    let factor = gauges.iter().map(|gauge| gauge.gauge).fold(1.0, f64::max);
    let found = Found { search, left_out, ..not_smallest(problem, &grown(factor), scale)? };
    let all = motions.distinct().into_iter();
    let others = all.filter(|motion| !held_out.contains(motion)).map(String::from).collect();
    let candidates = 1;
    let calibration = Calibration { fitted: others, gauges, factor, input_only, candidates };
    Ok((found, calibration))
}

/// Returns the problem of the motions that the settings do not hold out; `None` if they hold
/// none out.
pub(crate) fn without_held_out(problem: &Problem) -> Result<Option<Problem>> {
    if problem.settings().calibrate.is_empty() {
        return Ok(None);
    }
    let motions = Motions::new(problem.recordings());
    let held_out = held_out(problem, &motions)?;
    Ok(Some(problem.with_suites(|suite| !held_out.contains(motions.of_suite(suite)))))
}

/// Returns the motions that the settings hold out, or why that cannot be.
fn held_out<'a>(problem: &'a Problem, motions: &Motions<'a>) -> Result<BTreeSet<&'a str>> {
    let notion = problem.settings().notion;
    let is_linear = problem.dynamics().linear_system().is_some();
    if notion.asks_points() && !is_linear {
        let problem = "sets are calibrated for the notions hull, phase-plane and exact of a linear \
                       model, and for hull of any other; use the notion hull";
        return Err(Error::Calibration(Advice::from(problem).with("notion", "hull")));
    }
    let all = motions.distinct();
    let mut held_out = BTreeSet::new();
    for name in &problem.settings().calibrate {
        let known = matching(name, all.iter().copied());
        if known.is_empty() {
            let all = all.join(", ");
            let unknown =
                format!("there is no motion \"{name}\"; the motions of the recordings are {all}");
            return Err(Error::Calibration(unknown.into()));
        }
        held_out.extend(known);
    }
    if held_out.len() == all.len() {
        return Err(Error::Calibration(
            "all motions are held out, so that none is left to find the sets with; name fewer \
             motions, or record more"
                .into(),
        ));
    }
    Ok(held_out)
}

fn no_factor(motion: &str, input_only: bool) -> String {
    let sets =
        if input_only { "U, which alone may grow beside the sensor noise," } else { "X0 and U" };
    format!(
        "no factor of {sets} makes the sets of the other motions enclose motion {motion}; a set \
         may have no width in a direction in which it deviates, or its reachable set is lost; \
         hold out other motions, or find the sets with this one"
    )
}

fn linear_gauge(
    problem: &Problem,
    program: &Program,
    sets: &UncertaintySets,
    suites: &[bool],
    input_only: bool,
) -> Result<Option<f64>> {
    let own = problem.deviations()?.iter().filter(|deviation| suites[deviation.suite]);
    Ok(program.with_deviations(own).growth(sets, input_only))
}

fn lost(motion: &str, factor: f64) -> String {
    format!(
        "the reachable sets of motion {motion} are lost when the sets grow {factor:.2} times, and \
         less does not enclose the motion; hold out other motions, find the sets with this one, \
         or shorten the recordings"
    )
}

/// Returns sets that are not the smallest, so that there is no lower bound, with their reachable
/// sets over all recordings.
pub(crate) fn not_smallest(
    problem: &Problem,
    sets: &UncertaintySets,
    scale: Option<f64>,
) -> Result<Found> {
    let plant = &*plant(problem)?;
    let claim = &*claim(problem)?;
    let tube = match scale {
        Some(scale) => prove((problem, plant), claim, sets, scale)?,
        None => claim.judge(plant, sets, &Look::proof())?,
    };
    let costs = plant.costs(&tube)?;
    let touching = if costs.paper.is_some() { TIGHT } else { STEP - 1.0 };
    Ok(Found::new(tube, costs, Deciding::Touching(touching)))
}
