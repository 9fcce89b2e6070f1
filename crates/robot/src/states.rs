//! Reproducible random states of a robot.

use crate::Robot;

/// SplitMix64 (Steele, Lea & Flood 2014): enough for sampling, and the same everywhere.
#[derive(Clone, Debug)]
pub(crate) struct Random(u64);

impl Random {
    pub fn new(seed: u64) -> Self {
        Self(seed)
    }

    /// A number in [low, high).
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        let unit = ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64;
        low + (high - low) * unit
    }

    /// A standard normal number (Box & Muller).
    pub fn normal(&mut self) -> f64 {
        let (u, v) = (1.0 - self.between(0.0, 1.0), self.between(0.0, core::f64::consts::TAU));
        (-2.0 * u.ln()).sqrt() * v.cos()
    }
}

/// States (q, q̇, q̈) within the limits of position and speed; 2 rad/s where none is known,
/// accelerations to 5 rad/s².
pub(crate) fn states(robot: &Robot, count: usize, random: &mut Random) -> Vec<[Vec<f64>; 3]> {
    let state = |_| {
        let q = robot
            .joints()
            .iter()
            .map(|j| random.between(j.position_limits[0], j.position_limits[1]))
            .collect();
        let mut within = |bound: f64| random.between(-bound, bound);
        let qd = robot.joints().iter().map(|j| within(j.velocity_limit.unwrap_or(2.0))).collect();
        [q, qd, (0..robot.joint_count()).map(|_| within(5.0)).collect()]
    };
    (0..count).map(state).collect()
}

/// States at rest.
pub(crate) fn rest(robot: &Robot, count: usize, random: &mut Random) -> Vec<[Vec<f64>; 3]> {
    let still = vec![0.0; robot.joint_count()];
    states(robot, count, random)
        .into_iter()
        .map(|[q, ..]| [q, still.clone(), still.clone()])
        .collect()
}
