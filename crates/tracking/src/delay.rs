//! One delay of the command for the whole arm.

use nalgebra::{Matrix3, Vector3};
use rayon::prelude::*;

use crate::basis::{at_place, before, rates};
use crate::recording::TrackedRun;

/// Longest delay that is tried, s.
const LONGEST: f64 = 0.4;

/// Number of delays that each round tries on both sides of the best one, a tenth as far apart as
/// before.
const ROUND: i32 = 20;

/// Rounds after the first one.
const ROUNDS: usize = 2;

/// A delay is worth a second search for sets if it makes the squares of the errors less than this
/// part.
const WORTH: f64 = 0.8;

/// Largest number of rows by which delays are compared.
const ROWS: usize = 20_000;

/// Returns the delay after which an offset, a lag and the acceleration explain the most, by least
/// squares; 0 unless it explains much more than without a delay.
pub(crate) fn best(recordings: &[&TrackedRun]) -> f64 {
    let rows: usize = recordings.iter().map(|of| of.times.len()).sum();
    let stride = rows.div_ceil(ROWS);
    let try_all = |delays: Vec<f64>| -> (f64, f64) {
        let tried = delays.into_par_iter().filter(|delay| (0.0..=LONGEST).contains(delay));
        let tried = tried.map(|delay| (left(recordings, delay, stride), delay));
        tried.reduce(|| (f64::INFINITY, 0.0), |a, b| if b < a { b } else { a })
    };
    let mut step = LONGEST / f64::from(2 * ROUND);
    let mut best = try_all((0..=2 * ROUND).map(|k| step * f64::from(k)).collect());
    for _ in 0..ROUNDS {
        step /= 10.0;
        best = try_all((-ROUND..=ROUND).map(|k| best.1 + step * f64::from(k)).collect());
    }
    if best.0 < WORTH * left(recordings, 0.0, stride) { best.1 } else { 0.0 }
}

/// Returns the part of the squares of the errors that is left, as the sum over the joints.
fn left(recordings: &[&TrackedRun], delay: f64, stride: usize) -> f64 {
    let n = recordings[0].joint_count();
    let mut sums = vec![LagSums::default(); n];
    for of in recordings {
        let (times, last) = (&of.times, of.times.len() - 1);
        for k in (0..=last).step_by(stride) {
            // The rates need the command at three samples.
            let middle = k.clamp(1, last - 1);
            let places = [middle - 1, middle, middle + 1].map(|k| before(times, delay, k));
            for (joint, sums) in sums.iter_mut().enumerate() {
                let late = |k: usize| at_place(&of.command, n, places[k + 1 - middle], joint);
                let [speed, acceleration] = rates(k, times, late);
                let error = of.actual[k * n + joint] - late(k);
                sums.add([1.0, speed, acceleration].into(), error, of.error(k, joint));
            }
        }
    }
    sums.iter().map(LagSums::left).sum()
}

/// Sums of the least squares of a joint.
#[derive(Debug, Clone, Default)]
struct LagSums {
    normal: Matrix3<f64>,
    right: Vector3<f64>,
    square: f64,
    /// The squares without a delay and without a fit.
    all: f64,
}

impl LagSums {
    fn add(&mut self, terms: Vector3<f64>, error: f64, plain: f64) {
        self.normal += terms * terms.transpose();
        self.right += terms * error;
        self.square += error * error;
        self.all += plain * plain;
    }

    /// Returns the part of the squares that the best factors leave.
    fn left(&self) -> f64 {
        match self.normal.svd(true, true).solve(&self.right, 1e-12) {
            Ok(factors) if self.all > 0.0 => {
                (self.square - factors.dot(&self.right)).max(0.0) / self.all
            }
            _ => 0.0,
        }
    }
}
