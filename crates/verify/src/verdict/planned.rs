//! Verdicts about plans that an arm follows under its controller.

use std::convert::Infallible;

use reachtube_conform::SuiteReach;
use reachtube_robot::Robot;

use crate::body::body::Body;
use crate::error::{Error, Result};
use crate::scene::scenario::Scene;
use crate::verdict::clearance::{Clearance, clearances};
use crate::verdict::decide::{HALVINGS, NextStep, PARTS, clears, largest};
use crate::verdict::verification::{Answer, Verification, answered};
use crate::verdict::witness::{Surroundings, Witness};

/// The lowest part of its speed at which a plan is tried.
const SLOWEST: f64 = 0.125;

/// Decides whether the links of a robot stay clear while its joints stay in a reachable set that
/// does not depend on what happened before, such as of an arm that follows a plan. `at_speed`
/// returns the set of the same plan at a part of its speed.
///
/// # Guarantee
///
/// Safe is proved with directed rounding, for all motions in the set and at every time. Unsafe
/// rests on a motion in the set, in floating point, that comes closer than the clearance by more
/// than 1e-6 m.
///
/// # Errors
///
/// [`Error::NoPair`], and [`Error::SingleSample`].
pub fn verify_plan(
    robot: &Robot,
    (body, scene): (&Body, &Scene),
    at_speed: &dyn Fn(f64) -> Option<SuiteReach>,
    reach: SuiteReach,
) -> Result<Verification> {
    scene.refuse_without_pair(body)?;
    if reach.times.len() < 2 {
        return Err(Error::SingleSample { case: reach.name() });
    }
    let mut clearances = clearances(body, scene, &reach, scene.refine);
    clearances.sort_by(|a, b| a.distance.total_cmp(&b.distance));
    let proved = clears(&clearances, scene);
    let around = Surroundings { robot, body, scene };
    let open = clearances.iter().filter(|pair| pair.distance <= scene.clearance);
    let found = open.map(|pair| around.closest_in(&reach, pair));
    let closest = found.min_by(|a, b| a.distance.total_cmp(&b.distance));
    let answer = answered(closest.as_ref(), proved, scene);
    let advice = (!proved).then(|| advice(&around, at_speed, (answer, &reach))).flatten();
    let (case, margins) = (reach.name(), body.margins(&reach));
    let (stops, lost) = (None, None);
    Ok(Verification { case, answer, clearances, margins, closest, advice, stops, lost, reach })
}

/// Finds what would decide, or what would make a plan safe: shorter parts of steps, a lower speed,
/// or smaller sets.
fn advice(
    around: &Surroundings,
    at_speed: &dyn Fn(f64) -> Option<SuiteReach>,
    (answer, reach): (Answer, &SuiteReach),
) -> Option<NextStep> {
    let Surroundings { body, scene, .. } = *around;
    let is_clear =
        |reach: &SuiteReach, parts: u32| clears(&clearances(body, scene, reach, parts), scene);
    let is_open = answer == Answer::Undecided;
    let mut finer = PARTS.into_iter().filter(|parts| is_open && *parts > scene.refine);
    if let Some(parts) = finer.find(|parts| is_clear(reach, *parts)) {
        return Some(NextStep::Refine(parts));
    }
    let slower = |part: f64| at_speed(part).is_some_and(|reach| is_clear(&reach, scene.refine));
    if !slower(SLOWEST) {
        let with = |factor: f64| is_clear(&scaled(reach, factor), PARTS[0]);
        return match with(0.0) {
            true => largest(HALVINGS[0], |factor| Ok::<_, Infallible>(with(factor))).ok(),
            false => Some(NextStep::Nominal),
        };
    }
    let (mut low, mut high) = (SLOWEST, 1.0);
    for _ in 0..HALVINGS[0] {
        let middle = 0.5 * (low + high);
        if slower(middle) { low = middle } else { high = middle }
    }
    Some(NextStep::Slower(low))
}

/// Returns a reachable set with its bounds at samples scaled by a factor about their centres.
fn scaled(reach: &SuiteReach, factor: f64) -> SuiteReach {
    let bounds = reach.lower.iter().zip(&reach.upper);
    let scaled = bounds.map(|(low, high)| {
        let (centre, half) = (low.midpoint(*high), 0.5 * factor * (high - low));
        (centre - half, centre + half)
    });
    let (lower, upper) = scaled.unzip();
    SuiteReach { lower, upper, ..reach.clone() }
}

impl Surroundings<'_> {
    /// Returns the motion in a reachable set that brings a link closest to an obstacle: at each
    /// sample in the corner that is the closest where no distance was proved.
    fn closest_in(&self, reach: &SuiteReach, pair: &Clearance) -> Witness {
        let width = reach.dimension;
        let n = width / 2;
        let at = (pair.step + 1).min(reach.times.len() - 1);
        let centre =
            |k: usize, i: usize| reach.lower[k * width + i].midpoint(reach.upper[k * width + i]);
        let q: Vec<f64> = (0..n).map(|i| centre(at, i)).collect();
        let slope = self.slope(pair, &q, reach.times[at]);
        let state = |index: usize| {
            let (k, i) = (index / width, index % width);
            match i < n {
                true if slope[i] > 0.0 => reach.lower[index],
                true => reach.upper[index],
                false => centre(k, i),
            }
        };
        let states: Vec<f64> = (0..reach.times.len() * width).map(state).collect();
        let of = (pair.joint, pair.index);
        let distances = states.chunks_exact(width).zip(&reach.times);
        let distances = distances.map(|(x, time)| (self.distance(of, &x[..n], *time), *time));
        let closest = distances.min_by(|a, b| a.0.total_cmp(&b.0));
        let (distance, time) = closest.expect("a reachable set has samples");
        Witness {
            link: pair.link.clone(),
            obstacle: pair.obstacle.clone(),
            distance,
            time,
            start: states[..width].to_vec(),
            stop: None,
            inputs: vec![],
            times: reach.times.clone(),
            states,
        }
    }
}
