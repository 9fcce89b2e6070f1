//! Samples of recordings that are missing or wrong.

use std::cell::OnceCell;
use std::collections::BTreeSet;

use reachtube_diagnose::{WrongSamples, wrong_samples};
use reachtube_identify::prepare::{Flaw, FlawOutcome, RawLog, median_step};
use reachtube_recordings::GapLimit;
use reachtube_robot::Robot;

use crate::error::{Error, Result};

/// The part of a recording that may be missing.
const LARGEST_MISSING: f64 = 0.1;

/// The part of a recording's samples that is left out if it is wrong; of more, something else is
/// wrong.
const FEW: f64 = 0.03;

/// Samples to both sides of what is missing or wrong that are left out with it: velocities that are
/// derived from positions need the samples beside them.
const BESIDE: usize = 1;

/// Looks for samples that are missing, which make a gap, or wrong, and leaves a few wrong ones out.
///
/// # Errors
///
/// [`Error::Lost`] if much is missing.
pub(crate) fn find_flaws(log: &mut RawLog, robot: &Robot) -> Result<()> {
    let steps: Vec<f64> = log.run.times.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let longest = GapLimit::Usual.longest_step(steps.clone());
    let usual = median_step(&log.run.times).unwrap_or_default();
    let wrong = wrong_samples(&log.run);
    let rows: BTreeSet<usize> =
        wrong.iter().flat_map(|wrong| wrong.rows.iter().cloned().flatten()).collect();
    let is_few = rows.len() as f64 <= FEW * log.run.len() as f64;
    let mut kept = vec![true; log.run.len()];
    let leave_out = |kept: &mut [bool], from: usize, until: usize| {
        kept[from.saturating_sub(BESIDE)..(until + BESIDE).min(log.run.len())].fill(false);
    };
    let (mut flaws, places) = (Vec::new(), Places::of(log));
    for wrong in &wrong {
        let outcome = match (is_few, &wrong.rows[..], wrong.is_certain) {
            (true, [_, ..], _) => FlawOutcome::LeftOut,
            (.., true) => FlawOutcome::Contradiction,
            (.., false) => FlawOutcome::Named,
        };
        match outcome {
            FlawOutcome::LeftOut => {
                for rows in &wrong.rows {
                    leave_out(&mut kept, rows.start, rows.end);
                    flaws.push(described(robot, &places, wrong, Some(rows.start), outcome));
                }
            }
            _ => flaws.push(described(robot, &places, wrong, wrong.sample, outcome)),
        }
    }
    let mut missing = 0.0;
    for (before, step) in steps.iter().enumerate().filter(|(_, step)| **step > longest) {
        leave_out(&mut kept, before + 1, before + 1);
        flaws.push(gap(&places, before + 1, step - usual));
        missing += step - usual;
    }
    if missing > LARGEST_MISSING * log.run.duration() {
        let (flaw, duration) = (first_of(&flaws), log.run.duration());
        return Err(Error::Lost { flaw, lost: missing, duration });
    }
    if kept.contains(&false) {
        log.run = log.run.only((0..kept.len()).filter(|k| kept[*k]));
    }
    log.flaws = flaws;
    Ok(())
}

/// Describes samples that are wrong; a sample of them is at `sample`.
fn described(
    robot: &Robot,
    places: &Places,
    wrong: &WrongSamples,
    sample: Option<usize>,
    outcome: FlawOutcome,
) -> Flaw {
    let joint = wrong.joint.map(|joint| &*robot.joints()[joint].name);
    let (log, place) = (places.log, places.place(sample));
    let since = sample.map(|sample| log.run.times[sample]);
    let at = since.map(|time| format!(" at {time:.3} s")).unwrap_or_default();
    let subject = joint.unwrap_or("the sample");
    let text = match sample {
        Some(_) => format!("{place}: {subject}{at} {}", wrong.text),
        None => format!("{place}: the samples {}", wrong.text),
    };
    Flaw { time: since.map(|time| log.run.start + time), place, text, outcome }
}

/// Describes a gap before `sample`, in which samples of some time, s, are missing.
fn gap(places: &Places, sample: usize, missing: f64) -> Flaw {
    let log = places.log;
    let [before, after] = [log.run.times[sample - 1], log.run.times[sample]];
    let place = places.place(Some(sample));
    let text =
        format!("{place}: {:.0} ms of samples are missing before {after:.3} s", 1e3 * missing);
    let time = Some(log.run.start + 0.5 * (before + after));
    Flaw { time, place, text, outcome: FlawOutcome::LeftOut }
}

/// Returns the first of some flaws that are left out, with the number of the others.
pub(crate) fn first_of(flaws: &[Flaw]) -> String {
    let left_out = flaws.iter().filter(|flaw| flaw.outcome == FlawOutcome::LeftOut);
    let mut left_out: Vec<&Flaw> = left_out.collect();
    left_out.sort_by(|a, b| a.time.partial_cmp(&b.time).unwrap_or(std::cmp::Ordering::Equal));
    left_out.dedup_by(|a, b| a.time == b.time);
    match left_out[..] {
        [] => String::new(),
        [only] => only.text.clone(),
        [first, ..] => format!("{} (the first of {} places)", first.text, left_out.len()),
    }
}

/// The file of a log, and the lines of its samples, which are read once if they are asked for.
struct Places<'a> {
    log: &'a RawLog,
    lines: OnceCell<Vec<usize>>,
}

impl<'a> Places<'a> {
    fn of(log: &'a RawLog) -> Self {
        Self { log, lines: OnceCell::new() }
    }

    /// Returns the file, with the line of a sample where the lines below a header are the samples.
    fn place(&self, sample: Option<usize>) -> String {
        let log = self.log;
        let file = log.file.file_name();
        let file = file.map_or_else(|| log.name.clone(), |name| name.to_string_lossy().into());
        match sample.and_then(|sample| self.lines.get_or_init(|| lines(log)).get(sample)) {
            Some(line) => format!("{file}:{line}"),
            None => file,
        }
    }
}

/// Returns the line of each sample, from 1; none for a file in which lines are no samples.
fn lines(log: &RawLog) -> Vec<usize> {
    let text = std::fs::read_to_string(&log.file).unwrap_or_default();
    let lines = text.lines().zip(1..).filter(|(line, _)| !line.trim().is_empty());
    let lines: Vec<usize> = lines.map(|(_, number)| number).collect();
    let header = lines.len().checked_sub(log.run.len());
    header.map_or_else(Vec::new, |header| lines[header..].to_vec())
}
