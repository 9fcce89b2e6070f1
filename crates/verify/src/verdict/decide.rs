//! Changes that decide an open question.

use reachtube_arm::OfArm;
use reachtube_conform::{Error, SuiteReach, Tube, UncertaintySets, reach};
use reachtube_reach::Hyperrectangle;
use schemars::JsonSchema;
use serde::Serialize;

use crate::scene::scenario::Scene;
use crate::stop::category::Category;
use crate::stop::rule::StopRule;
use crate::verdict::clearance::{Clearance, clearances};
use crate::verdict::question::Question;
use crate::verdict::stops::MotionStops;

type Result<T> = std::result::Result<T, Error>;

/// Numbers of parts of a step that are tried.
pub(super) const PARTS: [u32; 2] = [64, 512];

/// Halvings of the interval in which the factor of the sets lies, for motions and for stops.
pub(super) const HALVINGS: [u32; 2] = [6, 4];

/// Changes that decide an open question, found by trial.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum NextStep {
    /// Steps divided into this number of parts prove that the links stay clear.
    Refine(u32),
    /// The sets scaled by this factor about their centres, with steps divided into 64 parts, prove
    /// that the links stay clear.
    SmallerSets(f64),
    /// The plan at this part of its speed is proved to stay clear.
    Slower(f64),
    /// Without any uncertainty no distance is proved either: the nominal motion itself comes too
    /// close.
    Nominal,
    /// Without any uncertainty no standstill is proved either: the brakes are too weak, or the
    /// span of their delay is too long.
    Brakes,
    /// The reachable set ends before the motion does.
    SetLost,
    /// Sets of a model that is not linear were not tried, as each takes long to compute.
    NotTried,
}

/// Finds what would decide whether the links stay clear over the case `index` of a problem.
///
/// # Errors
///
/// As [`reach()`].
pub(super) fn advice(question: &Question, index: usize) -> Result<NextStep> {
    let Question { problem, tube, body, scene } = *question;
    let is_clear = |tube: &Tube, parts: u32| -> Result<bool> {
        let reached = &reach(problem, tube)?[index];
        let all = clearances(body, scene, reached, parts);
        Ok(reached.lost.is_none() && clears(&all, scene))
    };
    for parts in PARTS.into_iter().filter(|parts| *parts > scene.refine) {
        if is_clear(tube, parts)? {
            return Ok(NextStep::Refine(parts));
        }
    }
    if problem.dynamics().linear_system().is_none() {
        return Ok(NextStep::NotTried);
    }
    let with = |factor: f64| is_clear(&Tube::new(problem, scaled(&tube.sets, factor))?, PARTS[0]);
    if with(0.0)? { largest(HALVINGS[0], with) } else { Ok(NextStep::Nominal) }
}

/// Finds what would decide whether the links stay clear until standstill.
///
/// # Errors
///
/// As [`reach()`].
pub(super) fn stop_advice(question: &Question, rule: &StopRule, index: usize) -> Result<NextStep> {
    let Question { problem, tube, body, scene } = *question;
    if problem.dynamics().linear_system().is_none() {
        return Ok(NextStep::NotTried);
    }
    let with = |factor: f64| -> Result<(MotionStops, bool)> {
        let sets = scaled(&tube.sets, factor);
        let reached: &SuiteReach = &reach(problem, &Tube::new(problem, sets)?)?[index];
        let stops =
            MotionStops::new(problem.robot(), (body, scene), &narrowed(rule, factor), reached);
        let is_clear =
            rule.distance.is_some() || clears(&clearances(body, scene, reached, PARTS[0]), scene);
        let is_clear = is_clear && reached.lost.is_none() && stops.is_clear(scene);
        Ok((stops, is_clear))
    };
    match with(0.0)? {
        (_, true) => largest(HALVINGS[1], |factor| Ok(with(factor)?.1)),
        (stops, false) if stops.proved < stops.samples => Ok(NextStep::Brakes),
        _ => Ok(NextStep::Nominal),
    }
}

/// Returns the largest factor of the sets that decides, found by bisection from 0, which does.
pub(super) fn largest<E>(
    halvings: u32,
    decides: impl Fn(f64) -> core::result::Result<bool, E>,
) -> core::result::Result<NextStep, E> {
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..halvings {
        let middle = 0.5 * (low + high);
        if decides(middle)? { low = middle } else { high = middle }
    }
    Ok(NextStep::SmallerSets(low))
}

/// Scales how far the torque of the drives may be from the controller's.
fn narrowed(rule: &StopRule, factor: f64) -> StopRule {
    let category = match &rule.category {
        Category::Zero => Category::Zero,
        Category::One { limits, input_set } => {
            Category::One { limits: limits.clone(), input_set: scaled_set(input_set, factor) }
        }
    };
    StopRule { category, ..rule.clone() }
}

/// Returns whether all distances are above the clearance that is requested.
pub(super) fn clears(all: &[Clearance], scene: &Scene) -> bool {
    all.iter().all(|pair| pair.distance > scene.clearance)
}

fn scaled(sets: &UncertaintySets, factor: f64) -> UncertaintySets {
    UncertaintySets {
        initial_set: scaled_set(&sets.initial_set, factor),
        input_set: scaled_set(&sets.input_set, factor),
        noise_set: sets.noise_set.clone(),
    }
}

fn scaled_set(set: &Hyperrectangle, factor: f64) -> Hyperrectangle {
    let radius = set.radius.iter().map(|r| r * factor).collect();
    Hyperrectangle { centre: set.centre.clone(), radius }
}
