//! Recordings beside the box over which what the model leaves out was bounded.

use super::{Recordings, Settings, Suite};
use crate::error::{Error, Result};
use reachtube_abstraction::OperatingBox;
use reachtube_recordings::{DataSet, state_name};

/// The side of the box for state `i`, q then q̇.
fn side(operating_box: &OperatingBox, i: usize) -> [f64; 2] {
    let n = operating_box.q.len();
    if i < n { operating_box.q[i] } else { operating_box.qd[i - n] }
}

/// Refuses recordings that start outside the box: an initial set that holds them would. Without a
/// box there is nothing to refuse.
///
/// # Errors
///
/// [`Error::Setting`] with the run, the state and the remedy.
pub(super) fn check_starts(
    data: &DataSet,
    settings: &Settings,
    recordings: &Recordings,
) -> Result<()> {
    let Some(operating_box) = &settings.operating_box else { return Ok(()) };
    for run in recordings.suites.iter().flat_map(|suite| &suite.runs) {
        for (i, x) in run.start.iter().enumerate() {
            let [low, high] = side(operating_box, i);
            if !(low..=high).contains(x) {
                return Err(Error::Setting(format!(
                    "{}: {} starts at {x}, outside the box [{low}, {high}] over which what the model leaves out was bounded; give `abstract` a larger --box, or another --at",
                    data.runs()[run.index].file,
                    state_name(i, run.start.len() / 2)
                )));
            }
        }
    }
    Ok(())
}

/// For each suite that leaves the box, where it does first, in words.
pub(super) fn notes(settings: &Settings, recordings: &Recordings) -> Vec<String> {
    let Some(operating_box) = &settings.operating_box else { return Vec::new() };
    let leaves = |suite: &Suite| {
        let envelope = &suite.envelope;
        let states = envelope.dimension();
        let outside = |k: usize, i: usize| {
            let [low, high] = side(operating_box, i);
            envelope.upper(k, i) > high || envelope.lower(k, i) < low
        };
        let mut places = (0..envelope.len()).flat_map(|k| (0..states).map(move |i| (k, i)));
        let (k, i) = places.find(|&(k, i)| outside(k, i))?;
        Some(format!(
            "suite {}: {} leaves the box at sample {k}; what the model leaves out was not bounded there, and is covered as far as these recordings show it",
            suite.entry.name,
            state_name(i, states / 2)
        ))
    };
    recordings.suites.iter().filter_map(leaves).collect()
}
