//! Random motions within a robot's limits.

use reachtube_robot::Robot;

use crate::motion::{Motion, QUINTIC_PEAK};
use crate::random::{SplitMix64, sign, uniform};

/// Least and largest peak speed of the fastest joint of a motion \[rad/s\].
const PEAK_SPEED: [f64; 2] = [0.5, 1.0];

/// Largest planned speed of a joint over its limit \[-\]: the open loop may be faster than planned.
const SPEED_RATIO: f64 = 0.9;

/// Middle part of each joint's position range in which motions stay \[-\].
const POSITION_RATIO: f64 = 0.4;

/// Least travel of a joint over the fastest joint's \[-\].
const TRAVEL_RATIO: f64 = 0.1;

impl Motion {
    /// Draws a motion of a duration \[s\] within the robot's position and speed limits.
    pub(crate) fn random(robot: &Robot, duration: f64, random: &mut SplitMix64) -> Self {
        let joints = robot.joints();
        // Directions and relative speeds, and from them the travel.
        let ratio: Vec<f64> =
            joints.iter().map(|_| sign(random) * uniform(random, TRAVEL_RATIO, 1.0)).collect();
        let fastest = ratio.iter().fold(0.0, |most: f64, s| most.max(s.abs()));
        let peak = uniform(random, PEAK_SPEED[0], PEAK_SPEED[1]);
        let mut travel: Vec<f64> =
            ratio.iter().map(|s| s / fastest * peak * duration / QUINTIC_PEAK).collect();
        // The travel shrinks where a joint would leave its range or exceed its speed.
        let slack = joints.iter().zip(&travel).map(|(joint, travel)| {
            let speed = SPEED_RATIO * joint.velocity_limit.unwrap_or(f64::INFINITY);
            (2.0 * half_range(joint.position_limits)).min(speed * duration / QUINTIC_PEAK)
                / travel.abs()
        });
        let scale = slack.fold(1.0, f64::min);
        travel.iter_mut().for_each(|t| *t *= scale);
        // The start leaves room for the travel.
        let start = joints.iter().zip(&travel).map(|(joint, travel)| {
            let [low, high] = joint.position_limits;
            let room = half_range(joint.position_limits) - 0.5 * travel.abs();
            0.5 * (low + high) - 0.5 * travel + uniform(random, -room, room)
        });
        Self { start: start.collect(), travel, duration }
    }
}

/// Returns half the width of the range in which motions stay \[rad\].
fn half_range([low, high]: [f64; 2]) -> f64 {
    0.5 * POSITION_RATIO * (high - low)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::random::SeedableRng;

    proptest! {
        #[test]
        fn motions_keep_the_limits(seed: u64, duration in 0.5..20.0f64) {
            let robot = Robot::lwa4p();
            let motion = Motion::random(&robot, duration, &mut SplitMix64::seed_from_u64(seed));
            let mut peak = 0.0f64;
            for k in 0..=200 {
                let plan = motion.at(duration * f64::from(k) / 200.0);
                for (i, joint) in robot.joints().iter().enumerate() {
                    let [low, high] = joint.position_limits;
                    prop_assert!(low < plan.q[i] && plan.q[i] < high);
                    prop_assert!(plan.qd[i].abs() <= 0.9 * 1.2);
                    peak = peak.max(plan.qd[i].abs());
                }
            }
            prop_assert!(duration > 4.0 || (0.5..=1.0).contains(&peak), "{peak}");
        }
    }
}
