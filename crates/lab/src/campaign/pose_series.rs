//! Series of static poses, each approached from both sides.

use reachtube_robot::Robot;

use crate::motion::{Motion, Planned, SAMPLE_TIME};
use crate::random::{SplitMix64, sign};

/// Peak speed of the fastest joint on the way to another position \[rad/s\].
const PEAK: f64 = 1.0;

/// Distance from which each joint approaches a position \[rad\].
const APPROACH: f64 = 0.1;

/// Peak speed of the approach \[rad/s\].
const APPROACH_PEAK: f64 = 0.2;

/// Rest at each pose \[s\]: half a second counts as a pose, and the low-pass blurs its ends.
const REST: f64 = 1.0;

/// Rest at the last pose \[s\]: the low-pass cuts the end of a recording.
const LAST_REST: f64 = 2.0;

/// Random positions at which the arm rests twice, one after another.
///
/// A joint at rest keeps some of its friction, which has the sign of its last motion. At the second
/// rest each joint comes from the other side, so that the mean of both shows less of it. The sides
/// are random for each joint: otherwise friction would look like a torque of all joints.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct PoseSeries {
    legs: Vec<Leg>,
}

/// A motion and the rest after it.
#[derive(Debug, Clone, PartialEq)]
struct Leg {
    motion: Motion,
    /// Cycles of rest.
    rest: usize,
}

impl PoseSeries {
    /// Draws the positions of `count` rests, at least 1, and the position at which the series
    /// starts.
    pub(super) fn random(robot: &Robot, count: usize, random: &mut SplitMix64) -> Self {
        let mut start = Motion::random_pose(robot, random);
        let mut legs: Vec<Leg> = Vec::new();
        let mut go = |end: Vec<f64>, peak: f64, rest: f64| {
            let motion =
                Motion::between(robot, std::mem::replace(&mut start, end.clone()), &end, peak);
            legs.push(Leg { motion, rest: cycles(rest) });
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
        Self { legs }
    }

    /// Returns the positions at the start \[rad\], n.
    pub(super) fn start(&self) -> &[f64] {
        &self.legs[0].motion.start
    }

    pub(super) fn cycles(&self) -> usize {
        self.legs.iter().map(Leg::cycles).sum()
    }

    /// Returns the plan at cycle `k`.
    pub(super) fn at(&self, mut k: usize) -> Planned {
        for leg in &self.legs {
            if k < leg.cycles() {
                return leg.motion.at(k as f64 * SAMPLE_TIME);
            }
            k -= leg.cycles();
        }
        self.legs[self.legs.len() - 1].motion.at(f64::MAX)
    }
}

impl Leg {
    fn cycles(&self) -> usize {
        self.motion.cycles() + self.rest
    }
}

/// Returns the number of cycles in a time \[s\].
fn cycles(time: f64) -> usize {
    (time / SAMPLE_TIME).round() as usize
}
