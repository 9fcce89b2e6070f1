//! `reachtube monitor` of an arm under its controller.

use reachtube::finding::Table;
use reachtube::number::{at_least, counted};
use reachtube::tracking::{JudgedSample, TrackingModel, TrackingMonitor};
use reachtube_files::SealedFile;
use schemars::JsonSchema;
use serde::Serialize;

use crate::commands::monitor::arguments::Arguments;
use crate::commands::monitor::events::line;
use crate::commands::monitor::lines::{follow, wrong};
use crate::commands::monitor::samples::{Kinds, Sample, Samples};
use crate::error::{Error, Result};
use crate::outcome::Outcome;
use crate::output;

/// What samples have: commanded and actual positions.
const KINDS: Kinds = &["r", "q"];

/// One line of `monitor --json` of an arm under its controller.
#[derive(Serialize, JsonSchema)]
#[serde(tag = "event", rename_all = "lowercase")]
pub(crate) enum TrackingEvent<'a> {
    /// The first of samples that follow each other outside the sets.
    Left {
        /// Its time, s.
        time: f64,
        /// The joint that needs the most of its set.
        joint: &'a str,
        /// The part of its set that it needs.
        needed: f64,
    },
    /// A command that is faster than the recorded ones, for the first time of each joint.
    Fast {
        /// Its time, s.
        time: f64,
        /// The joint.
        joint: &'a str,
    },
    /// The summary.
    Summary {
        /// Why the monitor ended: "end of input", "interrupt" or "error".
        ended: &'a str,
        /// Samples that were judged.
        samples: usize,
        /// Samples outside the sets.
        outside: usize,
        /// Gaps between samples, after which it began anew.
        gaps: usize,
        /// The largest part of its set that each joint needed.
        largest: &'a [f64],
    },
}

/// What was printed of the samples so far.
struct ArmWatch {
    json: bool,
    monitor: TrackingMonitor,
    samples: Samples,
    is_outside: bool,
    was_fast: Vec<bool>,
}

pub(super) fn run(args: &Arguments, json: bool) -> Result<Outcome> {
    let Arguments { step, horizon, every, max_gap, healthy, gauge_every, differentiate, .. } = args;
    let seconds = [step, horizon, every, max_gap, gauge_every];
    if seconds.iter().any(|of| of.is_some()) || healthy.is_some() || *differentiate {
        return Err(Error::setting(
            "the model is of an arm under its controller, whose samples are judged one by one; \
             leave all options but --model out",
        ));
    }
    let monitor = TrackingMonitor::new(TrackingModel::open(&args.model)?);
    let joints = monitor.model().joints.len();
    let (samples, was_fast) = (Samples::new(joints, KINDS), vec![false; joints]);
    let mut watch = ArmWatch { json, monitor, samples, is_outside: false, was_fast };
    let ended = follow(|number, line| watch.take(number, line));
    let mut last = None;
    watch.monitor.finish(|judged| last = Some(judged));
    last.map_or(Ok(()), |judged| watch.print(judged))?;
    let words = ended.as_ref().copied().unwrap_or("error");
    let [samples, outside, _] = watch.monitor.counts();
    if samples == 0 {
        return ended.and(Err(wrong(1, "no sample was judged; give 3 at least")));
    }
    watch.summary(words)?;
    ended.map(|_| Outcome::of(outside == 0))
}

impl ArmWatch {
    fn take(&mut self, number: u64, line: &str) -> Result<()> {
        let joints = self.was_fast.len();
        let read = self.samples.read(line).map_err(|problem| wrong(number, &problem))?;
        let Some(sample) = read else { return Ok(()) };
        let Sample { t, parts } = sample;
        let numbers = parts.iter().flatten().chain([&t]);
        if parts.iter().any(|part| part.len() != joints) || !numbers.copied().all(f64::is_finite) {
            let problem = format!("give t and {joints} finite numbers of r and of q");
            return Err(wrong(number, &problem));
        }
        let mut found = [None; 3];
        let mut count = 0;
        self.monitor.push(t, [&parts[0], &parts[1]], |judged| {
            found[count] = Some(judged);
            count += 1;
        });
        found.into_iter().flatten().try_for_each(|judged| self.print(judged))
    }

    /// Prints what is new of a sample.
    fn print(&mut self, judged: JudgedSample) -> Result<()> {
        let JudgedSample { time, needed, joint, too_fast } = judged;
        let name = |joint: usize| self.monitor.model().joints[joint].name.as_str();
        let is_new = needed > 1.0 && !self.is_outside;
        self.is_outside = needed > 1.0;
        if is_new {
            let joint = name(joint);
            match self.json {
                true => line(&TrackingEvent::Left { time, joint, needed })?,
                false => output::print(&format!(
                    "{time:.4} s: {joint} leaves its set: it needs {} times the set\n",
                    at_least(needed)
                ))?,
            }
        }
        if let Some(joint) = too_fast.filter(|joint| !self.was_fast[*joint]) {
            match self.json {
                true => line(&TrackingEvent::Fast { time, joint: name(joint) })?,
                false => output::print(&format!(
                    "{time:.4} s: the command of {} is faster than the recorded ones, and the \
                     sets are not for it\n",
                    name(joint)
                ))?,
            }
            self.was_fast[joint] = true;
        }
        Ok(())
    }

    fn summary(&self, ended: &str) -> Result<()> {
        let ([samples, outside, gaps], largest) = (self.monitor.counts(), self.monitor.largest());
        if self.json {
            return line(&TrackingEvent::Summary { ended, samples, outside, gaps, largest });
        }
        let word = if outside == 0 { "inside" } else { "NOT inside" };
        let gaps = match gaps {
            0 => String::new(),
            gaps => format!("; {}, after which it began anew", counted(gaps, "gap")),
        };
        let row = |(joint, needed): (&str, &f64)| vec![joint.into(), at_least(*needed)];
        let names = self.monitor.model().joints.iter().map(|joint| joint.name.as_str());
        let rows = names.zip(largest).map(row).collect();
        output::print(&format!(
            "{word}: {outside} of {samples} samples outside the sets{gaps}\n{}",
            Table::new(["joint", "largest part of its set"], rows)
        ))
    }
}
