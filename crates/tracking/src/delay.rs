//! One delay of the command for the whole arm.

use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

use crate::basis::{delayed, rates};
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
    let late: Vec<Vec<f64>> =
        recordings.iter().map(|of| delayed(&of.times, &of.command, delay)).collect();
    let n = recordings[0].joint_count();
    let of_joint = |joint: usize| {
        let (mut normal, mut right) = (DMatrix::<f64>::zeros(3, 3), DVector::<f64>::zeros(3));
        let (mut square, mut all) = (0.0, 0.0);
        for (of, late) in recordings.iter().zip(&late) {
            for k in (0..of.times.len()).step_by(stride) {
                let at = k * n + joint;
                let [speed, acceleration] = rates(k, &of.times, |k| late[k * n + joint]);
                let terms = DVector::from_row_slice(&[1.0, speed, acceleration]);
                let error = of.actual[at] - late[at];
                normal += &terms * terms.transpose();
                right += &terms * error;
                square += error * error;
                all += of.error(k, joint).powi(2);
            }
        }
        let factors = normal.svd(true, true).solve(&right, 1e-12).unwrap_or_default();
        match factors.len() {
            3 if all > 0.0 => (square - factors.dot(&right)).max(0.0) / all,
            _ => 0.0,
        }
    };
    (0..n).map(of_joint).sum()
}
