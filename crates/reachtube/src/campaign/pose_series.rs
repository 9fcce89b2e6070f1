//! Series of static poses.

use reachtube_robot::Robot;

use crate::motion::{Motion, Planned, SAMPLE_TIME};
use crate::random::SplitMix64;

/// Peak speed of the fastest joint between two poses \[rad/s\].
const PEAK: f64 = 1.0;

/// Rest at each pose \[s\]: half a second counts as a pose, and the low-pass blurs its ends.
const REST: f64 = 1.0;

/// Rest at the last pose \[s\]: the low-pass cuts the end of a recording.
const LAST_REST: f64 = 2.0;

/// Random poses that the arm moves to, one after another.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct PoseSeries {
    motions: Vec<Motion>,
}

impl PoseSeries {
    /// Draws `count` poses, at least 1, and the pose at which the series starts.
    pub fn random(robot: &Robot, count: usize, random: &mut SplitMix64) -> Self {
        let mut start = Motion::random_pose(robot, random);
        let motion = |_| {
            let end = Motion::random_pose(robot, random);
            Motion::between(robot, std::mem::replace(&mut start, end.clone()), &end, PEAK)
        };
        Self { motions: (0..count).map(motion).collect() }
    }

    /// Returns the positions at the start \[rad\], n.
    pub fn start(&self) -> &[f64] {
        &self.motions[0].start
    }

    /// Returns the number of cycles.
    pub fn cycles(&self) -> usize {
        let last = cycles(LAST_REST) - cycles(REST);
        self.motions.iter().map(|motion| motion.cycles() + cycles(REST)).sum::<usize>() + last
    }

    /// Returns the plan at cycle `k`.
    pub fn at(&self, mut k: usize) -> Planned {
        for motion in &self.motions {
            let whole = motion.cycles() + cycles(REST);
            if k < whole {
                return motion.at(k as f64 * SAMPLE_TIME);
            }
            k -= whole;
        }
        self.motions[self.motions.len() - 1].at(f64::MAX)
    }
}

/// Returns the number of cycles in a time \[s\].
fn cycles(time: f64) -> usize {
    (time / SAMPLE_TIME).round() as usize
}
