//! The verdict about each motion.

use reachtube_conform::tube::Lost;
use reachtube_conform::{Problem, SuiteReach, Tube, reach};
use serde::Serialize;

use crate::body::body::Body;
use crate::error::Result;
use crate::margin::Margin;
use crate::scene::scenario::Scene;
use crate::verdict::clearance::{Clearance, clearances};
use crate::verdict::decide::{Advice, advice, clears};
use crate::verdict::stops::MotionStops;
use crate::verdict::witness::{Approach, Witness};

/// A simulated motion overlaps an obstacle only if it does so by more than the error of the
/// simulation, m.
const TOUCH: f64 = 1e-6;

/// Whether the links stay clear of the obstacles.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Answer {
    /// On every motion of the model each link keeps the clearance.
    Safe,
    /// No distance was proved, and no motion was found that comes too close.
    Undecided,
    /// A motion of the model comes too close.
    Unsafe,
}

/// The verdict about a suite, or about a run that has its own nominal motion.
#[derive(Debug, Clone, Serialize)]
pub struct Verification {
    /// The suite, and the run.
    pub case: String,
    /// The answer.
    pub answer: Answer,
    /// The smallest proved distance of each link from each obstacle, smallest first.
    pub clearances: Vec<Clearance>,
    /// The margin of each link about the nominal motion.
    pub margins: Vec<Margin>,
    /// The simulated motion that comes closest, unless the answer is safe.
    pub closest: Option<Witness>,
    /// What would decide, if the answer is undecided.
    pub advice: Option<Advice>,
    /// The stops from the samples of the motion, if the scenario has any.
    pub stops: Option<MotionStops>,
    /// Where the reachable set ends early, if it does.
    pub lost: Option<Lost>,
    /// The reachable set.
    #[serde(skip)]
    pub reach: SuiteReach,
}

/// Decides for each motion of a problem whether the links stay clear under the sets of `tube`.
///
/// # Guarantee
///
/// Safe is proved with directed rounding, for every motion of the model from X0 under U and at
/// every time. Unsafe rests on a motion that is simulated in floating point and comes closer than
/// the clearance by more than 1e-6 m.
///
/// # Errors
///
/// As [`reach()`](reach()).
pub fn verify(
    problem: &Problem,
    tube: &Tube,
    body: &Body,
    scene: &Scene,
) -> Result<Vec<Verification>> {
    let reached = reach(problem, tube)?;
    let cases = problem.cases()?.iter().zip(reached).enumerate();
    let decide = |(index, (case, reach)): (usize, (&reachtube_conform::data::Case, SuiteReach))| {
        let mut clearances = clearances(body, scene, &reach, scene.refine);
        clearances.sort_by(|a, b| a.distance.total_cmp(&b.distance));
        let margins = body.margins(&reach);
        let lost = reach.lost.clone();
        let proved = clears(&clearances, scene);
        let closest = if proved {
            None
        } else {
            let approach = Approach { problem, case, sets: &tube.sets, body, scene };
            let open = clearances.iter().filter(|pair| pair.distance <= scene.clearance);
            let found = open.filter_map(|pair| approach.closest(pair));
            found.min_by(|a, b| a.distance.total_cmp(&b.distance))
        };
        let answer = match &closest {
            Some(found) if found.distance < scene.clearance - TOUCH => Answer::Unsafe,
            _ if proved && lost.is_none() => Answer::Safe,
            _ => Answer::Undecided,
        };
        let advice = match (answer, &lost) {
            (Answer::Undecided, Some(_)) => Some(Advice::SetLost),
            (Answer::Undecided, None) => Some(advice(problem, tube, (body, scene), index)?),
            _ => None,
        };
        let case = case.name.clone();
        let stops = None;
        Ok(Verification { case, answer, clearances, margins, closest, advice, stops, lost, reach })
    };
    cases.map(decide).collect()
}
