//! Prepared recordings cut into windows, as recordings of a conformance.

use std::collections::BTreeMap;

use reachtube_identify::prepare::{PreparedLog, windows};
use reachtube_recordings::{MemoryRuns, Run};

use crate::error::{Error, Result};

/// Parts into which a single motion is divided, so that one can be compared with the others.
const PARTS: usize = 4;

/// Cuts recordings into windows of `horizon` \[s\], each a suite of its own, at most `most` of them
/// evenly spread. `motions` has the motion of each log; the windows of a single one belong to four
/// parts of it.
///
/// # Errors
///
/// [`Error::NoWindow`] if no recording is as long.
pub(crate) fn cut(
    logs: &[PreparedLog],
    motions: &BTreeMap<String, String>,
    horizon: f64,
    most: usize,
) -> Result<MemoryRuns> {
    Ok(cut_some(logs, motions, horizon, most, |_, _| true)?.0)
}

/// Does what [`cut`] does for the windows that `is_wanted` takes, by the number of their motion and
/// their name, and returns how many motions there are.
///
/// # Errors
///
/// As [`cut`].
pub(crate) fn cut_some(
    logs: &[PreparedLog],
    motions: &BTreeMap<String, String>,
    horizon: f64,
    most: usize,
    is_wanted: impl Fn(usize, &str) -> bool,
) -> Result<(MemoryRuns, usize)> {
    let all = windows(logs, Some(horizon), false).windows;
    let count = all.len().min(most);
    if count == 0 {
        return Err(Error::NoWindow { horizon });
    }
    let motion = |index: usize| motions.get(&all[index].motion).unwrap_or(&all[index].motion);
    let is_single = (0..all.len()).all(|index| motion(index) == motion(0));
    let mut runs = MemoryRuns::default();
    let mut names: Vec<String> = Vec::new();
    for index in (0..count).map(|k| k * all.len() / count) {
        let window = &all[index];
        let motion = match is_single {
            true => format!("{} part {}", motion(index), 1 + PARTS * index / all.len()),
            false => motion(index).clone(),
        };
        let number = names.iter().position(|name| *name == motion).unwrap_or_else(|| {
            names.push(motion.clone());
            names.len() - 1
        });
        if is_wanted(number, &window.suite) {
            runs.push(&window.suite, Some(&window.suite), Some(&motion), run(&window.log));
        }
    }
    Ok((runs, names.len()))
}

/// Returns the samples of a window as a recording. Its times are multiples of the sample time to
/// the microsecond, so that all windows share one grid.
fn run(log: &PreparedLog) -> Run {
    let time = |k: usize| (1e6 * k as f64 * log.step).round() / 1e6;
    let states = (0..log.len()).flat_map(|k| [log.q(k), log.qd(k)].concat()).collect();
    let times = (0..log.len()).map(time).collect();
    Run::new(log.joints, times, states, log.tau.clone())
        .expect("a window has one row of finite numbers for each sample")
}
