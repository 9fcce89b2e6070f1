//! The choice whether U grows with the nominal motion.
//!
//! What a robot's equations leave unexplained grows with its acceleration: gears, belts and the
//! lag of a torque all push where the robot accelerates. A U that holds for the fastest window is
//! too large for all others.

use reachtube_identify::prepare::PreparedLog;
use reachtube_scalar::number::significant;

use crate::chooser::Chooser;
use crate::error::{Error, Result};
use crate::horizon::{HorizonWidths, MOST_WINDOWS, longest, try_horizon, try_horizons};
use crate::remedies::HELPS;
use crate::rounding::{percent, rounded_up};
use crate::trial::Trial;
use crate::windows::Prepared;

/// Half a set's width by the joint's displacement from which on no scale of U makes it useful.
const HOPELESS: f64 = 2.0;

/// Accelerations below this, rad/s², belong to a joint that rests.
const REST: f64 = 1e-3;

/// Chooses whether U grows with the nominal motion. `horizons` are the widths where it is the same
/// along every motion; returns the widths of the choice.
///
/// # Errors
///
/// As [`try_horizons`]; a job that was cancelled.
pub(crate) fn choose_input_doubling(
    chooser: &mut Chooser,
    trial: &mut Trial,
    recordings: &Prepared,
    horizons: Vec<HorizonWidths>,
    largest: f64,
) -> Result<Vec<HorizonWidths>> {
    let given = chooser.choices.horizon;
    let is_fitted = chooser.choices.fit.as_ref().is_some_and(|groups| !groups.is_empty());
    let (doubling, reason) = match chooser.choices.input_doubling.clone() {
        Some(doubling) => (doubling, "given".to_string()),
        None if recordings.from_start => {
            (Vec::new(), "recordings of repeated motions share one nominal motion".into())
        }
        None if is_fitted => (Vec::new(), "a fit is of sets that every motion has".into()),
        None => growing(trial, recordings, longest(&horizons, largest), given)?,
    };
    let words: Vec<String> = doubling.iter().map(|rate| significant(*rate, 3)).collect();
    let value = if words.is_empty() { "none".into() } else { words.join(", ") };
    chooser.choose("input-doubling", value, reason);
    chooser.choices.input_doubling = Some(doubling.clone());
    trial.input_doubling = Some(doubling).filter(|doubling| !doubling.is_empty());
    match trial.input_doubling {
        Some(_) => try_horizons(&trial.of_horizons(given), recordings),
        None => Ok(horizons),
    }
}

/// Returns the accelerations at which U is twice what it is at rest, and why; none if the widest
/// set, with the factor for a motion that is left out, is not narrower by a fifth then, and
/// narrower than the motion. It is judged over the horizon that is given, or the one at which sets
/// are narrow where U is the same along every motion.
fn growing(
    trial: &Trial,
    recordings: &Prepared,
    same: &HorizonWidths,
    given: Option<f64>,
) -> Result<(Vec<f64>, String)> {
    let (joint, width) = same.worst_smallest();
    if width > HOPELESS {
        let (joint, width) = (&trial.robot.joints()[joint].name, percent(width));
        let reason =
            format!("the set of {joint} is {width} of its motion, too wide for it to help");
        return Ok((Vec::new(), reason));
    }
    let horizon = given.unwrap_or(same.horizon);
    let typical = typical_accelerations(recordings.logs);
    let widest = |input_doubling: Option<Vec<f64>>| {
        let trial = Trial { input_doubling, ..trial.of_horizons(given) };
        let widths = try_horizon(&trial, recordings, horizon, MOST_WINDOWS)?;
        Ok::<_, Error>(widths.map_or(f64::INFINITY, |widths| widths.foretold))
    };
    let [own, other] = [widest(Some(typical.clone()))?, widest(None)?];
    let reason = format!(
        "the widest set, with the factor for a motion left out, is {} of the motion at {horizon} s \
         where U grows with the acceleration of the nominal motion, and {} where it does not",
        percent(own),
        percent(other)
    );
    // A set as wide as the motion foretells nothing, and the choice has no ground.
    let is_better = own < 1.0 && own < HELPS * other;
    Ok((if is_better { typical } else { Vec::new() }, reason))
}

/// Returns the root mean square of each joint's recorded acceleration, rad/s².
fn typical_accelerations(logs: &[PreparedLog]) -> Vec<f64> {
    let joints = logs.first().map_or(0, |log| log.joints);
    let of = |joint: usize| {
        logs.iter().flat_map(move |log| log.qdd.iter().skip(joint).step_by(joints).copied())
    };
    (0..joints).map(|joint| typical(of(joint))).collect()
}

/// Returns the root mean square of accelerations, rounded up to three digits.
fn typical(accelerations: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) =
        accelerations.fold((0.0, 0usize), |(sum, count), qdd| (sum + qdd * qdd, count + 1));
    rounded_up((sum / count.max(1) as f64).sqrt().max(REST), 3)
}

#[cfg(test)]
mod tests {
    use super::typical;

    #[test]
    fn the_typical_acceleration_is_the_root_mean_square() {
        assert_eq!(typical([3.0, -3.0, 0.0, 0.0].into_iter()), 2.13);
        assert_eq!(typical([0.0; 4].into_iter()), 1e-3, "a joint that rests");
    }
}
