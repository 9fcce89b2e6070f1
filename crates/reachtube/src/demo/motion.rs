//! Motions of the demo.

use reachtube_robot::Robot;

use crate::motion::{Motion, QUINTIC_PEAK};
use crate::random::{SplitMix64, sign, uniform};

/// Peak speed of the fastest joint of a motion, rad/s: from, to.
const PEAK_SPEED: [f64; 2] = [0.5, 1.0];

/// Speed that no joint exceeds, over its limit: the open loop may be faster than planned.
const SPEED_SHARE: f64 = 0.9;

/// The middle part of each joint's position range that motions stay in.
const POSITION_SHARE: f64 = 0.4;

/// The slowest joint's travel over the fastest joint's, at least.
const LEAST_TRAVEL: f64 = 0.1;

impl Motion {
    /// A motion within the robot's position and speed limits.
    pub(crate) fn random(robot: &Robot, duration: f64, random: &mut SplitMix64) -> Self {
        let joints = robot.joints();
        let share: Vec<f64> =
            joints.iter().map(|_| sign(random) * uniform(random, LEAST_TRAVEL, 1.0)).collect();
        let fastest = share.iter().fold(0.0, |most: f64, s| most.max(s.abs()));
        let peak = uniform(random, PEAK_SPEED[0], PEAK_SPEED[1]);
        let mut travel: Vec<f64> =
            share.iter().map(|s| s / fastest * peak * duration / QUINTIC_PEAK).collect();
        let slack = joints.iter().zip(&travel).map(|(joint, travel)| {
            let speed = SPEED_SHARE * joint.velocity_limit.unwrap_or(f64::INFINITY);
            (2.0 * half_range(joint.position_limits)).min(speed * duration / QUINTIC_PEAK)
                / travel.abs()
        });
        let scale = slack.fold(1.0, f64::min);
        travel.iter_mut().for_each(|t| *t *= scale);
        let start = joints.iter().zip(&travel).map(|(joint, travel)| {
            let [low, high] = joint.position_limits;
            let room = half_range(joint.position_limits) - 0.5 * travel.abs();
            0.5 * (low + high) - 0.5 * travel + uniform(random, -room, room)
        });
        Self { start: start.collect(), travel, duration }
    }
}

fn half_range([low, high]: [f64; 2]) -> f64 {
    0.5 * POSITION_SHARE * (high - low)
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
