//! The noise of the sensors, as it is left in prepared recordings.

use reachtube_identify::prepare::{RawLog, noise_left};

use crate::rounding::rounded_up;

/// Standard deviations within which noise is taken to lie.
const DEVIATIONS: f64 = 5.0;

/// Returns the radii of the sensors' noise, 2n, rad and rad/s, rounded to two digits; after a
/// low-pass of `cut_off` \[Hz\] of what is left of it.
pub(crate) fn noise(logs: &[&RawLog], cut_off: Option<f64>) -> Vec<f64> {
    let states = logs.first().map_or(0, |log| log.run.dimension());
    let left = noise_left(logs, cut_off).unwrap_or_else(|| vec![0.0; states]);
    left.into_iter().map(|deviation| rounded_up(DEVIATIONS * deviation, 2)).collect()
}
