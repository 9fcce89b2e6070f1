//! Reproducible random numbers, and random states of a robot.

use crate::robot::Robot;
use core::f64::consts::TAU;
use rand_xoshiro::SplitMix64;
use rand_xoshiro::rand_core::{Rng, SeedableRng};

/// Random numbers from SplitMix64 (Steele, Lea & Flood 2014), the same on every machine for one
/// seed.
#[derive(Clone, Debug)]
pub(crate) struct Random(SplitMix64);

impl Random {
    pub(crate) fn new(seed: u64) -> Self {
        Self(SplitMix64::seed_from_u64(seed))
    }

    /// Returns a uniformly distributed number in [low, high).
    pub(crate) fn uniform(&mut self, low: f64, high: f64) -> f64 {
        let unit = (self.0.next_u64() >> 11) as f64 / (1u64 << 53) as f64;
        low + (high - low) * unit
    }

    /// Returns a standard normal number (Box & Muller).
    pub(crate) fn normal(&mut self) -> f64 {
        let (u, v) = (1.0 - self.uniform(0.0, 1.0), self.uniform(0.0, TAU));
        (-2.0 * u.ln()).sqrt() * v.cos()
    }
}

/// Returns random states (q, q̇, q̈) within the position and velocity limits.
///
/// Joints without a velocity limit move at up to 2 rad/s; accelerations are up to 5 rad/s².
pub(crate) fn random_states(
    robot: &Robot,
    count: usize,
    random: &mut Random,
) -> Vec<[Vec<f64>; 3]> {
    let state = |_| {
        let q = robot
            .joints()
            .iter()
            .map(|j| random.uniform(j.position_limits[0], j.position_limits[1]))
            .collect();
        let mut within = |bound: f64| random.uniform(-bound, bound);
        let qd = robot.joints().iter().map(|j| within(j.velocity_limit.unwrap_or(2.0))).collect();
        [q, qd, (0..robot.joint_count()).map(|_| within(5.0)).collect()]
    };
    (0..count).map(state).collect()
}

/// Returns random states at rest within the position limits.
pub(crate) fn random_rest_states(
    robot: &Robot,
    count: usize,
    random: &mut Random,
) -> Vec<[Vec<f64>; 3]> {
    let zeros = vec![0.0; robot.joint_count()];
    random_states(robot, count, random)
        .into_iter()
        .map(|[q, ..]| [q, zeros.clone(), zeros.clone()])
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The outputs of the reference implementation, splitmix64.c (Vigna 2015), for the seed
    /// 1234567.
    #[test]
    fn numbers_are_those_of_splitmix64() {
        let expected = [6_457_827_717_110_365_317_u64, 3_203_168_211_198_807_973];
        let mut random = Random::new(1_234_567);
        for bits in expected {
            assert_eq!(random.uniform(0.0, 1.0), (bits >> 11) as f64 / (1u64 << 53) as f64);
        }
    }
}
