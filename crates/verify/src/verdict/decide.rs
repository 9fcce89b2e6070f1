//! What would decide a question that is open.

use reachtube_conform::{Problem, Result, Tube, UncertaintySets, reach};
use reachtube_reach::Hyperrectangle;
use serde::Serialize;

use crate::body::body::Body;
use crate::scene::scenario::Scene;
use crate::verdict::clearance::{Clearance, clearances};

/// Numbers of parts of a step that are tried.
const PARTS: [u32; 2] = [64, 512];

/// Halvings of the interval in which the factor of the sets lies.
const HALVINGS: u32 = 6;

/// What would decide a question that is open, found by trying.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Advice {
    /// Steps divided into this number of parts prove that the links stay clear.
    Refine(u32),
    /// X0 and U scaled by this factor about their centres, with steps divided into 64 parts, prove
    /// that the links stay clear.
    SmallerSets(f64),
    /// Without any uncertainty no distance is proved either: the nominal motion itself comes too
    /// close.
    Nominal,
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
pub(super) fn advice(
    problem: &Problem,
    tube: &Tube,
    (body, scene): (&Body, &Scene),
    index: usize,
) -> Result<Advice> {
    let is_clear = |tube: &Tube, parts: u32| -> Result<bool> {
        let reached = &reach(problem, tube)?[index];
        let all = clearances(body, scene, reached, parts);
        Ok(reached.lost.is_none() && clears(&all, scene))
    };
    for parts in PARTS.into_iter().filter(|parts| *parts > scene.refine) {
        if is_clear(tube, parts)? {
            return Ok(Advice::Refine(parts));
        }
    }
    if problem.dynamics().linear_system().is_none() {
        return Ok(Advice::NotTried);
    }
    let with = |factor: f64| is_clear(&Tube::new(problem, scaled(&tube.sets, factor))?, PARTS[0]);
    if !with(0.0)? {
        return Ok(Advice::Nominal);
    }
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        if with(middle)? { low = middle } else { high = middle }
    }
    Ok(Advice::SmallerSets(low))
}

/// Returns whether all distances are above the clearance that is asked for.
pub(super) fn clears(all: &[Clearance], scene: &Scene) -> bool {
    all.iter().all(|pair| pair.distance > scene.clearance)
}

/// Scales the radii of X0 and U.
fn scaled(sets: &UncertaintySets, factor: f64) -> UncertaintySets {
    let scale = |set: &Hyperrectangle| Hyperrectangle {
        centre: set.centre.clone(),
        radius: set.radius.iter().map(|r| r * factor).collect(),
    };
    UncertaintySets {
        initial_set: scale(&sets.initial_set),
        input_set: scale(&sets.input_set),
        noise_set: sets.noise_set.clone(),
    }
}
