//! Sets that satisfy every row up to rounding, made true (docs/method.md, correction H).

use crate::claim::claim::Claim;
use crate::claim::look::Look;
use crate::data::problem::Problem;
use crate::error::Result;
use crate::sets::UncertaintySets;
use crate::tube::judged::At;
use crate::tube::plant::Plant;
use crate::tube::tube::Tube;

/// Attempts until every row is proved, and until every point is.
const ATTEMPTS: [i32; 2] = [61, 24];

/// Checks sets of an exact plant with directed rounding, and inflates their radii more and more
/// until every row and what is claimed are proved, or for a number of times. `scale` is the largest
/// deviation.
pub(crate) fn prove(
    (problem, plant): (&Problem, &dyn Plant),
    claim: &dyn Claim,
    sets: &UncertaintySets,
    scale: f64,
) -> Result<Tube> {
    let (mut left, mut points): (Option<Vec<At>>, Option<usize>) = Default::default();
    let attempts = ATTEMPTS[usize::from(claim.tolerance().is_some())];
    for attempt in 0.. {
        let [factor, term] = room(claim.tolerance(), attempt);
        // Points that were proved for smaller sets lie in larger ones.
        let look = Look::Proof { at: left.take(), asked: Vec::new() };
        let mut tube = claim.judge(plant, &sets.inflated(1.0 + factor, term * scale), &look)?;
        let mut is_proved = encloses(problem, &tube)?;
        if let Some(judged) = &mut tube.judged {
            judged.points = *points.get_or_insert(judged.points);
            is_proved &= judged.left.is_empty();
            left = Some(judged.left.iter().copied().collect());
        }
        if is_proved || attempt + 1 == attempts {
            return Ok(tube);
        }
    }
    unreachable!("the last attempt returns")
}

/// Returns the part by which radii grow in an attempt, and the part of the largest deviation that
/// is added: a growing last bit for rows, and the tolerance of the search for points.
fn room(tolerance: Option<f64>, attempt: i32) -> [f64; 2] {
    match tolerance {
        Some(tolerance) => [tolerance * 2f64.powi(attempt), f64::EPSILON * 4f64.powi(attempt)],
        None if attempt == 0 => [0.0; 2],
        None => [f64::EPSILON * 2f64.powi(attempt - 1); 2],
    }
}

pub(crate) fn encloses(problem: &Problem, tube: &Tube) -> Result<bool> {
    let mut all = true;
    tube.for_each_row(problem, |row| all &= row.holds())?;
    Ok(all)
}
