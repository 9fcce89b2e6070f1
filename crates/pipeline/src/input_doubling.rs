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

/// Number of horizons over which it is judged, at most.
const COMPARED: usize = 3;

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
        None => growing(trial, recordings, up_to(&horizons, largest), given)?,
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

/// Returns the longest horizon at which sets are narrow, and up to two below it, the longest last.
fn up_to(horizons: &[HorizonWidths], largest: f64) -> &[HorizonWidths] {
    let longest = longest(horizons, largest).horizon;
    let count = horizons.iter().take_while(|widths| widths.horizon <= longest).count();
    &horizons[count.saturating_sub(COMPARED)..count]
}

/// Returns the accelerations at which U is twice what it is at rest, and why; none if the widest
/// set, with the mean factor for motions left out, is not narrower by a fifth then, and narrower
/// than the motion. It is judged over the horizon that is given, or on average over horizons at
/// which sets are narrow where U is the same along every motion, `same`: at a single one, some
/// window decides that another cut of the logs does not have.
fn growing(
    trial: &Trial,
    recordings: &Prepared,
    same: &[HorizonWidths],
    given: Option<f64>,
) -> Result<(Vec<f64>, String)> {
    let (joint, width) = same.last().expect("a horizon was tried").worst_smallest();
    if width > HOPELESS {
        let (joint, width) = (&trial.robot.joints()[joint].name, percent(width));
        let reason =
            format!("the set of {joint} is {width} of its motion, too wide for it to help");
        return Ok((Vec::new(), reason));
    }
    let typical = typical_accelerations(recordings.logs);
    let widest = |horizon: f64, input_doubling: Option<Vec<f64>>| {
        let trial = Trial { input_doubling, ..trial.of_horizons(given) };
        let widths = try_horizon(&trial, recordings, horizon, MOST_WINDOWS)?;
        Ok::<_, Error>(widths.map_or(f64::INFINITY, |widths| widths.foretold))
    };
    let horizons = given.map_or_else(|| same.iter().map(|own| own.horizon).collect(), |h| vec![h]);
    let (mut logarithms, mut last) = (0.0, [f64::INFINITY; 2]);
    for horizon in &horizons {
        last = [widest(*horizon, Some(typical.clone()))?, widest(*horizon, None)?];
        logarithms += (last[0] / last[1]).ln();
    }
    let ([own, other], ratio) = (last, (logarithms / horizons.len() as f64).exp());
    let horizons: Vec<String> = horizons.iter().map(ToString::to_string).collect();
    let reason = format!(
        "where U grows with the acceleration of the nominal motion, the widest set, with the mean \
         factor for motions left out, is {} as wide over {} s as where it does not, at last {} in \
         place of {} of the motion",
        percent(ratio),
        horizons.join(", "),
        percent(own),
        percent(other)
    );
    // A set as wide as the motion foretells nothing, and the choice has no ground.
    let is_better = own < 1.0 && ratio < HELPS;
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
