//! A (1+1) evolution strategy.

use crate::states::Random;

/// Factor on the step after a success; Rechenberg's rule balances it at one success in five.
const GROWTH: f64 = 1.5;

/// Result of one search.
pub(super) struct Climb {
    pub start: u64,
    pub origin: Vec<f64>,
    pub point: Vec<f64>,
    pub value: f64,
}

/// The random numbers of search k.
pub(super) fn start(seed: u64, k: usize) -> (u64, Random) {
    let start = seed.wrapping_mul(0x5851_f42d_4c95_7f2d).wrapping_add(k as u64);
    (k as u64, Random::new(start))
}

/// Climbs from a random point: normal steps, in some of the directions each time, kept where the
/// value does not fall.
pub(super) fn climb(
    dimensions: usize,
    trials: usize,
    (start, random): &mut (u64, Random),
    value: &mut impl FnMut(&[f64]) -> f64,
) -> Climb {
    let origin: Vec<_> = (0..dimensions).map(|_| random.normal()).collect();
    let (mut point, mut best, mut step) = (origin.clone(), value(&origin), 0.5);
    let mut trial = origin.clone();
    for _ in 0..trials {
        // Few directions make steps that often succeed, many make steps that lead far.
        let share = random.between(0.0, 1.0).powi(2);
        let sure = random.between(0.0, dimensions as f64) as usize;
        for (k, (t, p)) in trial.iter_mut().zip(&point).enumerate() {
            let moves = k == sure || random.between(0.0, 1.0) < share;
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
    Climb { start: *start, origin, point, value: best }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_climbs_a_slanted_hill() {
        let mut hill = |x: &[f64]| -(x[0] - 1.0).powi(2) - 10.0 * (x[1] + x[0]).powi(2);
        let top = climb(2, 2000, &mut start(7, 0), &mut hill);
        assert!(top.value > -1e-3 && (top.point[0] - 1.0).abs() < 0.05, "{:?}", top.point);
    }
}
