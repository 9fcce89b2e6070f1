//! A summary of a recording without keeping its samples.

use crate::error::{Error, Result};
use crate::prepare::raw_log::RawLog;
use crate::prepare::resample::{median_step, resampled};
use crate::prepare::spectrum::motion_bandwidth;
use crate::prepare::turns::{Extent, extents};
use reachtube_recordings::{Run, integral_gap};
use std::path::PathBuf;

/// Facts about a recording that decide how all recordings are prepared.
#[derive(Debug, Clone)]
pub(crate) struct Survey {
    /// Name of the file.
    pub name: String,
    /// The file.
    pub file: PathBuf,
    /// Hash of the file's content.
    pub sha256: String,
    /// Times of the first and the last sample \[s\]; `None` without samples.
    pub ends: Option<[f64; 2]>,
    /// Median time between samples \[s\]; `None` for fewer than two samples.
    pub step: Option<f64>,
    /// Number of samples.
    pub samples: usize,
    /// Numbers in a sample.
    pub width: usize,
    /// Bandwidth \[Hz\] and weight of each joint's motion.
    pub bandwidths: Vec<(f64, f64)>,
    /// Difference of each joint's position and the integral of its velocity, and the range of its
    /// position \[rad\].
    pub gaps: Vec<[f64; 2]>,
    /// First, lowest and highest position of each joint \[rad\].
    pub extents: Vec<Extent>,
    /// Notes about its reading.
    pub notes: Vec<String>,
}

impl Survey {
    pub(crate) fn of(log: &RawLog) -> Self {
        let run = &log.run;
        let ends = run.times.first().zip(run.times.last()).map(|(first, last)| [*first, *last]);
        let gap = |joint: usize| [integral_gap(run, joint), range(run, joint)];
        Self {
            name: log.name.clone(),
            file: log.file.clone(),
            sha256: run.sha256.clone(),
            ends,
            step: median_step(&run.times),
            samples: run.len(),
            width: 4 * run.joints + if run.temperatures.is_empty() { 0 } else { run.joints },
            bandwidths: bandwidths(log),
            gaps: (0..run.joints).map(gap).collect(),
            extents: extents(run),
            notes: log.notes.clone(),
        }
    }

    /// Returns whether two recordings have the same content and share more than one sample of it.
    pub(crate) fn overlaps(&self, other: &Self) -> bool {
        let shared = |([a0, a1], [b0, b1]): ([f64; 2], [f64; 2])| a0.max(b0) < a1.min(b1);
        self.sha256 == other.sha256 && self.ends.zip(other.ends).is_some_and(shared)
    }
}

/// Checks that no validation recording shares times with a recording of the fits that has the same
/// content.
///
/// # Errors
///
/// [`Error::NotHeldOut`] names the first such pair.
pub(crate) fn check_held_out(validate: &[Survey], fitted: &[&Survey]) -> Result<()> {
    for log in validate {
        if let Some(fitted) = fitted.iter().find(|other| log.overlaps(other)) {
            return Err(Error::NotHeldOut {
                validate: log.file.clone(),
                fitted: fitted.file.clone(),
            });
        }
    }
    Ok(())
}

fn range(run: &Run, joint: usize) -> f64 {
    let positions = (0..run.len()).map(|k| run.q(k)[joint]);
    positions.clone().fold(f64::MIN, f64::max) - positions.fold(f64::MAX, f64::min)
}

/// Returns the bandwidth \[Hz\] and the weight of each joint's motion in a log.
fn bandwidths(log: &RawLog) -> Vec<(f64, f64)> {
    let Some(step) = median_step(&log.run.times) else { return Vec::new() };
    let column = |which, joint| resampled(&log.run.times, log.column(which, joint), step);
    let bandwidth = |joint: usize| {
        let q = column(Run::q, joint);
        let mean = q.iter().sum::<f64>() / q.len() as f64;
        (
            motion_bandwidth(&q, &column(Run::qd, joint), step),
            q.iter().map(|q| step * (q - mean).powi(2)).sum(),
        )
    };
    (0..log.run.joints).map(bandwidth).collect()
}
