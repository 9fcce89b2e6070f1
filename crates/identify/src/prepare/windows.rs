use super::{Log, lateness};
use crate::error::Result;
use reachtube_files::write::atomically;
use reachtube_recordings::column_names;
use std::fmt::Write;
use std::path::Path;

/// Prepared recordings cut into windows: test suites for `conform`.
#[derive(Debug, Clone)]
pub struct Windows {
    /// The windows.
    pub windows: Vec<Window>,
    /// How repeats were shifted, a sentence each.
    pub changes: Vec<String>,
}

/// A stretch of a log.
#[derive(Debug, Clone)]
pub struct Window {
    /// The suite: one window of one motion.
    pub suite: String,
    /// The motion: the log, or the log that is repeated.
    pub motion: String,
    /// The samples; times count from the window's start.
    pub log: Log,
}

/// Cuts logs into windows of a duration \[s\], or leaves them whole. Logs whose names differ after
/// the last `_` only are repeats of a motion where `repeats` is set: they are aligned with the
/// first by their velocities, and each window of a motion is a suite with a run a repeat. What does
/// not fill a window is left out.
pub fn windows(logs: &[Log], duration: Option<f64>, repeats: bool) -> Windows {
    let motion_of = |log: &Log| match log.name.rsplit_once('_') {
        Some((motion, _)) if repeats => motion.to_string(),
        _ => log.name.clone(),
    };
    let motions: Vec<String> = logs.iter().map(motion_of).collect();
    let first =
        |index: usize| motions.iter().position(|motion| *motion == motions[index]).unwrap_or(index);
    let late: Vec<f64> = (0..logs.len())
        .map(|index| {
            if first(index) == index {
                0.0
            } else {
                lateness(&logs[first(index)], &logs[index]).unwrap_or(0.0)
            }
        })
        .collect();
    let mut found = Windows { windows: Vec::new(), changes: Vec::new() };
    for (index, (log, motion)) in logs.iter().zip(&motions).enumerate() {
        if late[index] != 0.0 {
            let reference = &logs[first(index)].name;
            found.changes.push(format!(
                "{} is {:.1} ms late against {reference}; it was shifted by whole samples",
                log.name,
                1e3 * late[index]
            ));
        }
        // The earliest repeat keeps its start.
        let same = (0..logs.len()).filter(|other| motions[*other] == *motion);
        let earliest = same.map(|other| late[other]).fold(0.0, f64::min);
        let skip = ((late[index] - earliest) / log.step).round() as usize;
        let rest = log.len().saturating_sub(skip + 1);
        let length =
            duration.map_or(rest, |duration| (duration / log.step).round().max(1.0) as usize);
        for k in 0..rest.checked_div(length).unwrap_or(0) {
            let start = skip + k * length;
            let suite =
                if duration.is_some() { format!("{motion}_w{:02}", k + 1) } else { motion.clone() };
            found.windows.push(Window {
                suite,
                motion: motion.clone(),
                log: log.part(start..start + length + 1),
            });
        }
    }
    found
}

impl Windows {
    /// Writes the windows as CSV files with their index runs.csv into a folder.
    ///
    /// # Errors
    ///
    /// [`Error::File`](crate::Error::File).
    pub fn write(&self, folder: &Path) -> Result<()> {
        let mut index = String::from("file,suite,motion\n");
        for (number, window) in self.windows.iter().enumerate() {
            let file = format!("{:04}_{}.csv", number + 1, window.log.name);
            let _ = writeln!(index, "{file},{},{}", window.suite, window.motion);
            let text = csv(&window.log);
            atomically(&folder.join(&file), |out| out.write_all(text.as_bytes()))?;
        }
        atomically(&folder.join("runs.csv"), |out| out.write_all(index.as_bytes()))?;
        Ok(())
    }
}

fn csv(log: &Log) -> String {
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
    use super::*;

    fn bump(name: &str, centre: f64) -> Log {
        let qd: Vec<f64> =
            (0..400).map(|k| (-((k as f64 * 0.01 - centre) / 0.2).powi(2)).exp()).collect();
        Log { qd, ..Log::blank(name, 1, 400, 0.01) }
    }

    #[test]
    fn repeats_are_aligned_and_share_suites() {
        let logs = [bump("A_1", 1.5), bump("A_2", 1.8), bump("B_1", 1.0)];
        let found = windows(&logs, Some(1.0), true);
        let suites: Vec<&str> = found.windows.iter().map(|w| w.suite.as_str()).collect();
        assert_eq!(suites[..3], ["A_w01", "A_w02", "A_w03"]);
        assert_eq!(suites.iter().filter(|s| **s == "A_w02").count(), 2);
        assert!(found.changes[0].contains("A_2 is 300.0 ms late"), "{:?}", found.changes);
        let peak = |w: &Window| {
            (0..w.log.len()).max_by(|a, b| w.log.qd(*a)[0].total_cmp(&w.log.qd(*b)[0])).unwrap()
        };
        let second: Vec<&Window> = found.windows.iter().filter(|w| w.suite == "A_w02").collect();
        assert_eq!((peak(second[0]), peak(second[1])), (50, 50));
    }

    #[test]
    fn what_is_written_is_a_data_set() {
        let folder = tempfile::tempdir().unwrap();
        windows(&[bump("a", 1.0)], None, false).write(folder.path()).unwrap();
        let data = reachtube_recordings::DataSet::open(folder.path()).unwrap();
        let run = data.read(0, Some(1), reachtube_recordings::GapLimit::Usual, None).unwrap();
        assert_eq!((run.len(), data.suites()[0].name.as_str()), (400, "a"));
    }
}
