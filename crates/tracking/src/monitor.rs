//! Samples of a running arm, judged as they come.

use std::collections::VecDeque;

use reachtube_scalar::Interval;

use crate::basis::{between, rates};
use crate::model::TrackingModel;
use crate::plan::AS_FAST;

/// A longer time between two samples, in usual steps of the recordings, is a gap.
const GAP: f64 = 3.0;

/// Judges samples of an arm under its controller, each as soon as the next one has come, which the
/// speed of its command needs. The first sample after a gap begins anew.
#[derive(Debug, Clone)]
pub struct TrackingMonitor {
    model: TrackingModel,
    part: Unbroken,
    /// Samples that were judged, those outside, and gaps.
    counts: [usize; 3],
    largest: Vec<f64>,
}

/// Samples without a gap between them.
#[derive(Debug, Clone, Default)]
struct Unbroken {
    /// The time of the first one, s.
    start: f64,
    /// The number of samples.
    samples: usize,
    /// Times since the start and commands, as far back as the delay of the model reaches.
    commands: VecDeque<(f64, Vec<f64>)>,
    /// The last three samples: times since the start, commands of the delay before, and actual
    /// positions.
    times: Vec<f64>,
    late: Vec<f64>,
    actual: Vec<f64>,
}

/// A sample that was judged.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct JudgedSample {
    /// Its time, s.
    pub time: f64,
    /// The part of its set that the joint needs that needs the most; more than 1 is outside.
    pub needed: f64,
    /// The joint, from 0.
    pub joint: usize,
    /// A joint whose command is faster than the recorded ones, from 0.
    pub too_fast: Option<usize>,
}

impl TrackingMonitor {
    /// Returns a monitor that has seen no sample.
    #[must_use]
    pub fn new(model: TrackingModel) -> Self {
        let largest = vec![0.0; model.joints.len()];
        Self { model, part: Unbroken::default(), counts: [0; 3], largest }
    }

    /// Returns the model.
    #[must_use]
    pub fn model(&self) -> &TrackingModel {
        &self.model
    }

    /// Returns how many samples were judged, how many of them were outside, and how many gaps there
    /// were.
    #[must_use]
    pub fn counts(&self) -> [usize; 3] {
        self.counts
    }

    /// Returns the largest part of its set that each joint needed.
    #[must_use]
    pub fn largest(&self) -> &[f64] {
        &self.largest
    }

    /// Takes a sample, and calls `judged` for each one that can be judged with it. A time that does
    /// not increase is taken for a gap.
    ///
    /// # Guarantee
    ///
    /// A sample that needs at most its whole set is proved to lie in the sets, as in
    /// [`TrackingModel::check`]; directed rounding.
    ///
    /// # Panics
    ///
    /// Panics for another number of joints.
    pub fn push(
        &mut self,
        time: f64,
        [command, actual]: [&[f64]; 2],
        mut judged: impl FnMut(JudgedSample),
    ) {
        let n = self.model.joints.len();
        assert_eq!((command.len(), actual.len()), (n, n), "there is a position of each joint");
        let step = time - self.part.start - self.part.times.last().copied().unwrap_or(0.0);
        if self.part.samples > 0 && !(step > 0.0 && step <= GAP * self.model.step) {
            self.finish(&mut judged);
            self.counts[2] += 1;
        }
        let Unbroken { start, samples, times, late, actual: positions, .. } = &mut self.part;
        if *samples == 0 {
            *start = time;
        }
        if times.len() == 3 {
            times.remove(0);
            late.drain(..n);
            positions.drain(..n);
        }
        *samples += 1;
        times.push(time - *start);
        positions.extend_from_slice(actual);
        self.part.delayed(command, self.model.delay);
        if self.part.times.len() == 3 {
            let first = if self.part.samples == 3 { 0 } else { 1 };
            (first..2).for_each(|k| judged(self.judge(k)));
        }
    }

    /// Judges the last sample before a gap or the end, and begins anew.
    pub fn finish(&mut self, mut judged: impl FnMut(JudgedSample)) {
        if self.part.times.len() == 3 {
            judged(self.judge(2));
        }
        self.part = Unbroken::default();
    }

    /// Judges one of the last three samples.
    fn judge(&mut self, k: usize) -> JudgedSample {
        let Unbroken { start, times, late, actual, .. } = &self.part;
        let n = self.model.joints.len();
        let mut found =
            JudgedSample { time: start + times[k], needed: 0.0, joint: 0, too_fast: None };
        for (joint, of) in self.model.joints.iter().enumerate() {
            let speeds = rates(k, times, |k| Interval::point(late[k * n + joint]));
            let at = k * n + joint;
            let (rest, half_width) = of.rest([late[at], actual[at]], speeds);
            let part = rest.mag() / half_width;
            // A position that is no number is nowhere.
            let needed = match part {
                part if part.is_nan() => f64::INFINITY,
                part if part <= 1.0 && rest.mag() > half_width => 1.0 + f64::EPSILON,
                part => part,
            };
            self.largest[joint] = self.largest[joint].max(needed);
            if needed > found.needed {
                (found.needed, found.joint) = (needed, joint);
            }
            if speeds[0].mig() > of.largest_speed * (1.0 + AS_FAST) {
                found.too_fast = found.too_fast.or(Some(joint));
            }
        }
        self.counts[0] += 1;
        self.counts[1] += usize::from(found.needed > 1.0);
        found
    }
}

impl Unbroken {
    /// Adds the command of a delay before the last time, as models define it.
    fn delayed(&mut self, command: &[f64], delay: f64) {
        let time = self.times.last().copied().unwrap_or_default();
        if delay == 0.0 {
            self.late.extend_from_slice(command);
            return;
        }
        let at = (time - delay).max(0.0);
        // The memory of a sample that is no longer needed serves the new one.
        let mut memory = Vec::new();
        while self.commands.len() > 1 && self.commands[1].0 <= at {
            memory = self.commands.pop_front().unwrap_or_default().1;
        }
        memory.clear();
        memory.extend_from_slice(command);
        self.commands.push_back((time, memory));
        match (&self.commands[0], self.commands.get(1)) {
            ((before, from), Some((after, to))) => {
                let part = ((at - before) / (after - before)).clamp(0.0, 1.0);
                let between = |(from, to): (&f64, &f64)| between(*from, *to, part);
                self.late.extend(from.iter().zip(to).map(between));
            }
            ((_, from), None) => self.late.extend_from_slice(from),
        }
    }
}
