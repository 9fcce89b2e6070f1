//! Recordings as stretches between samples that are missing or wrong. No filter and no window
//! crosses them.

use std::collections::BTreeMap;
use std::sync::Arc;

use reachtube_finding::Finding;
use reachtube_identify::prepare::{FlawOutcome, LogEntry, RawLog, median_step, shortest};

use crate::code::Code;
use crate::error::{Error, Result};
use crate::findings::warning;
use crate::flaws::first_of;
use crate::plausible::wrong;
use crate::sorted::origins_of;
use crate::windows::Origin;

/// The part of a recording that may be lost between gaps that are close.
const LARGEST_LOST: f64 = 0.5;

/// Samples of which a stretch shows something.
const FEWEST: usize = 16;

/// What stretches are used for.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Use {
    /// Cut-off frequency of the low-pass that takes their ends, Hz; infinite if nothing is
    /// filtered.
    pub cut_off: f64,
    /// Whether a recording counts from its start, so that no later stretch can be used.
    pub from_start: bool,
}

/// Returns the stretches of a recording between the samples that are missing or wrong, those that
/// are long enough. A recording without such samples is one, whatever its length.
pub(crate) fn stretches(log: &RawLog, what: Use) -> Vec<RawLog> {
    let left_out = log.flaws.iter().filter(|flaw| flaw.outcome == FlawOutcome::LeftOut);
    let mut cuts: Vec<f64> = left_out.filter_map(|flaw| flaw.time).collect();
    if cuts.is_empty() {
        return vec![log.clone()];
    }
    cuts.sort_by(f64::total_cmp);
    cuts.dedup();
    let (run, mut from) = (&log.run, 0);
    let mut found = Vec::new();
    for (cut, number) in cuts.iter().chain([&f64::INFINITY]).zip(1..) {
        let until = run.times.partition_point(|time| run.start + time < *cut);
        if until - from >= FEWEST && (number == 1 || !what.from_start) {
            let (name, run) = (format!("{} stretch {number}", log.name), run.only(from..until));
            found.push(RawLog { name, run, ..log.clone() });
        }
        from = until;
    }
    found.retain(|log| log.run.duration() >= needed(log, what)[0]);
    // A flaw is named once.
    found.iter_mut().skip(1).for_each(|log| log.flaws.clear());
    found
}

/// Returns the stretches of recordings as an identification takes them.
pub(crate) fn entries(logs: &[Arc<RawLog>], what: Use) -> Vec<LogEntry> {
    let all = logs.iter().flat_map(|log| stretches(log, what));
    all.map(|log| LogEntry::Recording(Arc::new(log))).collect()
}

/// Returns the duration that a recording needs, s, and the part of it that the filter takes.
fn needed(log: &RawLog, what: Use) -> [f64; 2] {
    shortest(what.cut_off, median_step(&log.run.times).unwrap_or_default())
}

/// Returns the time of a recording that the filter leaves, s, and how much less its stretches have.
fn lost(log: &RawLog, what: Use) -> [f64; 2] {
    let used = |log: &RawLog| (log.run.duration() - needed(log, what)[1]).max(0.0);
    let whole = used(log);
    [whole, whole - stretches(log, what).iter().map(used).sum::<f64>()]
}

/// Checks that most of each recording is used.
///
/// # Errors
///
/// [`Error::Lost`].
pub(crate) fn check_used<'a>(
    logs: impl IntoIterator<Item = &'a RawLog>,
    what: Use,
) -> Result<()> {
    for log in logs {
        let ([duration, lost], flaw) = (lost(log, what), first_of(&log.flaws));
        if !flaw.is_empty() && lost > LARGEST_LOST * duration {
            return Err(Error::Lost { flaw, lost, duration });
        }
    }
    Ok(())
}

/// Returns the warnings about what is left out of some recordings.
pub(crate) fn left_out<'a>(
    logs: impl IntoIterator<Item = &'a RawLog>,
    what: Use,
) -> Vec<Finding> {
    let of_log = |log: &RawLog| {
        let first = Some(first_of(&log.flaws)).filter(|first| !first.is_empty())?;
        let ([_, lost], duration) = (lost(log, what), log.run.duration());
        let text = format!(
            "{first}: it is not filled and no window crosses it, so that {lost:.1} s of \
             {duration:.1} s are not used"
        );
        let place = first.split(": ").next().map(String::from);
        let numbers = [("unused".to_string(), lost)].into();
        Some(Finding { place, numbers, ..warning(Code::MissingSamples, &text) })
    };
    logs.into_iter().filter_map(of_log).collect()
}

/// Returns the stretches of recordings, with the log of each by its name, and notes about what is
/// left out.
///
/// # Errors
///
/// As [`check_used`].
pub(crate) fn in_stretches(
    raw: &[RawLog],
    what: Use,
) -> Result<(Vec<RawLog>, BTreeMap<String, Origin>, Vec<String>)> {
    check_used(raw, what)?;
    let (mut logs, mut origins) = (Vec::new(), BTreeMap::new());
    let whole = origins_of(raw);
    for log in raw {
        for stretch in stretches(log, what) {
            origins.insert(stretch.name.clone(), whole[&log.name].clone());
            logs.push(stretch);
        }
    }
    let wrong = wrong(&raw.iter().collect::<Vec<_>>());
    let notes = left_out(raw, what).into_iter().chain(wrong).map(|finding| finding.text);
    Ok((logs, origins, notes.collect()))
}
