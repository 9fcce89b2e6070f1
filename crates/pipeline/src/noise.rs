//! The noise of the sensors, as it is left in prepared recordings.

use reachtube_identify::prepare::RawLog;
use reachtube_recordings::noise_deviations;

/// Standard deviations within which noise is taken to lie.
const DEVIATIONS: f64 = 5.0;

/// Returns the radii of the sensors' noise, 2n, rad and rad/s, rounded to two digits; after a
/// low-pass of `cut_off` \[Hz\] of what is left of it. White noise keeps the part of its variance
/// that lies below the cut-off, and a filtered velocity is as noisy as the recorded one or as the
/// derivative of the position, whichever is less.
pub(crate) fn noise(logs: &[&RawLog], cut_off: Option<f64>) -> Vec<f64> {
    let left = |log: &&RawLog| -> Option<Vec<f64>> {
        let run = &log.run;
        let mut deviations = noise_deviations(run)?;
        let Some(cut_off) = cut_off else { return Some(deviations) };
        let n = run.joints;
        let step = run.duration() / (run.len() - 1).max(1) as f64;
        let slope = 2.0 * std::f64::consts::PI * cut_off / 3f64.sqrt();
        for joint in 0..n {
            deviations[n + joint] = deviations[n + joint].min(slope * deviations[joint]);
        }
        let part = (2.0 * cut_off * step).sqrt().min(1.0);
        Some(deviations.into_iter().map(|deviation| part * deviation).collect())
    };
    let all: Vec<Vec<f64>> = logs.iter().filter_map(left).collect();
    let states = logs.first().map_or(0, |log| 2 * log.run.joints);
    let median = |i: usize| {
        let mut values: Vec<f64> = all.iter().map(|noise| noise[i]).collect();
        values.sort_by(f64::total_cmp);
        rounded(DEVIATIONS * values.get(values.len() / 2).copied().unwrap_or(0.0))
    };
    (0..states).map(median).collect()
}

/// Rounds up to two digits.
fn rounded(value: f64) -> f64 {
    if value <= 0.0 {
        return 0.0;
    }
    let unit = 10f64.powi(value.log10().floor() as i32 - 1);
    let digits = (value / unit).ceil();
    // The shortest number with these digits.
    format!("{digits}e{}", unit.log10().round() as i32).parse().unwrap_or(value)
}
