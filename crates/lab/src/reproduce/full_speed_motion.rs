//! Random motions in which every joint reaches its speed limit.

use reachtube_robot::{Joint, Robot};

use crate::error::{Error, Result};
use crate::motion::{Motion, QUINTIC_PEAK};
use crate::random::{SplitMix64, sign, uniform};

/// Longest duration of a motion \[s\]: joints of 1.2 rad/s travel 1.92 rad in it.
const DURATION: f64 = 3.0;

/// Largest travel of a joint over the width of its range \[-\].
const TRAVEL_RATIO: f64 = 0.9;

/// Speed limit of a joint for which none is known \[rad/s\].
const USUAL_SPEED: f64 = 1.2;

/// The range of a joint.
struct Axis {
    /// Least position \[rad\].
    low: f64,
    /// Largest position \[rad\].
    high: f64,
    /// Peak speed \[rad/s\].
    speed: f64,
}

/// Draws a motion in which each joint peaks at its speed limit, in a random direction from a random
/// position, within the joint's limits and within `range` \[rad\] of 0.
///
/// # Errors
///
/// Fails with [`Error::NoRange`] if a joint has no such position.
pub(super) fn full_speed_motion(
    robot: &Robot,
    range: f64,
    random: &mut SplitMix64,
) -> Result<Motion> {
    let axes = robot.joints().iter().map(|joint| axis(joint, range));
    let axes: Vec<Axis> = axes.collect::<Result<_, _>>()?;
    // All joints share the duration that the joint with the least range allows.
    let longest = |axis: &Axis| TRAVEL_RATIO * (axis.high - axis.low) * QUINTIC_PEAK / axis.speed;
    let duration = axes.iter().map(longest).fold(DURATION, f64::min);
    let along = |axis: &Axis| {
        let distance = axis.speed * duration / QUINTIC_PEAK;
        let travel = sign(random) * distance;
        (uniform(random, axis.low, axis.high - distance) + (distance - travel) / 2.0, travel)
    };
    let (start, travel) = axes.iter().map(along).unzip();
    Ok(Motion { start, travel, duration })
}

fn axis(joint: &Joint, range: f64) -> Result<Axis> {
    let limits = joint.position_limits;
    let [low, high] = [limits[0].max(-range), limits[1].min(range)];
    if low < high {
        return Ok(Axis { low, high, speed: joint.velocity_limit.unwrap_or(USUAL_SPEED) });
    }
    Err(Error::NoRange { joint: joint.name.clone(), range, limits })
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::random::SeedableRng;

    proptest! {
        #[test]
        fn motions_have_their_peak_and_stay_in_range(seed: u64, range in 0.01..4.0f64) {
            let random = &mut SplitMix64::seed_from_u64(seed);
            let motion = full_speed_motion(&Robot::lwa4p(), range, random).unwrap();
            let peak = motion.at(motion.duration / 2.0);
            prop_assert!(peak.qd.iter().all(|qd| (qd.abs() - 1.2).abs() < 1e-12));
            for part in [0.0, 0.3, 1.0] {
                let q = motion.at(part * motion.duration).q;
                prop_assert!(q.iter().all(|q| q.abs() <= range.min(std::f64::consts::PI) + 1e-12));
            }
        }
    }

    #[test]
    fn an_empty_range_is_refused() {
        let random = &mut SplitMix64::seed_from_u64(1);
        let refusal = full_speed_motion(&Robot::lwa4p(), -1.0, random).unwrap_err();
        assert!(
            refusal.to_string().contains("joint1") && refusal.to_string().contains("wider range")
        );
    }
}
