//! The noise of the sensors, as it is left in prepared recordings.

use crate::prepare::raw_log::RawLog;
use reachtube_diagnose::median;
use reachtube_recordings::noise_deviations;
use std::f64::consts::PI;

/// Returns the standard deviations of the sensors' noise, 2n, rad and rad/s, as a low-pass of
/// `cut_off` \[Hz\] leaves them: the median over the recordings. Without a cut-off nothing is
/// filtered. The result is `None` if no recording has enough samples.
///
/// A filtered recording does not show its noise, so it is measured before. White noise keeps the
/// part of its variance that lies below the cut-off, and a filtered velocity is as noisy as the
/// recorded one or as the derivative of the position, whichever is less.
#[must_use]
pub fn noise_left(logs: &[&RawLog], cut_off: Option<f64>) -> Option<Vec<f64>> {
    let all: Vec<Vec<f64>> = logs.iter().filter_map(|log| of_log(log, cut_off)).collect();
    let states = all.first()?.len();
    (0..states).map(|i| median(all.iter().map(|noise| noise[i]))).collect()
}

fn of_log(log: &RawLog, cut_off: Option<f64>) -> Option<Vec<f64>> {
    let run = &log.run;
    let mut deviations = noise_deviations(run)?;
    let Some(cut_off) = cut_off else { return Some(deviations) };
    let n = run.joints;
    let step = run.duration() / (run.len() - 1).max(1) as f64;
    let slope = 2.0 * PI * cut_off / 3f64.sqrt();
    for joint in 0..n {
        deviations[n + joint] = deviations[n + joint].min(slope * deviations[joint]);
    }
    let part = (2.0 * cut_off * step).sqrt().min(1.0);
    Some(deviations.into_iter().map(|deviation| part * deviation).collect())
}
