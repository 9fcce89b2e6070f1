//! Logs cut into motions, between the times at which the robot rests.

use crate::cut::Cut;
use crate::error::{Error, Result};
use crate::log::Log;
use crate::message::SECOND;

/// Shortest rest between two motions, ns. At a reversal, joints are slow for a shorter time.
const REST: i64 = SECOND / 2;

/// Shortest motion, ns. Noise is shorter.
const SHORTEST: i64 = SECOND / 5;

/// Time before and after a motion that its run includes, ns.
const MARGIN: i64 = SECOND / 10;

/// Returns one run for each motion: from 0.1 s before a joint is at least as fast as `rest_speed`,
/// rad/s or m/s, until 0.1 s after all joints have become slower for 0.5 s. Motions shorter than
/// 0.2 s are left out.
///
/// # Errors
///
/// [`Error::NoRun`] where nothing moves.
pub fn motions(logs: &[Log], rest_speed: f64) -> Result<Vec<Cut>> {
    let in_log = |(number, log): (usize, &Log)| {
        let cut = move |[first, last]: [usize; 2]| {
            let from = log.samples[first].time.saturating_sub(MARGIN);
            let until = log.samples[last].time.saturating_add(MARGIN);
            let before = log.samples[..first].iter().rev().take_while(|s| s.time >= from).count();
            let after = log.samples[last + 1..].iter().take_while(|s| s.time <= until).count();
            Cut::new(number, first - before..last + 1 + after)
        };
        stretches(log, rest_speed).into_iter().map(cut).collect::<Vec<_>>()
    };
    let cuts: Vec<Cut> = logs.iter().enumerate().flat_map(in_log).collect();
    if cuts.is_empty() {
        return Err(Error::NoRun(format!(
            "no joint is as fast as {rest_speed} rad/s or m/s for {} s; give a lower --rest-speed",
            SHORTEST as f64 / SECOND as f64
        )));
    }
    Ok(cuts)
}

/// Returns the first and the last moving sample of each motion.
fn stretches(log: &Log, rest_speed: f64) -> Vec<[usize; 2]> {
    let moves = |index: &usize| log.part(*index, 1).iter().any(|qd| qd.abs() >= rest_speed);
    let time = |index: usize| log.samples[index].time;
    let mut found: Vec<[usize; 2]> = vec![];
    for index in (0..log.len()).filter(moves) {
        match found.last_mut() {
            Some([_, last]) if time(index).saturating_sub(time(*last)) < REST => *last = index,
            _ => found.push([index; 2]),
        }
    }
    found.retain(|[first, last]| time(*last).saturating_sub(time(*first)) >= SHORTEST);
    found
}
