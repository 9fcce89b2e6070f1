//! Slow motions of one joint, back and forth, with the others at rest.

use reachtube_robot::Robot;

use crate::motion::{Motion, Planned, QUINTIC_PEAK, SAMPLE_TIME};
use crate::random::{SplitMix64, uniform};

/// Peak speeds of the motions, each forth and back \[rad/s\]: from near standstill to nearly as
/// fast as the paper's robot may move.
const PEAKS: [f64; 3] = [0.2, 0.5, 1.0];

/// Distance between the two ends, over which the load changes \[rad\].
const TRAVEL: f64 = 1.6;

/// Motions of one joint about a random pose, which gives the joint a random load.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct JointMotion {
    motions: Vec<Motion>,
}

impl JointMotion {
    pub(super) fn random(robot: &Robot, joint: usize, random: &mut SplitMix64) -> Self {
        let mut start = Motion::random_pose(robot, random);
        let [low, high] = robot.joints()[joint].position_limits;
        let travel = TRAVEL.min(0.5 * (high - low));
        let room = (0.5 * (high - low) - 0.5 * travel) * 0.8;
        start[joint] = 0.5 * (low + high - travel) + uniform(random, -room, room);
        let limit = robot.joints()[joint].velocity_limit.unwrap_or(f64::INFINITY);
        let mut motions = Vec::new();
        for peak in PEAKS {
            let duration = travel * QUINTIC_PEAK / peak.min(0.9 * limit);
            let duration = (duration / SAMPLE_TIME).round().max(1.0) * SAMPLE_TIME;
            for way in [travel, -travel] {
                let motion = Motion::along(start.clone(), joint, way, duration);
                start = motion.at(duration).q;
                motions.push(motion);
            }
        }
        Self { motions }
    }

    /// Returns the positions at the start \[rad\], n.
    pub(super) fn start(&self) -> &[f64] {
        &self.motions[0].start
    }

    pub(super) fn cycles(&self) -> usize {
        self.motions.iter().map(Motion::cycles).sum::<usize>() + 1
    }

    /// Returns the plan at cycle `k`.
    pub(super) fn at(&self, k: usize) -> Planned {
        let mut first = 0;
        let current = self.motions.iter().find(|motion| {
            let ends = k < first + motion.cycles();
            if !ends {
                first += motion.cycles();
            }
            ends
        });
        match current {
            Some(motion) => motion.at((k - first) as f64 * SAMPLE_TIME),
            None => self.motions[self.motions.len() - 1].at(f64::MAX),
        }
    }
}
