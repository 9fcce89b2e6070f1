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

/// Returns the stretches of a recording between the samples that are missing or wrong, if
/// they are long enough. A recording without such samples is one, whatever its length.
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
pub(crate) fn check_used<'a>(logs: impl IntoIterator<Item = &'a RawLog>, what: Use) -> Result<()> {
    for log in logs {
        let ([duration, lost], flaw) = (lost(log, what), first_of(&log.flaws));
        if !flaw.is_empty() && lost > LARGEST_LOST * duration {
            return Err(Error::Lost { flaw, lost, duration });
        }
    }
    Ok(())
}

/// Returns the warnings about what is left out of some recordings.
pub(crate) fn left_out<'a>(logs: impl IntoIterator<Item = &'a RawLog>, what: Use) -> Vec<Finding> {
    let of_log = |log: &RawLog| {
        let first = Some(first_of(&log.flaws)).filter(|first| !first.is_empty())?;
        let ([_, lost], duration) = (lost(log, what), log.run.duration());
        let text = format!(
            "{first}: nothing is filled and no window crosses it, so that {lost:.1} s of \
             {duration:.1} s are not used"
        );
        let place = first.split(": ").next().map(String::from);
        let numbers = [("unused".to_string(), lost)].into();
        Some(Finding { place, numbers, ..warning(Code::MissingSamples, &text) })
    };
    logs.into_iter().filter_map(of_log).collect()
}

/// Stretches of recordings, the log of each by its name, and notes about what is left out.
pub(crate) type InStretches = (Vec<RawLog>, BTreeMap<String, Origin>, Vec<String>);

/// Returns the stretches of recordings, with the log of each by its name as in `whole`, and notes
/// about what is left out.
///
/// # Errors
///
/// As [`check_used`].
pub(crate) fn in_stretches(
    raw: &[RawLog],
    whole: &BTreeMap<String, Origin>,
    what: Use,
) -> Result<InStretches> {
    check_used(raw, what)?;
    let (mut logs, mut origins) = (Vec::new(), BTreeMap::new());
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

#[cfg(test)]
mod tests {
    use reachtube_recordings::Run;

    use super::*;
    use crate::flaws::find_flaws;
    use crate::pendulum::pendulum;

    /// Returns a log of 20 s at 100 Hz without some of its samples.
    fn log(is_lost: impl Fn(usize) -> bool) -> RawLog {
        let times: Vec<f64> =
            (0..2001).filter(|k| !is_lost(*k)).map(|k| 5.0 + 0.01 * k as f64).collect();
        let states = times.iter().flat_map(|t| [t.sin(), t.cos()]).collect();
        let torques = vec![0.0; times.len()];
        let run = Run::new(1, times, states, torques).unwrap().with_digest();
        let (motion, order) = (Some("m".to_string()), Some(3));
        let mut log = RawLog { motion, order, ..RawLog::new("a", "a.csv", run) };
        find_flaws(&mut log, &pendulum()).unwrap();
        log
    }

    const FILTERED: Use = Use { cut_off: 3.0, from_start: false };
    const FROM_START: Use = Use { cut_off: f64::INFINITY, from_start: true };

    fn of(log: &RawLog, what: Use) -> Vec<(String, [f64; 2])> {
        let found = stretches(log, what).into_iter();
        let rounded = |time: f64| (1e3 * time).round() / 1e3;
        let ends = |run: &Run| [run.start, run.start + run.duration()].map(rounded);
        found.map(|stretch| (stretch.name.clone(), ends(&stretch.run))).collect()
    }

    #[test]
    fn a_recording_is_cut_at_its_gaps_and_stays_one_motion() {
        let whole = log(|_| false);
        assert_eq!(stretches(&whole, FILTERED), [whole]);
        let cut = log(|k| (500..520).contains(&k) || k == 1500);
        let names = |number: usize| format!("a stretch {number}");
        let ends = [[5.0, 9.98], [10.21, 19.98], [20.02, 25.0]];
        let all: Vec<_> = (1..).map(names).zip(ends).collect();
        assert_eq!(of(&cut, FILTERED), all);
        for stretch in stretches(&cut, FILTERED) {
            assert_eq!((stretch.run.sha256, stretch.motion, stretch.order), {
                (cut.run.sha256.clone(), Some("m".into()), Some(3))
            });
        }
        // Inputs that count from the start of the motion have no later start.
        assert_eq!(of(&cut, FROM_START), all[..1]);
        // The low-pass takes 1.67 s, and a motion that lost its beginning has no start.
        let [soon, at_once] = [log(|k| k == 100), log(|k| k == 1)];
        assert_eq!(of(&soon, FILTERED), [("a stretch 2".to_string(), [6.02, 25.0])]);
        assert_eq!(of(&at_once, FROM_START), []);
    }

    #[test]
    fn what_is_lost_is_counted_and_most_of_a_recording_is_refused() {
        let cut = log(|k| (500..520).contains(&k));
        let text = left_out([&cut], FILTERED).remove(0).text;
        let words = "a.csv: 200 ms of samples are missing before 5.200 s: nothing is filled and no \
                     window crosses it, so that 1.9 s of 20.0 s are not used.";
        assert_eq!(text, words);
        assert!(check_used([&cut], FILTERED).is_ok());
        let sieve = log(|k| k % 100 == 99);
        assert_eq!(of(&sieve, FILTERED), []);
        let refused = check_used([&sieve], FILTERED).unwrap_err().to_string();
        assert!(refused.contains("(the first of 20 places); so much"), "{refused}");
    }
}
