//! Deterministic random numbers, so that a failure repeats.

use rand_xoshiro::SplitMix64;
use rand_xoshiro::rand_core::{Rng, SeedableRng};

pub(crate) struct Random(SplitMix64);

impl Random {
    pub(crate) fn new(seed: u64) -> Self {
        Self(SplitMix64::seed_from_u64(seed))
    }

    pub(crate) fn bits(&mut self) -> u64 {
        self.0.next_u64()
    }

    /// Returns a number from the uniform distribution in [-1, 1).
    pub(crate) fn symmetric(&mut self) -> f64 {
        (self.bits() as i64) as f64 / 9_223_372_036_854_775_808.0
    }

    /// Returns -1 or 1 with equal probability.
    pub(crate) fn sign(&mut self) -> f64 {
        if self.bits() >> 63 == 0 { 1.0 } else { -1.0 }
    }
}
