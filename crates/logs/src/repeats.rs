//! Runs that repeat one motion, found by their starts and their velocities.

use schemars::JsonSchema;
use serde::Serialize;

use crate::cut::Cut;
use crate::log::Log;

/// Largest difference of a joint's first position from the first position of the suite's first run,
/// rad or m.
const START: f64 = 0.05;

/// Lowest correlation with the suite's first run.
const CORRELATION: f64 = 0.95;

/// Longest lag that is tried, s.
const LAG: f64 = 0.2;

/// Largest relative difference of the mean time between samples, and of the duration.
const STEP: f64 = 0.01;
const DURATION: f64 = 0.1;

/// A test suite of runs that repeat one motion.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct Repeats {
    /// The suite's name.
    pub suite: String,
    /// Number of runs.
    pub runs: usize,
    /// Lowest correlation of a run's velocities with the velocities of the first run: 2 a·b / (a·a
    /// + b·b) over all joints and samples, which is 1 only for equal velocities.
    pub correlation: f64,
    /// Largest difference of a joint's first position from the first position of the first run, rad
    /// or m.
    pub start_spread: f64,
    /// Largest lag behind the first run at which velocities correlate best, s.
    pub lag: f64,
}

/// A suite while runs are added to it.
struct RepeatGroup {
    /// Indices of its runs.
    members: Vec<usize>,
    found: Repeats,
}

/// How well a run repeats another.
struct Likeness {
    correlation: f64,
    start: f64,
    /// Lag in samples.
    lag: isize,
    step: f64,
}

/// Groups the runs that have no suite yet: runs that start within 0.05 rad or m of the first run of
/// a suite and whose velocities correlate with it to 0.95 or more become one suite. Runs that
/// nothing repeats get none. With `align`, a run moves in its log by its lag.
///
/// Returns what was found, in the order of the suites' first runs.
pub fn find_repeats(logs: &[Log], cuts: &mut [Cut], align: bool) -> Vec<Repeats> {
    let mut groups: Vec<RepeatGroup> = vec![];
    for index in (0..cuts.len()).filter(|index| cuts[*index].suite.is_none()).collect::<Vec<_>>() {
        let best = groups
            .iter()
            .enumerate()
            .filter_map(|(number, group)| {
                let likeness = likeness(logs, &cuts[group.members[0]], &cuts[index])?;
                (likeness.correlation >= CORRELATION).then_some((number, likeness))
            })
            .max_by(|(_, a), (_, b)| a.correlation.total_cmp(&b.correlation));
        match best {
            Some((number, likeness)) => {
                if align {
                    shift(logs, &mut cuts[index], likeness.lag);
                }
                groups[number].add(index, &likeness);
            }
            None => groups.push(RepeatGroup::new(index)),
        }
    }
    groups.retain(|group| group.members.len() > 1);
    for (number, group) in groups.iter_mut().enumerate() {
        group.found.suite = format!("repeat_{}", number + 1);
        for member in &group.members {
            cuts[*member].suite = Some(group.found.suite.clone());
        }
    }
    groups.into_iter().map(|group| group.found).collect()
}

impl RepeatGroup {
    fn new(index: usize) -> Self {
        let suite = String::new();
        let found = Repeats { suite, runs: 1, correlation: 1.0, start_spread: 0.0, lag: 0.0 };
        Self { members: vec![index], found }
    }

    fn add(&mut self, index: usize, likeness: &Likeness) {
        self.members.push(index);
        self.found.runs += 1;
        self.found.correlation = self.found.correlation.min(likeness.correlation);
        self.found.start_spread = self.found.start_spread.max(likeness.start);
        let lag = likeness.lag.unsigned_abs() as f64 * likeness.step;
        self.found.lag = self.found.lag.max(lag);
    }
}

/// Moves a run in its log by some samples, as far as the log goes.
fn shift(logs: &[Log], cut: &mut Cut, lag: isize) {
    let length = cut.samples.len();
    let latest = logs[cut.log].len() - length;
    let start = cut.samples.start.saturating_add_signed(lag).min(latest);
    cut.samples = start..start + length;
}

/// Compares a run with the first one of a suite; `None` if they start at different places or differ
/// in duration or sample time.
fn likeness(logs: &[Log], first: &Cut, run: &Cut) -> Option<Likeness> {
    let (a, b) = (&logs[first.log], &logs[run.log]);
    let (q_a, q_b) = (a.part(first.samples.start, 0), b.part(run.samples.start, 0));
    let start = q_a.iter().zip(q_b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    let [duration_a, duration_b] = [duration(a, first)?, duration(b, run)?];
    let steps = |cut: &Cut| (cut.samples.len() - 1) as f64;
    let (step_a, step_b) = (duration_a / steps(first), duration_b / steps(run));
    let near = |a: f64, b: f64, tolerance: f64| (a - b).abs() <= tolerance * a;
    let alike = start <= START && near(duration_a, duration_b, DURATION);
    if !alike || !near(step_a, step_b, STEP) {
        return None;
    }
    let most = (LAG / step_a) as isize;
    let correlate = |lag: isize| (correlation((a, first), (b, run), lag), lag);
    // The shortest lag wins among equal correlations.
    let (correlation, lag) = (-most..=most)
        .map(correlate)
        .max_by(|x, y| x.0.total_cmp(&y.0).then(y.1.abs().cmp(&x.1.abs())))?;
    Some(Likeness { correlation, start, lag, step: step_a })
}

/// Returns the time from the first to the last sample of a run, s, above 0.
fn duration(log: &Log, cut: &Cut) -> Option<f64> {
    let [first, last] = [cut.samples.start, cut.samples.end - 1].map(|k| log.samples[k].time);
    let seconds = last.saturating_sub(first) as f64 / 1e9;
    (seconds > 0.0).then_some(seconds)
}

/// Returns the correlation of the velocities of two runs, the second taken `lag` samples later.
fn correlation(a: (&Log, &Cut), b: (&Log, &Cut), lag: isize) -> f64 {
    let (mut cross, mut squares) = (0.0, 0.0);
    for k in 0..a.1.samples.len() {
        let Some(other) = k.checked_add_signed(lag).filter(|other| *other < b.1.samples.len())
        else {
            continue;
        };
        let qd_a = a.0.part(a.1.samples.start + k, 1);
        let qd_b = b.0.part(b.1.samples.start + other, 1);
        for (a, b) in qd_a.iter().zip(qd_b) {
            cross += a * b;
            squares += a * a + b * b;
        }
    }
    if squares > 0.0 { 2.0 * cross / squares } else { 0.0 }
}
