//! Logs cut into runs.

use std::ops::Range;

use crate::error::{Error, Result};
use crate::log::Log;
use crate::message::SECOND;

/// Shortest rest between two motions, ns. At a reversal, joints are slow for a shorter time.
const REST: i64 = SECOND / 2;

/// Shortest motion, ns. Noise is shorter.
const SHORTEST: i64 = SECOND / 5;

/// Time before and after a motion that its run includes, ns.
const MARGIN: i64 = SECOND / 10;

/// A run in a log.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Cut {
    /// Number of the log, from 0.
    pub log: usize,
    /// Its samples in the log.
    pub samples: Range<usize>,
    /// The test suite, where the run belongs to one.
    pub suite: Option<String>,
    /// The motion that the suite is part of, if it is known.
    pub motion: Option<String>,
}

impl Cut {
    /// Returns a run without suite and motion.
    pub(crate) fn new(log: usize, samples: Range<usize>) -> Self {
        Self { log, samples, suite: None, motion: None }
    }
}

/// How logs are cut into runs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Cutting {
    /// Each log is one run.
    Whole,
    /// The topic of markers marks runs, by the times at which the log received messages. A marker
    /// that is not empty, true or not 0 starts a run, which lasts until a marker of another value.
    /// Its text, or its number, is the suite's name; a Bool gives none.
    Marked,
    /// Each motion is a run: from 0.1 s before a joint is at least as fast as this, rad/s or m/s,
    /// until 0.1 s after all joints have become slower for 0.5 s. Motions shorter than 0.2 s are
    /// left out.
    Motions(f64),
}

impl Cutting {
    /// Returns the runs in logs; [`Intervals`](crate::Intervals) cut them by a list.
    ///
    /// # Errors
    ///
    /// [`Error::NoRun`] where no sample is in a marked run, or nothing moves.
    pub fn runs(self, logs: &[Log]) -> Result<Vec<Cut>> {
        match self {
            Self::Whole => Ok(whole_logs(logs)),
            Self::Marked => marked_runs(logs),
            Self::Motions(rest_speed) => motions(logs, rest_speed),
        }
    }
}

fn whole_logs(logs: &[Log]) -> Vec<Cut> {
    let whole = |(log, samples): (usize, &Log)| Cut::new(log, 0..samples.len());
    logs.iter().enumerate().filter(|(_, log)| log.len() > 0).map(whole).collect()
}

fn marked_runs(logs: &[Log]) -> Result<Vec<Cut>> {
    let mut cuts = vec![];
    for (number, log) in logs.iter().enumerate() {
        let mut markers = log.markers.iter().collect::<Vec<_>>();
        markers.sort_by_key(|marker| marker.received);
        // A marker that is repeated does not start another run.
        markers.dedup_by(|next, before| next.suite == before.suite);
        let from = |time: i64| log.samples.partition_point(|sample| sample.received < time);
        for (index, marker) in markers.iter().enumerate() {
            let Some(suite) = &marker.suite else { continue };
            let end = markers.get(index + 1).map_or(log.len(), |next| from(next.received));
            let samples = from(marker.received)..end;
            if !samples.is_empty() {
                let suite = Some(suite.clone()).filter(|suite| !suite.is_empty());
                cuts.push(Cut { suite, ..Cut::new(number, samples) });
            }
        }
    }
    if cuts.is_empty() {
        let problem = "the topic of markers marks no sample; a marker must be published before \
                       each run and an empty, false or zero one after it";
        return Err(Error::NoRun(problem.into()));
    }
    Ok(cuts)
}

fn motions(logs: &[Log], rest_speed: f64) -> Result<Vec<Cut>> {
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
