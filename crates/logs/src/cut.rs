//! Logs cut into runs: whole, or by markers.

use std::ops::Range;

use crate::error::{Error, Result};
use crate::log::Log;

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

/// Returns one run for each log.
#[must_use]
pub fn whole_logs(logs: &[Log]) -> Vec<Cut> {
    let whole = |(log, samples): (usize, &Log)| Cut::new(log, 0..samples.len());
    logs.iter().enumerate().filter(|(_, log)| !log.is_empty()).map(whole).collect()
}

/// Returns the runs that the topic of markers marks, by the times at which the log received
/// messages.
///
/// A marker that is not empty, true or not 0 starts a run, which lasts until a marker of another
/// value. Its text, or its number, is the suite's name; a Bool gives none.
///
/// # Errors
///
/// [`Error::NoRun`] where no sample is in a marked run.
pub fn marked_runs(logs: &[Log]) -> Result<Vec<Cut>> {
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
