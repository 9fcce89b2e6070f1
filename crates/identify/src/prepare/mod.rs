//! Recordings made fit for regression: evenly sampled, filtered without delay, differentiated. What
//! was changed is told in words.

mod align;
mod cut_off;
mod even;
mod log;
mod low_pass;
mod read;
mod rest;
mod windows;

pub use align::lateness;
pub use cut_off::motion_band;
pub use even::{derivative, resampled, usual_step};
pub use log::{Log, RawLog};
pub use low_pass::LowPass;
pub use read::{LogEntry, read};
pub use rest::rests;
pub use windows::{Window, Windows, windows};

use crate::error::{Error, Result};
use rayon::prelude::*;
use reachtube_recordings::Run;
use serde::{Deserialize, Serialize};

/// What is cut from each end, in periods of the cut-off.
const END: f64 = 2.5;

/// Rates that differ by less than this part are taken as the same.
const SAME_RATE: f64 = 0.25;

/// How recordings are prepared.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct PrepareSettings {
    /// The robot's joints by name, in the order of the recordings' columns; the robot's own order
    /// where empty.
    pub joints: Vec<String>,
    /// What each recorded torque is multiplied with, in the order of the robot's joints; for
    /// currents N m/A. 1 where empty.
    pub gains: Vec<f64>,
    /// Cut-off of the low-pass \[Hz\]; chosen from the recordings where left out.
    pub cut_off: Option<f64>,
    /// Where the velocity is taken from.
    pub velocity: VelocitySource,
    /// Longest time between samples \[s\]; ten usual ones where left out.
    pub max_gap: Option<f64>,
}

/// Where a log's velocity is taken from.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum VelocitySource {
    /// For each log, the one from which the filter takes less.
    #[default]
    Quieter,
    /// The recorded velocity.
    Recorded,
    /// The filtered position, differentiated.
    Differentiated,
}

/// Prepared logs and how they were changed.
#[derive(Debug, Clone)]
pub struct Prepared {
    /// The logs in the order given.
    pub logs: Vec<Log>,
    /// Cut-off of the low-pass \[Hz\].
    pub cut_off: f64,
    /// What was changed, a sentence each.
    pub changes: Vec<String>,
}

/// What was done to one log.
struct Change {
    usual_step: f64,
    jitter: f64,
    differentiated: bool,
}

/// The cut-off asked for, or chosen from recordings with motion: 1.5 times the frequency below
/// which 99.9 % of the power of a joint's velocity lies (the median over joints and logs, weighted
/// by how much they move), at least 3 Hz so that friction steps where a joint turns, at most a
/// fifth of the sample rate.
///
/// # Errors
///
/// [`Error::Setting`] where the cut-off is not below half the sample rate.
pub fn cut_off(logs: &[&RawLog], settings: &PrepareSettings) -> Result<f64> {
    let lowest_rate =
        logs.iter().filter_map(|log| usual_step(&log.run.times)).fold(0.0, f64::max).recip();
    if let Some(given) = settings.cut_off {
        if !(given > 0.0 && given < 0.5 * lowest_rate) {
            return Err(Error::Setting(format!(
                "cut_off = {given} Hz must be above 0 and below half the sample rate, {:.4} Hz",
                0.5 * lowest_rate
            )));
        }
        return Ok(given);
    }
    let bands = logs.par_iter().flat_map_iter(|log| bands(log)).collect();
    Ok(cut_off::chosen(bands, lowest_rate))
}

/// The band of each joint's motion in a log \[Hz\], with the variance of its position times the
/// duration for weight.
fn bands(log: &RawLog) -> Vec<(f64, f64)> {
    let Some(step) = usual_step(&log.run.times) else { return Vec::new() };
    let column = |which, joint| resampled(&log.run.times, log.column(which, joint), step);
    let band = |joint: usize| {
        let q = column(Run::q, joint);
        let mean = q.iter().sum::<f64>() / q.len() as f64;
        (
            motion_band(&q, &column(Run::qd, joint), step),
            q.iter().map(|q| step * (q - mean).powi(2)).sum(),
        )
    };
    (0..log.run.joints).map(band).collect()
}

/// Prepares recordings: even sample times, gains, a low-pass without delay on positions, velocities
/// and torques, accelerations, and the ends, where a filter has to guess, cut by two and a half
/// periods of the cut-off.
///
/// # Errors
///
/// [`Error::Setting`] where a log is too short for the cut-off, or not sampled fast enough.
pub fn prepare(raw: &[RawLog], settings: &PrepareSettings, cut_off: f64) -> Result<Prepared> {
    let mut steps: Vec<f64> = raw.iter().filter_map(|log| usual_step(&log.run.times)).collect();
    steps.sort_by(f64::total_cmp);
    let common = steps.get(steps.len() / 2).copied().unwrap_or(0.0);
    let done: Vec<(Log, Change)> = raw
        .par_iter()
        .map(|log| prepare_one(log, settings, cut_off, common))
        .collect::<Result<_>>()?;
    let (logs, changes): (Vec<Log>, Vec<Change>) = done.into_iter().unzip();
    let changes = words(&logs, &changes, settings, cut_off);
    Ok(Prepared { logs, cut_off, changes })
}

/// Logs sampled at nearly the same rate get the same one, `common` \[s\], so that repeats can be
/// compared sample by sample.
fn prepare_one(
    raw: &RawLog,
    settings: &PrepareSettings,
    cut_off: f64,
    common: f64,
) -> Result<(Log, Change)> {
    let (n, times) = (raw.run.joints, &raw.run.times);
    let short = || {
        Error::Setting(format!(
            "{}: {} samples over {:.3} s are too few for a low-pass of {cut_off} Hz; leave the log out or raise cut_off",
            raw.name,
            raw.run.len(),
            raw.run.duration()
        ))
    };
    let own = usual_step(times).ok_or_else(short)?;
    let step = if (own / common - 1.0).abs() < SAME_RATE { common } else { own };
    let filter = LowPass::new(cut_off, step.recip()).ok_or_else(|| {
        Error::Setting(format!(
            "{}: sampled at {:.4} Hz, too slowly for cut_off = {cut_off} Hz",
            raw.name,
            step.recip()
        ))
    })?;
    let even = |which, joint| resampled(times, raw.column(which, joint), step);
    let smooth = |mut values: Vec<f64>| {
        filter.zero_phase(&mut values);
        values
    };
    let differentiated = match settings.velocity {
        VelocitySource::Recorded => false,
        VelocitySource::Differentiated => true,
        VelocitySource::Quieter => {
            let removed = |values: Vec<f64>| distance(&smooth(values.clone()), &values);
            let joints = || 0..n;
            let recorded: f64 = joints().map(|joint| removed(even(Run::qd, joint))).sum();
            recorded > joints().map(|joint| removed(derivative(&even(Run::q, joint), step))).sum()
        }
    };
    let samples = even(Run::q, 0).len();
    let mut log = Log::blank(&raw.name, n, samples, step);
    for joint in 0..n {
        let q = smooth(even(Run::q, joint));
        let qd = if differentiated { derivative(&q, step) } else { smooth(even(Run::qd, joint)) };
        let gain = settings.gains.get(joint).copied().unwrap_or(1.0);
        let tau = smooth(even(Run::torque, joint)).into_iter().map(|tau| gain * tau).collect();
        let columns = [
            (&mut log.q, q),
            (&mut log.qdd, derivative(&qd, step)),
            (&mut log.qd, qd),
            (&mut log.tau, tau),
        ];
        columns.into_iter().for_each(|(rows, column)| set_column(rows, joint, n, &column));
    }
    let end = (END / (cut_off * step)).ceil() as usize;
    if samples < 2 * end + 8 {
        return Err(short());
    }
    let jitter = times.windows(2).map(|pair| (pair[1] - pair[0] - own).abs()).fold(0.0, f64::max);
    Ok((log.part(end..samples - end), Change { usual_step: step, jitter, differentiated }))
}

fn set_column(rows: &mut [f64], joint: usize, n: usize, column: &[f64]) {
    rows.iter_mut().skip(joint).step_by(n).zip(column).for_each(|(cell, value)| *cell = *value);
}

fn distance(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum()
}

fn words(
    logs: &[Log],
    changes: &[Change],
    settings: &PrepareSettings,
    cut_off: f64,
) -> Vec<String> {
    let (count, samples) = (logs.len(), logs.iter().map(Log::len).sum::<usize>());
    let steps = changes.iter().map(|change| change.usual_step);
    let (fastest, slowest) =
        (steps.clone().fold(f64::INFINITY, f64::min), steps.fold(0.0, f64::max));
    let jitter = changes.iter().map(|change| change.jitter).fold(0.0, f64::max);
    let mut words = Vec::new();
    if !settings.joints.is_empty() {
        words.push(format!(
            "columns were matched with the joints by name: {}",
            settings.joints.join(", ")
        ));
    }
    if settings.gains.iter().any(|gain| *gain != 1.0) {
        words.push(format!(
            "recorded torques were multiplied by {:?} (joint by joint)",
            settings.gains
        ));
    }
    if jitter > 1e-6 {
        words.push(format!(
            "{count} logs were resampled evenly: the time between samples was up to {:.2} ms from the usual {:.2} to {:.2} ms",
            1e3 * jitter,
            1e3 * fastest,
            1e3 * slowest
        ));
    }
    let how = if settings.cut_off.is_some() {
        "as set"
    } else {
        "chosen: 1.5 times the band with 99.9 % of the velocity's power, at least 3 Hz"
    };
    words.push(format!(
        "q, qd and tau of {count} logs ({samples} samples) were filtered forward and backward, Butterworth of order 4 at {cut_off:.2} Hz ({how}); qdd is the \
         derivative of qd; {:.2} s were cut from both ends",
        END / cut_off
    ));
    let differentiated = changes.iter().filter(|change| change.differentiated).count();
    words.push(match differentiated {
        0 => "the recorded velocity was used".into(),
        _ if differentiated == count => "the velocity was differentiated from the position".into(),
        some => format!("the velocity was differentiated from the position in {some} logs, in the others the recorded one is quieter"),
    });
    words
}

#[cfg(test)]
mod tests {
    use super::*;

    fn wave() -> RawLog {
        let times: Vec<f64> =
            (0..800).map(|k| 0.01 * k as f64 + if k % 3 == 1 { 0.002 } else { 0.0 }).collect();
        let (states, torques) = (|t: &f64| [t.sin(), t.cos()], |t: &f64| 2.0 * t.sin());
        let run = Run {
            joints: 1,
            start: 0.0,
            states: times.iter().flat_map(states).collect(),
            torques: times.iter().map(torques).collect(),
            times,
            sha256: String::new(),
        };
        RawLog { name: "wave".into(), run }
    }

    #[test]
    fn a_slow_wave_is_kept_with_its_derivatives() {
        for velocity in [VelocitySource::Recorded, VelocitySource::Differentiated] {
            let settings =
                PrepareSettings { gains: vec![3.0], velocity, ..PrepareSettings::default() };
            let prepared = prepare(&[wave()], &settings, 4.0).unwrap();
            let log = &prepared.logs[0];
            for k in 0..log.len() {
                let t = log.time(k);
                let off =
                    [log.q(k)[0] - t.sin(), log.qd(k)[0] - t.cos(), log.tau(k)[0] - 6.0 * t.sin()];
                assert!(off.iter().all(|x| x.abs() < 5e-4), "{t}: {off:?}");
                // The ends are continued without curvature; 2.5 periods later 0.1 % of that is
                // left.
                let off = log.qdd(k)[0] + t.sin();
                assert!(off.abs() < 2e-3, "{t}: {off}");
            }
            assert!(
                prepared.changes.iter().any(|words| words.contains("multiplied by [3.0]")),
                "{:?}",
                prepared.changes
            );
        }
    }

    #[test]
    fn what_cannot_be_filtered_is_an_error() {
        let settings = PrepareSettings { cut_off: Some(70.0), ..PrepareSettings::default() };
        assert!(
            cut_off(&[&wave()], &settings)
                .unwrap_err()
                .to_string()
                .contains("half the sample rate")
        );
        let mut short = wave();
        short.run.times.truncate(30);
        assert!(
            prepare(&[short], &PrepareSettings::default(), 3.0)
                .unwrap_err()
                .to_string()
                .contains("too few")
        );
    }
}
