use crate::error::{Error, Result};
use crate::prepare::align::delay;
use crate::prepare::log::PreparedLog;
use crate::prepare::raw_log::RawLog;
use crate::prepare::resample::median_step;
use reachtube_files::write::atomically;
use reachtube_recordings::{MemoryRuns, Run, column_names};
use std::borrow::Cow;
use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::Path;

/// Relative difference from the time between samples up to which a window counts as that long.
const SAME_LENGTH: f64 = 1e-3;

/// Prepared recordings cut into windows, which are test suites for `reachtube conform`.
#[derive(Debug, Clone, Default)]
pub struct Windows {
    /// The windows.
    pub windows: Vec<Window>,
    /// Shifts of repeats, one sentence each.
    pub changes: Vec<String>,
    /// Whether the logs are simulated, which the index of the windows then says.
    pub simulated: bool,
    /// Standard deviations of the sensors' noise that is left, 2n, which the index says likewise.
    pub noise: Option<Vec<f64>>,
    /// The SHA-256 of each log by its name, which the index says likewise, so that windows are
    /// known by their log.
    pub origins: BTreeMap<String, String>,
}

/// An interval of a log.
#[derive(Debug, Clone)]
pub struct Window {
    /// Name of the test suite, which holds one window of one motion.
    pub suite: String,
    /// Name of the motion: the name of the log, or the common part of the names of its repeats.
    pub motion: String,
    /// The samples.
    pub log: PreparedLog,
}

/// Checks that windows of a duration \[s\] have two samples of each log.
///
/// # Errors
///
/// [`Error::ShortWindow`].
pub fn check_window<'a>(duration: f64, logs: impl IntoIterator<Item = &'a RawLog>) -> Result<()> {
    let is_long = |step: &f64| *step * (1.0 - SAME_LENGTH) > duration;
    let short = logs.into_iter().find_map(|log| {
        let step = median_step(&log.run.times).filter(is_long)?;
        Some(Error::ShortWindow { log: log.name.clone(), window: duration, step })
    });
    short.map_or(Ok(()), Err)
}

/// Cuts logs into windows of a duration \[s\]; without a duration each log is one window.
///
/// With `repeats`, logs whose names differ only after the last `_` are repeats of one motion. They
/// are aligned with the first repeat by their velocities, and each window of the motion is a suite
/// with one run per repeat. A rest that does not fill a window is dropped.
#[must_use]
pub fn windows(logs: &[PreparedLog], duration: Option<f64>, repeats: bool) -> Windows {
    let motion_of = |log: &PreparedLog| match log.name.rsplit_once('_') {
        Some((motion, _)) if repeats => motion.to_string(),
        _ => log.name.clone(),
    };
    // Repeats and their delays against the first.
    let motions: Vec<String> = logs.iter().map(motion_of).collect();
    let first =
        |index: usize| motions.iter().position(|motion| *motion == motions[index]).unwrap_or(index);
    let late = |index: usize| match first(index) {
        reference if reference == index => 0.0,
        reference => delay(&logs[reference], &logs[index]).unwrap_or(0.0),
    };
    let delays: Vec<f64> = (0..logs.len()).map(late).collect();
    let mut found = Windows::default();
    for (index, (log, motion)) in logs.iter().zip(&motions).enumerate() {
        if delays[index] != 0.0 {
            let reference = &logs[first(index)].name;
            found.changes.push(format!(
                "{} lags {reference} by {:.1} ms and was shifted by whole samples to align",
                log.name,
                1e3 * delays[index]
            ));
        }
        // Samples to skip: the earliest repeat starts at its first sample.
        let same = (0..logs.len()).filter(|other| motions[*other] == *motion);
        let earliest = same.map(|other| delays[other]).fold(0.0, f64::min);
        let skip = ((delays[index] - earliest) / log.step).round() as usize;
        let rest = log.len().saturating_sub(skip + 1);
        let length =
            duration.map_or(rest, |duration| (duration / log.step).round().max(1.0) as usize);
        // Windows of whole length.
        for k in 0..rest.checked_div(length).unwrap_or(0) {
            let start = skip + k * length;
            let suite =
                if duration.is_some() { format!("{motion}_w{:02}", k + 1) } else { motion.clone() };
            found.windows.push(Window {
                suite,
                motion: motion.clone(),
                log: log.interval(start..start + length + 1),
            });
        }
    }
    found
}

impl Windows {
    /// Returns the name of each window's file.
    pub fn file_names(&self) -> impl Iterator<Item = String> + '_ {
        let windows = self.windows.iter().enumerate();
        windows.map(|(number, window)| format!("{:04}_{}.csv", number + 1, window.log.name))
    }

    /// Returns the windows as recordings in memory, with the numbers that [`write`](Self::write)
    /// writes.
    ///
    /// # Panics
    ///
    /// Never: a window has one row of finite numbers for each sample.
    #[must_use]
    pub fn runs(&self) -> MemoryRuns {
        let mut runs = MemoryRuns::default();
        for (file, window) in self.file_names().zip(&self.windows) {
            let log = &window.log;
            let times = (0..log.len()).map(|k| decimals(k as f64 * log.step, 6)).collect();
            let row = |k: usize| log.q(k).iter().chain(log.qd(k)).map(|value| decimals(*value, 7));
            let states = (0..log.len()).flat_map(row).collect();
            let torques = log.tau.iter().map(|value| decimals(*value, 7)).collect();
            let run = Run::new(log.joints, times, states, torques);
            let run = run.expect("a window has one row of finite numbers for each sample");
            let entry = runs.push(&file, Some(&window.suite), Some(&window.motion), run);
            entry.simulated = self.simulated;
            entry.noise.clone_from(&self.noise);
            entry.origin = self.origins.get(&window.log.name).cloned();
        }
        runs
    }

    /// Writes the windows as CSV files into a folder, with their index runs.csv.
    ///
    /// Times in a file count from the start of its window.
    ///
    /// # Errors
    ///
    /// [`Error::File`](crate::Error::File) if a file cannot be written.
    pub fn write(&self, folder: &Path) -> Result<()> {
        let mut index = String::from("file,suite,motion,simulated,noise,origin\n");
        let noise: Vec<String> =
            self.noise.iter().flatten().map(|deviation| format!("{deviation:.2e}")).collect();
        let noise = noise.join(" ");
        for (file, window) in self.file_names().zip(&self.windows) {
            let [name, suite, motion] =
                [&file, &window.suite, &window.motion].map(|name| cell(name));
            let origin = self.origins.get(&window.log.name).map_or("", String::as_str);
            let _ = writeln!(index, "{name},{suite},{motion},{},{noise},{origin}", self.simulated);
            let text = csv(&window.log);
            atomically(&folder.join(&file), |out| out.write_all(text.as_bytes()))?;
        }
        atomically(&folder.join("runs.csv"), |out| out.write_all(index.as_bytes()))?;
        Ok(())
    }
}

fn cell(name: &str) -> Cow<'_, str> {
    match name.contains([',', '"', '\n', '\r']) {
        true => format!("\"{}\"", name.replace('"', "\"\"")).into(),
        false => name.into(),
    }
}

/// Returns a number as it is read back from a file with some decimals.
fn decimals(value: f64, count: usize) -> f64 {
    let text = format!("{value:.count$}");
    text.parse().expect("a number is read back")
}

fn csv(log: &PreparedLog) -> String {
    let mut text = std::iter::once("t".to_string())
        .chain(column_names(log.joints))
        .collect::<Vec<_>>()
        .join(",");
    text.push('\n');
    for k in 0..log.len() {
        let _ = write!(text, "{:.6}", k as f64 * log.step);
        let values = log.q(k).iter().chain(log.qd(k)).chain(log.tau(k));
        values.for_each(|value| {
            let _ = write!(text, ",{value:.7}");
        });
        text.push('\n');
    }
    text
}

#[cfg(test)]
mod tests {
    use reachtube_recordings::{ReadOptions, RunSource};

    use super::*;

    fn bump(name: &str, centre: f64) -> PreparedLog {
        let qd: Vec<f64> =
            (0..400).map(|k| (-((k as f64 * 0.01 - centre) / 0.2).powi(2)).exp()).collect();
        PreparedLog { qd, ..PreparedLog::zeros(name, 1, 400, 0.01) }
    }

    #[test]
    fn repeats_are_aligned_and_share_suites() {
        let logs = [bump("A_1", 1.5), bump("A_2", 1.8), bump("B_1", 1.0)];
        let found = windows(&logs, Some(1.0), true);
        let suites: Vec<&str> = found.windows.iter().map(|w| w.suite.as_str()).collect();
        assert_eq!(suites[..3], ["A_w01", "A_w02", "A_w03"]);
        assert_eq!(suites.iter().filter(|s| **s == "A_w02").count(), 2);
        assert!(found.changes[0].contains("A_2 lags A_1 by 300.0 ms"), "{:?}", found.changes);
        let peak = |w: &Window| {
            (0..w.log.len()).max_by(|a, b| w.log.qd(*a)[0].total_cmp(&w.log.qd(*b)[0])).unwrap()
        };
        let second: Vec<&Window> = found.windows.iter().filter(|w| w.suite == "A_w02").collect();
        assert_eq!((peak(second[0]), peak(second[1])), (50, 50));
    }

    #[test]
    fn windows_shorter_than_the_time_between_samples_are_refused() {
        let times: Vec<f64> = (0..5).map(|k| 0.1 * f64::from(k)).collect();
        let run = Run::new(1, times, vec![0.0; 10], vec![0.0; 5]).unwrap();
        let log = RawLog::new("slow", "slow.csv", run);
        assert!(check_window(0.1, [&log]).is_ok());
        let refused = check_window(0.02, [&log]).unwrap_err().to_string();
        let expected = "slow: a window of 0.02 s is shorter than the time between samples, 0.1 s";
        assert!(refused.starts_with(expected), "{refused}");
    }

    #[test]
    fn the_written_files_are_a_data_set() {
        let folder = tempfile::tempdir().unwrap();
        let noise = Some(vec![1.5e-5, 0.0]);
        let prepared = Windows { noise, ..windows(&[bump("a", 1.0)], None, false) };
        prepared.write(folder.path()).unwrap();
        let data = reachtube_recordings::DataSet::open(folder.path()).unwrap();
        let run = data.read(0, &ReadOptions::default()).unwrap();
        assert_eq!((run.len(), data.suites()[0].name.as_str()), (400, "a"));
        let in_memory = prepared.runs();
        assert_eq!(data.runs()[0].noise, Some(vec![1.5e-5, 0.0]));
        assert_eq!(in_memory.runs()[0].noise, data.runs()[0].noise);
        let own = in_memory.read(0, &ReadOptions::default()).unwrap();
        assert_eq!((own.times, own.states, own.torques), (run.times, run.states, run.torques));
        assert_eq!(in_memory.runs()[0].file, data.runs()[0].file);
    }
}
