//! Point-to-point motions with rests between them: slow motions of one joint, and static
//! poses that are approached from both sides.

use reachtube_robot::Robot;

use crate::motion::{Motion, Planned, QUINTIC_PEAK, SAMPLE_TIME};
use crate::random::{SplitMix64, sign, uniform};

/// Peak speeds of the motions of one joint, each forth and back \[rad/s\]: from near standstill to
/// nearly as fast as the paper's robot may move.
const PEAKS: [f64; 3] = [0.2, 0.5, 1.0];

/// Distance between the two ends of a motion of one joint, over which the load changes \[rad\].
const TRAVEL: f64 = 1.6;

/// Peak speed of the fastest joint on the way to another pose \[rad/s\].
const PEAK: f64 = 1.0;

/// Distance from which each joint approaches a pose \[rad\].
const APPROACH: f64 = 0.1;

/// Peak speed of the approach \[rad/s\].
const APPROACH_PEAK: f64 = 0.2;

/// Rest at each pose \[s\]: half a second counts as a pose, and the low-pass blurs its ends.
const REST: f64 = 1.0;

/// Rest at the last pose \[s\]: the low-pass cuts the end of a recording.
const LAST_REST: f64 = 2.0;

/// Motions one after another, each with the cycles of rest after it.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct MotionSeries(Vec<(Motion, usize)>);

impl MotionSeries {
    /// Draws motions of one joint, back and forth with the others at rest, about a random pose,
    /// which gives the joint a random load.
    pub(super) fn of_joint(robot: &Robot, joint: usize, random: &mut SplitMix64) -> Self {
        let mut start = Motion::random_pose(robot, random);
        let [low, high] = robot.joints()[joint].position_limits;
        let travel = TRAVEL.min(0.5 * (high - low));
        let room = (0.5 * (high - low) - 0.5 * travel) * 0.8;
        start[joint] = 0.5 * (low + high - travel) + uniform(random, -room, room);
        let limit = robot.joints()[joint].velocity_limit.unwrap_or(f64::INFINITY);
        let mut motions = Vec::new();
        for peak in PEAKS {
            let duration = travel * QUINTIC_PEAK / peak.min(0.9 * limit);
            let duration = cycles(duration).max(1) as f64 * SAMPLE_TIME;
            for way in [travel, -travel] {
                let motion = Motion::along(start.clone(), joint, way, duration);
                start = motion.at(duration).q;
                motions.push((motion, 0));
            }
        }
        // The last sample is at the end of the last motion.
        motions.last_mut().expect("there are six").1 = 1;
        Self(motions)
    }

    /// Draws the positions of `count` rests, at least 1, and the position at which the series
    /// starts. The arm rests twice at each position.
    ///
    /// A joint at rest keeps some of its friction, which has the sign of its last motion. At the
    /// second rest each joint comes from the other side, so that the mean of both shows less of it.
    /// The sides are random for each joint: otherwise friction would look like a torque of all
    /// joints.
    pub(super) fn of_poses(robot: &Robot, count: usize, random: &mut SplitMix64) -> Self {
        let mut start = Motion::random_pose(robot, random);
        let mut motions = Vec::new();
        let mut go = |end: Vec<f64>, peak: f64, rest: f64| {
            let from = std::mem::replace(&mut start, end.clone());
            motions.push((Motion::between(robot, from, &end, peak), cycles(rest)));
        };
        for first in (0..count).step_by(2) {
            let pose = Motion::random_pose(robot, random);
            let sides: Vec<f64> = pose.iter().map(|_| APPROACH * sign(random)).collect();
            for (rest, side) in [1.0, -1.0].into_iter().enumerate().take(count - first) {
                let beside = pose.iter().zip(&sides).map(|(q, beside)| q + side * beside);
                go(beside.collect(), PEAK, 0.0);
                let last = first + rest + 1 == count;
                go(pose.clone(), APPROACH_PEAK, if last { LAST_REST } else { REST });
            }
        }
        Self(motions)
    }

    /// Positions at the start \[rad\], n.
    pub(super) fn start(&self) -> &[f64] {
        &self.0[0].0.start
    }

    pub(super) fn cycles(&self) -> usize {
        self.0.iter().map(|(motion, rest)| motion.cycles() + rest).sum()
    }

    pub(super) fn at(&self, mut k: usize) -> Planned {
        for (motion, rest) in &self.0 {
            if k < motion.cycles() + rest {
                return motion.at(k as f64 * SAMPLE_TIME);
            }
            k -= motion.cycles() + rest;
        }
        self.0[self.0.len() - 1].0.at(f64::MAX)
    }
}

fn cycles(time: f64) -> usize {
    (time / SAMPLE_TIME).round() as usize
}
