use crate::error::{Error, Result};
use crate::prepare::changes::{LogChange, described};
use crate::prepare::derivative::derivative;
use crate::prepare::log::Log;
use crate::prepare::low_pass::{LowPass, TRANSIENT_PERIODS};
use crate::prepare::raw_log::RawLog;
use crate::prepare::resample::{median_step, resampled};
use crate::prepare::settings::{PrepareSettings, VelocitySource};
use rayon::prelude::*;
use reachtube_recordings::Run;

/// Relative difference up to which two sample times count as the same.
const SAME_STEP: f64 = 0.25;

/// Samples that must remain between the ends.
const MIN_SAMPLES: usize = 8;

/// Prepared logs and how they were changed.
#[derive(Debug, Clone)]
pub struct Prepared {
    /// The logs in the order given.
    pub logs: Vec<Log>,
    /// Cut-off frequency of the low-pass \[Hz\].
    pub cut_off: f64,
    /// Changes to the recordings, one sentence each.
    pub changes: Vec<String>,
}

/// Prepares recordings for regression with a low-pass of cut-off `cut_off` \[Hz\].
///
/// Samples become evenly spaced, gains are applied to torques, and positions, velocities and
/// torques are filtered without phase shift. Accelerations are derivatives of the velocity. Both
/// ends, where the filter extrapolates, are cut by 2.5 periods of the cut-off.
///
/// # Errors
///
/// [`Error::TooShort`] and [`Error::SampledTooSlowly`] name a recording that does not suit the
/// cut-off.
pub fn prepare(raw: &[RawLog], settings: &PrepareSettings, cut_off: f64) -> Result<Prepared> {
    let common = common_step(raw.iter().filter_map(|log| median_step(&log.run.times)).collect());
    let done: Vec<(Log, LogChange)> = raw
        .par_iter()
        .map(|log| prepare_one(log, settings, cut_off, common))
        .collect::<Result<_>>()?;
    let (logs, changes): (Vec<Log>, Vec<LogChange>) = done.into_iter().unzip();
    let changes = described(logs.iter().map(Log::len).sum(), &changes, settings, cut_off);
    Ok(Prepared { logs, cut_off, changes })
}

/// Returns the median of the median times between the samples of recordings \[s\].
pub(crate) fn common_step(mut steps: Vec<f64>) -> f64 {
    steps.sort_by(f64::total_cmp);
    steps.get(steps.len() / 2).copied().unwrap_or(0.0)
}

/// Prepares one recording.
///
/// Recordings sampled at nearly the same rate get the same sample time, `common` \[s\], so that
/// repeats can be compared sample by sample.
pub(crate) fn prepare_one(
    raw: &RawLog,
    settings: &PrepareSettings,
    cut_off: f64,
    common: f64,
) -> Result<(Log, LogChange)> {
    let too_short = || Error::TooShort {
        log: raw.name.clone(),
        samples: raw.run.len(),
        duration: raw.run.duration(),
        cut_off,
    };
    // One even sample time.
    let median = median_step(&raw.run.times).ok_or_else(too_short)?;
    let step = if (median / common - 1.0).abs() < SAME_STEP { common } else { median };
    // Filtered signals of all joints.
    let filter = LowPass::new(cut_off, step.recip()).ok_or_else(|| Error::SampledTooSlowly {
        log: raw.name.clone(),
        rate: step.recip(),
        cut_off,
    })?;
    let signals = Signals { raw, filter, step };
    let differentiated = match settings.velocity {
        VelocitySource::Recorded => false,
        VelocitySource::Differentiated => true,
        VelocitySource::Quieter => signals.is_differentiated_quieter(),
    };
    let log = signals.log(&settings.gains, differentiated);
    // Ends without the filter's extrapolation.
    let end = (TRANSIENT_PERIODS / (cut_off * step)).ceil() as usize;
    let samples = log.len();
    if samples < 2 * end + MIN_SAMPLES {
        return Err(too_short());
    }
    let deviation = |pair: &[f64]| (pair[1] - pair[0] - median).abs();
    let jitter = raw.run.times.windows(2).map(deviation).fold(0.0, f64::max);
    let change = LogChange { median_step: median, jitter, differentiated };
    Ok((log.interval(end..samples - end), change))
}

/// The signals of a recording at an even sample time, and their low-pass.
struct Signals<'a> {
    raw: &'a RawLog,
    filter: LowPass,
    step: f64,
}

impl<'a> Signals<'a> {
    fn even(&self, which: fn(&'a Run, usize) -> &'a [f64], joint: usize) -> Vec<f64> {
        resampled(&self.raw.run.times, self.raw.column(which, joint), self.step)
    }

    fn filtered(&self, mut values: Vec<f64>) -> Vec<f64> {
        self.filter.zero_phase(&mut values);
        values
    }

    /// Returns whether the filter removes less from the differentiated position than from the
    /// recorded velocity, summed over the joints.
    fn is_differentiated_quieter(&self) -> bool {
        let removed = |values: Vec<f64>| distance(&self.filtered(values.clone()), &values);
        let joints = || 0..self.raw.run.joints;
        let recorded: f64 = joints().map(|joint| removed(self.even(Run::qd, joint))).sum();
        let slope = |joint: usize| derivative(&self.even(Run::q, joint), self.step);
        recorded > joints().map(|joint| removed(slope(joint))).sum()
    }

    /// Returns the filtered log with the ends still in place.
    fn log(&self, gains: &[f64], differentiated: bool) -> Log {
        let n = self.raw.run.joints;
        let mut log = Log::zeros(&self.raw.name, n, self.even(Run::q, 0).len(), self.step);
        log.order = self.raw.order;
        // Temperatures change too slowly to need the low-pass.
        if !self.raw.run.temperatures.is_empty() {
            log.temperatures = vec![0.0; log.q.len()];
            (0..n).for_each(|joint| {
                let column = self.even(Run::temperature, joint);
                set_column(&mut log.temperatures, joint, n, &column);
            });
        }
        for joint in 0..n {
            let q = self.filtered(self.even(Run::q, joint));
            let qd = if differentiated {
                derivative(&q, self.step)
            } else {
                self.filtered(self.even(Run::qd, joint))
            };
            let gain = gains.get(joint).copied().unwrap_or(1.0);
            let tau = self.filtered(self.even(Run::torque, joint));
            let columns = [
                (&mut log.q, q),
                (&mut log.qdd, derivative(&qd, self.step)),
                (&mut log.qd, qd),
                (&mut log.tau, tau.into_iter().map(|tau| gain * tau).collect()),
            ];
            columns.into_iter().for_each(|(rows, column)| set_column(rows, joint, n, &column));
        }
        log
    }
}

fn set_column(rows: &mut [f64], joint: usize, n: usize, column: &[f64]) {
    rows.iter_mut().skip(joint).step_by(n).zip(column).for_each(|(cell, value)| *cell = *value);
}

/// Returns the squared Euclidean distance.
fn distance(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::prepare::cut_off::cut_off;

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
            temperatures: vec![],
            sha256: String::new(),
        };
        RawLog { name: "wave".into(), file: "wave.csv".into(), order: None, run }
    }

    #[test]
    fn a_slow_wave_and_its_derivatives_pass_unchanged() {
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
                // The extended ends have no curvature. The error of that decays to 0.1 % within the
                // 2.5 periods that are cut.
                let off = log.qdd(k)[0] + t.sin();
                assert!(off.abs() < 2e-3, "{t}: {off}");
            }
            assert!(
                prepared.changes.iter().any(|change| change.contains("multiplied by [3.0]")),
                "{:?}",
                prepared.changes
            );
        }
    }

    #[test]
    fn recordings_that_do_not_suit_the_cut_off_are_errors() {
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
