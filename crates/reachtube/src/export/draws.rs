//! Random states at which exported files are checked.

use rand::RngExt;
use rand_xoshiro::SplitMix64;
use rand_xoshiro::rand_core::SeedableRng;

/// A source of pseudo-random vectors that depends on its seed alone, on every platform.
pub(super) struct Draws(SplitMix64);

impl Draws {
    pub(super) fn seeded(seed: u64) -> Self {
        Self(SplitMix64::seed_from_u64(seed))
    }

    /// Draws `count` numbers uniformly from \[-radius, radius).
    pub(super) fn vector(&mut self, count: usize, radius: f64) -> Vec<f64> {
        (0..count).map(|_| -radius + (radius + radius) * self.0.random::<f64>()).collect()
    }
}
