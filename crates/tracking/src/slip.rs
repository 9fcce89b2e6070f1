//! Clocks of command and actual position that slip against each other.

use nalgebra::{DMatrix, DVector};
use reachtube_finding::{Finding, Severity};
use reachtube_scalar::number::significant;

use crate::code::Code;
use crate::recording::TrackedRun;

/// Samples of this time share a slip, s.
const WINDOW: f64 = 0.3;

/// Windows count in which the mean squared speed is at least this part of the largest.
const FAST: f64 = 0.1;

/// Slips are named if errors are this many times smaller without them.
const SMALLER: f64 = 2.0;

/// Returns the finding that the clocks of a recording slip, if one slip for all joints in each
/// short window explains most of what an offset, a lag and the acceleration leave.
pub(crate) fn slips(recording: &TrackedRun) -> Option<Finding> {
    let joints: Vec<Vec<[f64; 2]>> =
        (0..recording.joint_count()).map(|joint| rests(recording, joint)).collect();
    // For each window: Σ rest · speed, Σ speed², Σ rest² over its samples and joints.
    let mut windows: Vec<[f64; 3]> = Vec::new();
    let mut end = f64::NEG_INFINITY;
    for (k, time) in recording.times.iter().enumerate() {
        if *time >= end {
            windows.push([0.0; 3]);
            end = time + WINDOW;
        }
        let sums = windows.last_mut().expect("a window was begun");
        for [rest, speed] in joints.iter().map(|rows| rows[k]) {
            sums[0] += rest * speed;
            sums[1] += speed * speed;
            sums[2] += rest * rest;
        }
    }
    let fastest = windows.iter().map(|sums| sums[1]).fold(0.0, f64::max);
    windows.retain(|sums| sums[1] > FAST * fastest);
    let with: f64 = windows.iter().map(|[_, _, rest]| rest).sum();
    let without: f64 = windows.iter().map(|[both, speed, rest]| rest - both * both / speed).sum();
    let slip = windows.iter().map(|[both, speed, _]| (both / speed).abs()).fold(0.0, f64::max);
    // One joint alone cannot tell a slip from an error of its own.
    let is_known = windows.len() > 2 && recording.joint_count() > 1;
    (is_known && with > SMALLER * SMALLER * without).then(|| {
        let text = format!(
            "{}: the clocks of command and actual position slip by up to {} ms: with one shift of \
             the time for all joints, errors are {} times smaller; log both by one clock, or leave \
             the log out.",
            recording.file.display(),
            significant(1e3 * slip, 2),
            significant((with / without).sqrt(), 2),
        );
        let place = recording.name();
        Finding::new(Severity::Failure, Code::ClockSlips, text).at(place).with("slip", slip)
    })
}

/// Returns, for each sample of a joint, what the offset, the lag and the factor of the acceleration
/// with the least squares leave of its error, and the commanded speed.
fn rests(recording: &TrackedRun, joint: usize) -> Vec<[f64; 2]> {
    let samples = recording.times.len();
    let rates = (0..samples).map(|k| recording.rates::<f64>(k, joint));
    let rates: Vec<[f64; 2]> = rates.collect();
    let terms = |k: usize| [1.0, rates[k][0], rates[k][1]];
    let matrix = DMatrix::from_fn(samples, 3, |k, term| terms(k)[term]);
    let errors = DVector::from_fn(samples, |k, _| recording.error(k, joint));
    let factors =
        matrix.clone().svd(true, true).solve(&errors, 1e-9).unwrap_or_else(|_| DVector::zeros(3));
    let rest = errors - matrix * factors;
    rest.iter().zip(&rates).map(|(rest, [speed, _])| [*rest, *speed]).collect()
}
