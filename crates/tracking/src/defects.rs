//! What recordings of commands show besides motions that follow them.

use std::ops::Range;

use reachtube_finding::{Finding, Severity};
use reachtube_scalar::number::{counted, significant};

use crate::code::Code;
use crate::error::{Error, Result};
use crate::recording::TrackedRun;

/// Actual positions that are commands of at most this many samples before are no measurement.
const MOST_BEFORE: usize = 10;

/// Positions count as copied if this share of the samples with a new command is.
const COPIED: f64 = 0.99;

/// An arm is off its command at first if its error is this many times the one that 90 % of the
/// samples keep.
const OFF: f64 = 3.0;

/// An arm stands if no joint is faster than this part of the highest commanded speed.
const STANDS: f64 = 0.01;

/// A command goes on if a joint of it is faster than this part of its highest speed.
const GOES_ON: f64 = 0.1;

/// An arm that stands for so long while its command goes on does not follow it, s.
const STOPPED: f64 = 0.3;

impl TrackedRun {
    /// Refuses actual positions that are no measurement: the commands of earlier samples.
    pub(crate) fn refuse_copy(&self) -> Result<()> {
        let (n, samples) = (self.joint_count(), self.times.len());
        let row = |of: &'_ [f64], k: usize| of[k * n..(k + 1) * n].to_vec();
        let changes = |k: &usize| row(&self.command, *k) != row(&self.command, k - 1);
        for before in 0..=MOST_BEFORE.min(samples - 1) {
            let changed: Vec<usize> = (before.max(1)..samples).filter(changes).collect();
            let equal = |k: &&usize| row(&self.actual, **k) == row(&self.command, **k - before);
            let copied = changed.iter().filter(equal).count();
            if !changed.is_empty() && copied as f64 >= COPIED * changed.len() as f64 {
                return Err(Error::NoMeasurement { file: self.file.clone(), before, copied });
            }
        }
        Ok(())
    }

    /// Returns the samples in which the arm follows its command, and what was found about the
    /// others: it starts off its command, or it stops before its command does.
    pub(crate) fn following(&self) -> (Range<usize>, Vec<Finding>) {
        let samples = self.times.len();
        let (mut range, mut found) = (0..samples, Vec::new());
        let errors: Vec<f64> = (0..samples).map(|k| self.largest_error(k)).collect();
        let mut sorted = errors.clone();
        sorted.sort_by(f64::total_cmp);
        let usual = sorted[samples * 9 / 10];
        let fastest = (0..samples).map(|k| self.speed(k)).fold(0.0, f64::max);
        // A log may begin in the middle of a motion, with the lag of it.
        let is_slow = self.speed(0) <= GOES_ON * fastest;
        if is_slow && errors[0] >= OFF * usual && usual > 0.0 {
            // Thrice as long, an error that decays is as small beside the usual one again.
            let usual_at = errors.iter().position(|error| *error <= usual).unwrap_or(samples);
            range.start = (3 * usual_at).min(samples);
            found.push(self.set_aside(
                0..range.start,
                &format!(
                    "the arm is {} {} off its command at first",
                    significant(errors[0], 2),
                    self.units[0]
                ),
            ));
        }
        if let Some(stop) = self.stops() {
            range.end = stop.max(range.start);
            let why = "the arm stands while its command goes on, as after a protective stop";
            found.push(self.set_aside(range.end..samples, why));
        }
        (range, found)
    }

    fn set_aside(&self, rows: Range<usize>, why: &str) -> Finding {
        let text = format!(
            "{}: {why}, at {:.3} s: {} set aside; leave the log out, or cut it there.",
            self.file.display(),
            self.times[rows.start.min(self.times.len() - 1)],
            counted(rows.len(), "sample"),
        );
        Finding::new(Severity::Warning, Code::NotFollowing, text)
            .at(self.name())
            .with("samples", rows.len() as f64)
    }

    /// Returns the largest error over the joints at sample `k`.
    fn largest_error(&self, k: usize) -> f64 {
        (0..self.joint_count()).map(|joint| self.error(k, joint).abs()).fold(0.0, f64::max)
    }

    /// Returns the sample from which the arm stands while its command goes on.
    fn stops(&self) -> Option<usize> {
        let (n, samples) = (self.joint_count(), self.times.len());
        let speeds: Vec<f64> = (0..samples).map(|k| self.speed(k)).collect();
        let fastest = speeds.iter().copied().fold(0.0, f64::max);
        let actual_speed = |k: usize| {
            let moved = |joint: usize| {
                (self.actual[k * n + joint] - self.actual[(k - 1) * n + joint]).abs()
            };
            (0..n).map(moved).fold(0.0, f64::max) / (self.times[k] - self.times[k - 1])
        };
        let is_left =
            |k: usize| actual_speed(k) < STANDS * fastest && speeds[k] > GOES_ON * fastest;
        let mut first = 1;
        for k in 1..samples {
            if !is_left(k) {
                first = k + 1;
            } else if self.times[k] - self.times[first] >= STOPPED {
                return Some(first);
            }
        }
        None
    }

    /// Returns the samples of a range as a recording.
    pub(crate) fn only(&self, rows: Range<usize>) -> Self {
        let n = self.joint_count();
        let first = self.times[rows.start];
        let positions = |of: &[f64]| of[rows.start * n..rows.end * n].to_vec();
        Self {
            times: self.times[rows.clone()].iter().map(|time| time - first).collect(),
            command: positions(&self.command),
            actual: positions(&self.actual),
            ..self.clone()
        }
    }
}
