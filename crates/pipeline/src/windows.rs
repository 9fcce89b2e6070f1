//! Prepared recordings cut into windows, as recordings of a conformance.

use std::collections::BTreeMap;
use std::path::PathBuf;

use reachtube_identify::prepare::{PreparedLog, Window, windows};
use reachtube_recordings::{MemoryRuns, Run};

use crate::error::{Error, Result};

/// Parts into which a single motion is divided, so that one can be compared with the others.
const PARTS: usize = 4;

/// Prepared recordings, and how they are cut.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Prepared<'a> {
    /// The recordings.
    pub logs: &'a [PreparedLog],
    /// The log of each, by its name.
    pub origins: &'a BTreeMap<String, Origin>,
    /// Whether a recording counts from its start, and recordings of a motion are one suite, as
    /// where inputs were commanded; else each is cut into windows, which are suites of their own.
    pub from_start: bool,
    /// Whether the windows of a single motion count as motions in four parts of it.
    pub divides: bool,
    /// Whether the recordings are simulated.
    pub simulated: bool,
    /// The shortest horizon that is tried, s: over less than half a period of the cut-off, sets
    /// measure the low-pass.
    pub shortest: f64,
}

/// The log of a recording.
#[derive(Debug, Clone)]
pub(crate) struct Origin {
    /// The motion that it shows.
    pub motion: String,
    /// Its SHA-256.
    pub sha256: String,
    /// Whether the robot rests in it.
    pub at_rest: bool,
}

impl Prepared<'_> {
    /// Cuts recordings at `horizon` \[s\], at most `most` windows of them evenly spread.
    ///
    /// # Errors
    ///
    /// [`Error::NoWindow`] if no recording is as long.
    pub(crate) fn cut(&self, horizon: f64, most: usize) -> Result<MemoryRuns> {
        self.cut_some(horizon, most, |_| true)
    }

    /// Does what [`cut`](Self::cut) does for what `is_wanted` takes by its name.
    ///
    /// # Errors
    ///
    /// As [`cut`](Self::cut).
    pub(crate) fn cut_some(
        &self,
        horizon: f64,
        most: usize,
        is_wanted: impl Fn(&str) -> bool,
    ) -> Result<MemoryRuns> {
        let all = match self.from_start {
            true => self.beginnings(horizon),
            false => windows(self.logs, Some(horizon), false).windows,
        };
        let count = if self.from_start { all.len() } else { all.len().min(most) };
        if count == 0 {
            return Err(Error::NoWindow { horizon });
        }
        let motion = |index: usize| self.motion(&all[index].motion);
        let is_single = (0..all.len()).all(|index| motion(index) == motion(0));
        let mut runs = MemoryRuns::default();
        for index in (0..count).map(|k| k * all.len() / count) {
            let window = &all[index];
            let is_part = is_single && self.divides && !self.from_start;
            let motion = match is_part {
                true => format!("{} part {}", motion(index), 1 + PARTS * index / all.len()),
                false => motion(index).to_string(),
            };
            let name = if self.from_start { &window.log.name } else { &window.suite };
            if is_wanted(name) {
                let run = run(&window.log);
                let entry = runs.push(name, Some(&window.suite), Some(&motion), run);
                entry.order = window.log.order.unwrap_or(entry.order);
                entry.simulated = self.simulated;
                entry.is_part = is_part;
                let origin = self.origins.get(&window.motion);
                entry.origin = origin.map(|log| log.sha256.clone());
                entry.at_rest = origin.is_some_and(|log| log.at_rest);
            }
        }
        Ok(runs)
    }

    /// Returns the duration of the longest recording, s, to the microsecond.
    pub(crate) fn longest(&self) -> f64 {
        let duration = |log: &PreparedLog| log.len().saturating_sub(1) as f64 * log.step;
        let longest = self.logs.iter().map(duration).fold(0.0, f64::max);
        (1e6 * longest).round() / 1e6
    }

    /// Returns the recordings up to a horizon, if one is as long.
    fn beginnings(&self, horizon: f64) -> Vec<Window> {
        if self.longest() < horizon {
            return Vec::new();
        }
        let beginning = |log: &PreparedLog| {
            let samples = ((horizon / log.step).round() as usize + 1).min(log.len());
            let suite = self.motion(&log.name).to_string();
            Window { suite, motion: log.name.clone(), log: log.interval(0..samples) }
        };
        self.logs.iter().map(beginning).collect()
    }

    /// Returns the motion that a log shows.
    pub(crate) fn motion<'a>(&'a self, log: &'a str) -> &'a str {
        self.origins.get(log).map_or(log, |origin| &origin.motion)
    }
}

/// Returns what messages call the windows of logs at some paths.
pub(crate) fn windows_of(paths: &[PathBuf]) -> String {
    let paths: Vec<String> = paths.iter().map(|path| path.display().to_string()).collect();
    format!("windows of {}", paths.join(", "))
}

/// Returns the samples of a window as a recording. Its times are multiples of the sample time to
/// the microsecond, so that all windows share one grid.
fn run(log: &PreparedLog) -> Run {
    let time = |k: usize| (1e6 * k as f64 * log.step).round() / 1e6;
    let states = (0..log.len()).flat_map(|k| [log.q(k), log.qd(k)].concat()).collect();
    let times = (0..log.len()).map(time).collect();
    let run = Run::new(log.joints, times, states, log.tau.clone())
        .expect("a window has one row of finite numbers for each sample");
    let before = log.before.get(..3 * log.joints).unwrap_or_default().to_vec();
    Run { temperatures: log.temperatures.clone(), before, ..run }
}
