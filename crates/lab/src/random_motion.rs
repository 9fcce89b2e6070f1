//! Random motions within a robot's limits.

use reachtube_robot::{Joint, Robot};

use crate::motion::{Motion, QUINTIC_PEAK, SAMPLE_TIME};
use crate::random::{SplitMix64, sign, uniform};

/// Least and largest peak speed of the fastest joint of a motion \[rad/s\].
const PEAK_SPEED: [f64; 2] = [0.5, 1.0];

/// Largest planned speed of a joint over its limit \[-\]: the open loop may be faster than planned.
const SPEED_RATIO: f64 = 0.9;

/// Middle part of each joint's position range in which motions stay \[-\].
const POSITION_RATIO: f64 = 0.4;

/// Least travel of a joint over the fastest joint's \[-\].
const TRAVEL_RATIO: f64 = 0.1;

/// Parts of a motion at which the first suite starts and before which the last one starts \[-\].
const STARTS: [f64; 2] = [0.1, 0.9];

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
            (2.0 * Self::half_range(joint.position_limits)).min(speed * duration / QUINTIC_PEAK)
                / travel.abs()
        });
        let scale = slack.fold(1.0, f64::min);
        travel.iter_mut().for_each(|t| *t *= scale);
        // The start leaves room for the travel.
        let start = joints.iter().zip(&travel).map(|(joint, travel)| {
            let [low, high] = joint.position_limits;
            let room = Self::half_range(joint.position_limits) - 0.5 * travel.abs();
            0.5 * (low + high) - 0.5 * travel + uniform(random, -room, room)
        });
        Self { start: start.collect(), travel, duration }
    }

    /// Draws a motion between two poses that are uniform in the robot's range. Its duration follows
    /// from a random peak speed of the joint that travels furthest.
    pub(crate) fn uniform(robot: &Robot, random: &mut SplitMix64) -> Self {
        let [start, end] = [0, 1].map(|_| Self::random_pose(robot, random));
        let peak = uniform(random, PEAK_SPEED[0], PEAK_SPEED[1]);
        Self::between(robot, start, &end, peak)
    }

    /// Draws a pose in the middle part of the robot's range \[rad\], n.
    pub(crate) fn random_pose(robot: &Robot, random: &mut SplitMix64) -> Vec<f64> {
        let position = |joint: &Joint| {
            let [low, high] = joint.position_limits;
            let half = Self::half_range([low, high]);
            0.5 * (low + high) + uniform(random, -half, half)
        };
        robot.joints().iter().map(position).collect()
    }

    /// Returns a motion between two poses \[rad\] in which the fastest joint peaks at `peak`
    /// \[rad/s\], or slower if a limit requires it. It lasts whole cycles, at least one.
    pub(crate) fn between(robot: &Robot, start: Vec<f64>, end: &[f64], peak: f64) -> Self {
        let travel: Vec<f64> = end.iter().zip(&start).map(|(end, start)| end - start).collect();
        let time = |(joint, travel): (&Joint, &f64)| {
            let limit = SPEED_RATIO * joint.velocity_limit.unwrap_or(f64::INFINITY);
            QUINTIC_PEAK * travel.abs() / peak.min(limit)
        };
        let duration = robot.joints().iter().zip(&travel).map(time).fold(0.0, f64::max);
        let cycles = (duration / SAMPLE_TIME).ceil().max(1.0);
        Self { start, travel, duration: cycles * SAMPLE_TIME }
    }

    /// Returns the cycle at which the open loop begins in suite `index` (from 0) of `count` suites
    /// of this motion, at least 1.
    pub(crate) fn start_cycle(&self, index: usize, count: usize) -> usize {
        let part = STARTS[0] + (STARTS[1] - STARTS[0]) * index as f64 / count as f64;
        ((part * self.cycles() as f64).round() as usize).max(1)
    }

    /// Returns half the width of the range in which motions stay \[rad\].
    pub(crate) fn half_range([low, high]: [f64; 2]) -> f64 {
        0.5 * POSITION_RATIO * (high - low)
    }
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

        #[test]
        fn uniform_motions_last_whole_cycles_and_peak_as_drawn(seed: u64) {
            let robot = Robot::lwa4p();
            let motion = Motion::uniform(&robot, &mut SplitMix64::seed_from_u64(seed));
            prop_assert_eq!(motion.cycles() as f64 * SAMPLE_TIME, motion.duration);
            let middle = motion.at(0.5 * motion.duration);
            let peak = middle.qd.iter().fold(0.0f64, |peak, qd| peak.max(qd.abs()));
            prop_assert!((0.49..=1.0).contains(&peak), "{peak} rad/s");
            for (start, travel) in motion.start.iter().zip(&motion.travel) {
                let half = 0.4 * std::f64::consts::PI + 1e-12;
                prop_assert!(start.abs() <= half && (start + travel).abs() <= half);
            }
            let starts: Vec<usize> = (0..4).map(|index| motion.start_cycle(index, 4)).collect();
            prop_assert!(starts[0] >= 1 && starts.is_sorted());
            prop_assert!(starts[3] < motion.cycles());
        }
    }
}
