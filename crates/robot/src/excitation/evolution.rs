//! A (1+1) evolution strategy.

use crate::random_states::Random;

/// Growth factor of the step after a success. By Rechenberg's rule, the step stays constant at one
/// success in five trials.
const GROWTH: f64 = 1.5;

/// The result of one search.
pub(super) struct EvolutionResult {
    /// Number of the search.
    pub search: u64,
    /// Random point at which the search started.
    pub origin: Vec<f64>,
    /// Best point.
    pub point: Vec<f64>,
    /// Value at the best point.
    pub value: f64,
}

pub(super) fn search_start(seed: u64, k: usize) -> (u64, Random) {
    let seed = seed.wrapping_mul(0x5851_f42d_4c95_7f2d).wrapping_add(k as u64);
    (k as u64, Random::new(seed))
}

/// Maximises `value` from a random point. Each trial is a normal step in a random subset of the
/// directions, and is kept if the value does not decrease.
pub(super) fn maximise(
    dimensions: usize,
    trials: usize,
    (search, random): &mut (u64, Random),
    value: &mut impl FnMut(&[f64]) -> f64,
) -> EvolutionResult {
    let origin: Vec<_> = (0..dimensions).map(|_| random.normal()).collect();
    let (mut point, mut best, mut step) = (origin.clone(), value(&origin), 0.5);
    let mut trial = origin.clone();
    for _ in 0..trials {
        // Steps in few directions succeed often; steps in many directions go far.
        let share = random.uniform(0.0, 1.0).powi(2);
        let chosen = random.uniform(0.0, dimensions as f64) as usize;
        for (k, (t, p)) in trial.iter_mut().zip(&point).enumerate() {
            let moves = k == chosen || random.uniform(0.0, 1.0) < share;
            *t = if moves { p + step * random.normal() } else { *p };
        }
        let found = value(&trial);
        if found >= best {
            (best, step) = (found, (step * GROWTH).min(2.0));
            point.copy_from_slice(&trial);
        } else {
            step = (step * GROWTH.powf(-0.25)).max(1e-3);
        }
    }
    EvolutionResult { search: *search, origin, point, value: best }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_maximum_of_a_slanted_hill_is_found() {
        let mut hill = |x: &[f64]| -(x[0] - 1.0).powi(2) - 10.0 * (x[1] + x[0]).powi(2);
        let top = maximise(2, 2000, &mut search_start(7, 0), &mut hill);
        assert!(top.value > -1e-3 && (top.point[0] - 1.0).abs() < 0.05, "{:?}", top.point);
    }
}
