use crate::error::{Error, Result};
use reachtube_recordings::{Run, velocity_mismatch};
use std::path::Path;

/// Units that times may have by mistake, with the motion per integral of the velocity that they
/// cause.
const UNITS: [(&str, f64); 3] =
    [("milliseconds", 1e-3), ("microseconds", 1e-6), ("nanoseconds", 1e-9)];

/// Relative deviation from the value in `UNITS` up to which a unit is recognised.
const TOLERANCE: f64 = 0.3;

/// Checks that the times of a recording are in seconds.
///
/// Times in another unit scale the integrals of all velocities by the same factor.
///
/// # Errors
///
/// [`Error::TimeUnit`] if most joints whose velocity contradicts their position do so by the factor
/// of one unit.
pub(super) fn check_time_unit(file: &Path, run: &Run) -> Result<()> {
    let slopes: Vec<f64> = velocity_mismatch(run).into_iter().map(|(_, slope)| slope).collect();
    for (unit, expected) in UNITS {
        let agreeing = slopes.iter().filter(|slope| (*slope / expected - 1.0).abs() < TOLERANCE);
        if let (Some(&slope), true) = (agreeing.clone().next(), 2 * agreeing.count() > slopes.len())
        {
            return Err(Error::TimeUnit { file: file.to_path_buf(), slope, unit });
        }
    }
    Ok(())
}
