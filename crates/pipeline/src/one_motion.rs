//! Recordings that belong to one motion by their content: they share samples, or one goes on where
//! another ends.

use std::collections::{BTreeMap, BTreeSet};

use reachtube_identify::prepare::RawLog;
use reachtube_recordings::{Run, TimeShift};

/// Most samples that are compared; of more, some are drawn by their content.
const MOST_ROWS: usize = 1_000_000;

/// Most recordings with one sample that are compared with each other.
const MOST_EQUAL: usize = 8;

/// A recording may go on after this many sample times of another, or before its end.
const LATEST: f64 = 10.0;
const EARLIEST: f64 = -3.0;

/// Number of sample times at an end which show how much a state changes within one.
const NEAR: usize = 10;

/// A state goes on if it changes at most this many times as much as near the ends.
const LARGEST_CHANGE: f64 = 5.0;

/// A joint moves at an end if it is faster than this part of the speed at which samples count.
const SLOW: f64 = 0.2;

/// States of recordings on different clocks go on if it would be rarer than this by chance.
const CHANCE: f64 = 1e-3;

/// Two recordings that belong to one motion: `later` shares samples with `first`, or goes on where
/// it ends.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Join {
    pub first: usize,
    pub later: usize,
    /// How many samples are equal; `None` if one recording goes on.
    pub equal: Option<usize>,
}

/// Returns which recordings belong to one motion by their content.
///
/// - They share samples if equal ones, rounded to 1e-5 rad and 1e-3 N m, lie at one shift of the
///   time. A copy without some samples, a thinned or trimmed one, one that was resampled through
///   its samples, and recordings that overlap are found so. Samples at rest are not compared.
/// - One goes on where another ends if its clock does, and its state; or if its state alone does
///   while the robot moves. If both name their motions, the robot has to move there in any case.
pub(crate) fn links(logs: &[&RawLog]) -> Vec<Join> {
    let mut links = sharing(&logs.iter().map(|log| &log.run).collect::<Vec<_>>());
    let ends: Vec<Option<Ends>> = logs.iter().map(|log| Ends::of(&log.run)).collect();
    let pairs = (logs.len() * logs.len()) as f64;
    for (first, before) in ends.iter().enumerate() {
        for (later, after) in ends.iter().enumerate().filter(|(later, _)| *later != first) {
            let (Some(before), Some(after)) = (before, after) else { continue };
            let are_named = logs[first].motion.is_some() && logs[later].motion.is_some();
            if after.goes_on_after(before, are_named, pairs) {
                links.push(Join { first, later, equal: None });
            }
        }
    }
    links
}

/// Returns a note about recordings that go on where another ends, and one about recordings that
/// share samples, if there are any.
pub(crate) fn link_notes(logs: &[&RawLog], links: &[Join]) -> [Option<String>; 2] {
    let goes_on = joined(links, |link| link.equal.is_none()).map(|(count, link)| {
        let [first, later] = [link.first, link.later].map(|index| logs[index].file.display());
        format!(
            "{count} recordings go on where another ends, and count as one motion: for example, \
             {later} goes on where {first} ends; for motions that are independent, begin each at \
             rest, and begin its log with it"
        )
    });
    let shares = joined(links, |link| link.equal.is_some()).map(|(count, link)| {
        let [first, later] = [link.first, link.later].map(|index| logs[index].file.display());
        let equal = link.equal.unwrap_or_default();
        format!(
            "{count} recordings share samples, and count as one motion: for example, {later} has \
             {equal} samples of {first}; remove copies"
        )
    });
    [goes_on, shares]
}

/// Returns how many recordings such links join, and the first of these links.
fn joined(links: &[Join], is_such: impl Fn(&Join) -> bool) -> Option<(usize, Join)> {
    let such = || links.iter().filter(|link| is_such(link));
    let joined: BTreeSet<usize> = such().flat_map(|link| [link.first, link.later]).collect();
    Some((joined.len(), *such().next()?))
}

/// Returns which runs share samples.
fn sharing(runs: &[&Run]) -> Vec<Join> {
    let mut rows: Vec<(u64, usize, usize)> = Vec::new();
    for (index, run) in runs.iter().enumerate() {
        rows.extend(run.moving_rows().into_iter().map(|row| (row.key, index, row.sample)));
    }
    let one_in = rows.len().div_ceil(MOST_ROWS).max(1) as u64;
    rows.retain(|(key, ..)| key.is_multiple_of(one_in));
    let mut times = vec![Vec::new(); runs.len()];
    rows.iter().for_each(|(_, run, sample)| times[*run].push(runs[*run].times[*sample]));
    rows.sort_unstable();
    rows.dedup_by_key(|(key, run, _)| (*key, *run));
    let mut equal: BTreeMap<(usize, usize, TimeShift), usize> = BTreeMap::new();
    for same in rows.chunk_by(|a, b| a.0 == b.0) {
        let same = &same[..same.len().min(MOST_EQUAL)];
        for (index, (_, first, a)) in same.iter().enumerate() {
            for (_, later, b) in &same[index + 1..] {
                let shift = TimeShift::new(runs[*first].times[*a], runs[*later].times[*b]);
                *equal.entry((*first, *later, shift)).or_insert(0) += 1;
            }
        }
    }
    let shared = |((first, later, shift), equal): (&(usize, usize, TimeShift), &usize)| {
        let (first, later, equal) = (*first, *later, *equal);
        let possible = shift
            .within(&times[first], runs[later].duration())
            .min(shift.back().within(&times[later], runs[first].duration()));
        let link = Join { first, later, equal: Some(equal) };
        TimeShift::is_shared(equal, possible).then_some(link)
    };
    equal.iter().filter_map(shared).collect()
}

/// What the ends of a recording show.
struct Ends<'a> {
    run: &'a Run,
    first: End,
    last: End,
    /// The usual time between samples, s.
    step: f64,
    /// The ranges of the positions and the velocities, n.
    ranges: Vec<[f64; 2]>,
}

struct End {
    /// Whether a joint is faster than it is changed within a step near this end.
    is_moving: bool,
    /// The largest change of each joint's velocity within a step near this end, and the largest
    /// change of its position that the mean velocity does not explain, n.
    changes: Vec<[f64; 2]>,
}

impl<'a> Ends<'a> {
    /// Returns the ends of a run that is long enough to have two.
    fn of(run: &'a Run) -> Option<Self> {
        let count = run.len();
        if count <= 2 * NEAR {
            return None;
        }
        let mut steps: Vec<f64> = run.times.windows(2).map(|pair| pair[1] - pair[0]).collect();
        steps.sort_by(f64::total_cmp);
        let limits = run.moving_speeds();
        let end = |k: usize, from: usize| {
            let changes = (0..run.joints).map(|joint| largest_changes(run, from, joint));
            let changes: Vec<[f64; 2]> = changes.collect();
            let slowest = limits.iter().zip(&changes);
            let slowest: Vec<f64> = slowest.map(|(l, c)| (SLOW * l).max(c[0])).collect();
            End { is_moving: run.is_moving(k, &slowest), changes }
        };
        let range = |value: &dyn Fn(usize) -> f64| {
            (0..count).map(value).fold(f64::MIN, f64::max)
                - (0..count).map(value).fold(f64::MAX, f64::min)
        };
        let ranges = |joint: usize| [range(&|k| run.q(k)[joint]), range(&|k| run.qd(k)[joint])];
        Some(Self {
            run,
            first: end(0, 0),
            last: end(count - 1, count - 1 - NEAR),
            step: steps[steps.len() / 2],
            ranges: (0..run.joints).map(ranges).collect(),
        })
    }

    /// Returns whether this recording goes on where `before` ends. `pairs` is the number of pairs
    /// of recordings, one of which might look so by chance.
    fn goes_on_after(&self, before: &Self, are_named: bool, pairs: f64) -> bool {
        let step = self.step.max(before.step);
        let end = before.run.start + before.run.duration();
        let elapsed = self.run.start - end;
        let is_later = self.run.start > before.run.start + 0.5 * before.run.duration();
        let has_clock = is_later && (EARLIEST * step..=LATEST * step).contains(&elapsed);
        if !(before.last.is_moving && self.first.is_moving || has_clock && !are_named) {
            return false;
        }
        let gap = if has_clock { elapsed } else { step };
        let (k, mut chance) = (before.run.len() - 1, pairs);
        for joint in 0..self.run.joints {
            let [a, b] = [before.last.changes[joint], self.first.changes[joint]];
            let steps = (gap / step).abs().max(1.0);
            let faster = LARGEST_CHANGE * steps * a[0].max(b[0]);
            let bend = if steps > 1.5 { faster * gap.abs() } else { 0.0 };
            let farther = LARGEST_CHANGE * a[1].max(b[1]) + bend;
            let speeds = [before.run.qd(k)[joint], self.run.qd(0)[joint]];
            let moved = self.run.q(0)[joint] - before.run.q(k)[joint];
            let unexplained = moved - 0.5 * (speeds[0] + speeds[1]) * gap;
            if (speeds[1] - speeds[0]).abs() > faster || unexplained.abs() > farther {
                return false;
            }
            let [position, velocity] = before.ranges[joint];
            chance *= (2.0 * farther / position).min(1.0) * (2.0 * faster / velocity).min(1.0);
        }
        has_clock || chance < CHANCE
    }
}

/// Returns the largest changes of a joint within one of [`NEAR`] steps from sample `from`.
fn largest_changes(run: &Run, from: usize, joint: usize) -> [f64; 2] {
    let mut largest = [0.0f64; 2];
    for k in from..from + NEAR {
        let [before, after] = [run.qd(k)[joint], run.qd(k + 1)[joint]];
        let explained = 0.5 * (before + after) * (run.times[k + 1] - run.times[k]);
        let moved = run.q(k + 1)[joint] - run.q(k)[joint];
        largest[0] = largest[0].max((after - before).abs());
        largest[1] = largest[1].max((moved - explained).abs());
    }
    largest
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns samples of two joints from `from` to `until`, in hundredths of a second, on a clock
    /// that begins `ahead` seconds after the motion.
    fn run(seed: f64, [from, until]: [u32; 2], ahead: f64) -> Run {
        resampled(seed, (from..until).map(|k| 0.01 * f64::from(k)).collect(), ahead)
    }

    fn resampled(seed: f64, times: Vec<f64>, ahead: f64) -> Run {
        let angle = |joint: f64, t: f64| (1.1 + joint + 0.3 * seed) * t + seed * joint;
        let q = |joint: f64, t: f64| angle(joint, t).sin() + 0.3 * (3.1 * t + seed).cos();
        let qd = |joint: f64, t: f64| {
            (1.1 + joint + 0.3 * seed) * angle(joint, t).cos() - 0.93 * (3.1 * t + seed).sin()
        };
        let state = |t: &f64| [q(0.0, *t), q(1.0, *t), qd(0.0, *t), qd(1.0, *t)];
        let states = times.iter().flat_map(state).collect();
        let torques = times.iter().flat_map(|t| [5.0 * qd(0.0, *t), 3.0 * q(1.0, *t)]).collect();
        Run::new(2, times.iter().map(|t| t - ahead).collect(), states, torques).unwrap()
    }

    fn logs(runs: Vec<Run>) -> Vec<RawLog> {
        let log = |(index, run)| RawLog::new(format!("m{index}"), format!("m{index}.csv"), run);
        runs.into_iter().enumerate().map(log).collect()
    }

    fn joins(runs: Vec<Run>) -> Vec<(usize, usize, Option<usize>)> {
        let logs = logs(runs);
        let links = links(&logs.iter().collect::<Vec<_>>());
        links.iter().map(|link| (link.first, link.later, link.equal)).collect()
    }

    #[test]
    fn pieces_of_a_log_go_on_with_its_clock_or_without_it() {
        let piece = |k: u32, ahead| run(1.0, [100 * k, 100 * k + 100], ahead);
        let pieces = [(0, 1, None), (1, 2, None)];
        assert_eq!(joins((0..3).map(|k| piece(k, 0.0)).collect()), pieces);
        assert_eq!(joins((0..3).map(|k| piece(k, f64::from(k))).collect()), pieces);
        // In any order, and without the last samples of each.
        assert_eq!(joins(vec![piece(1, 0.0), piece(0, 0.0)]), [(1, 0, None)]);
        let short = |k: u32| run(1.0, [100 * k, 100 * k + 95], 0.0);
        assert_eq!(joins((0..3).map(short).collect()), pieces);
        // Another motion, and a piece after the next one.
        assert_eq!(joins(vec![piece(0, 0.0), run(2.0, [100, 200], 0.0)]), []);
        assert_eq!(joins(vec![piece(0, 0.0), piece(2, 0.0)]), []);
    }

    #[test]
    fn recordings_that_share_samples_are_found_by_these() {
        let whole = || run(1.0, [0, 400], 0.0);
        let with = |other: Run| joins(vec![whole(), run(2.0, [0, 400], 0.0), other]);
        let times = |step: f64| (0..130).map(|k| step * f64::from(k)).collect::<Vec<_>>();
        let without_one: Vec<f64> =
            (0..400).filter(|k| *k != 150).map(|k| 0.01 * f64::from(k)).collect();
        for (other, least) in [
            (run(1.0, [200, 600], 2.0), 150),
            (run(1.0, [100, 200], 1.0), 60),
            (resampled(1.0, without_one, 0.0), 300),
            (resampled(1.0, times(0.03), 0.0), 100),
            (resampled(1.0, times(0.025), 0.0), 40),
        ] {
            let found = with(other);
            let [(0, 2, Some(equal))] = found[..] else { panic!("{found:?}") };
            assert!(equal >= least, "{equal} of {least}");
        }
        assert_eq!(with(run(1.05, [0, 400], 0.0)), []);
    }

    /// Returns a motion from home and back, with a rest before and after it.
    fn from_home(seed: f64, start: f64) -> Run {
        let times: Vec<f64> = (0..400).map(|k| 0.01 * f64::from(k)).collect();
        let state = |t: &f64| {
            let (turn, pace) = (std::f64::consts::PI * (t - 1.0), std::f64::consts::PI);
            let [q, qd] = match (1.0..3.0).contains(t) {
                true => [seed * (1.0 - turn.cos()), seed * pace * turn.sin()],
                false => [0.0, 0.0],
            };
            [q, q * q, qd, 2.0 * q * qd]
        };
        let states: Vec<f64> = times.iter().flat_map(state).collect();
        let torques = times.iter().flat_map(|t| [state(t)[0] + 4.0, 1.0]).collect();
        Run::new(2, times.iter().map(|t| t + start).collect(), states, torques).unwrap()
    }

    #[test]
    fn motions_that_begin_and_end_at_one_pose_are_not_joined() {
        let seeds = [0.2, 0.35, 0.5];
        assert_eq!(joins(seeds.map(|seed| from_home(seed, 0.0)).into()), []);
        assert_eq!(joins(seeds.map(|seed| from_home(seed, 20.0 * seed)).into()), []);
        // One log, cut where the robot rests: its clock goes on.
        let cut = || vec![from_home(0.2, 0.0), from_home(0.5, 4.0)];
        assert_eq!(joins(cut()), [(0, 1, None)]);
        let mut named = logs(cut());
        for (log, motion) in named.iter_mut().zip(["a", "b"]) {
            log.motion = Some(motion.into());
        }
        assert_eq!(links(&named.iter().collect::<Vec<_>>()), []);
    }

    #[test]
    fn notes_name_two_files_of_each_kind() {
        let logs = logs(vec![
            run(1.0, [0, 100], 0.0),
            run(1.0, [100, 300], 0.0),
            run(1.0, [200, 400], 0.0),
            run(2.0, [0, 100], 0.0),
        ]);
        let logs: Vec<&RawLog> = logs.iter().collect();
        let [goes_on, shares] = link_notes(&logs, &links(&logs)).map(Option::unwrap);
        assert!(goes_on.starts_with("2 recordings go on") && goes_on.contains("m1.csv goes on"));
        assert!(shares.starts_with("2 recordings share") && shares.contains("m2.csv has "));
        assert_eq!(link_notes(&logs[2..], &[]), [None, None]);
    }
}
