//! Samples brought into their order, and topics brought to the stamps of one of them.

use crate::sample::Sample;
use crate::series::TopicStates;

/// Values are interpolated between samples whose distance is at most this many usual ones.
const LONGEST: f64 = 1.9;

/// The samples and values of a topic at the stamps of another, and the largest difference of their
/// stamps, ns.
type Moved = (Vec<Sample>, Vec<f64>, i64);

impl TopicStates {
    /// Sorts samples whose times do not increase by the times at which the log received them, as
    /// in files whose messages are out of order. Returns the number of samples that the file has
    /// after a later one.
    pub(crate) fn sort(&mut self) -> usize {
        let pairs = || self.samples.windows(2);
        let late = pairs().filter(|pair| pair[1].received < pair[0].received).count();
        if late == 0 || pairs().all(|pair| pair[0].time < pair[1].time) {
            return 0;
        }
        let width = self.values.len() / self.samples.len();
        let mut order: Vec<usize> = (0..self.samples.len()).collect();
        order.sort_by_key(|index| self.samples[*index].received);
        let row = |index: &usize| self.values[index * width..][..width].iter().copied();
        self.values = order.iter().flat_map(row).collect();
        self.samples = order.iter().map(|index| self.samples[*index].clone()).collect();
        late
    }

    /// Returns the samples at the stamps of another topic, if they differ by at most half a sample
    /// somewhere. Values are interpolated. A stamp further from all
    /// samples, or in a gap, is left out.
    ///
    /// Both series have stamps that increase.
    pub(crate) fn at_stamps_of(&self, reference: &[Sample]) -> Option<Moved> {
        let times: Vec<i64> = self.samples.iter().map(|sample| sample.time).collect();
        let stamps: Vec<i64> = reference.iter().map(|sample| sample.time).collect();
        let places = places(&times, &stamps)?;
        let width = self.values.len() / self.samples.len();
        let (mut samples, mut values) = (vec![], vec![]);
        let mut largest = 0;
        for (stamp, place) in stamps.iter().zip(places) {
            match place {
                Place::None => {}
                Place::At(index) => {
                    samples.push(self.samples[index].clone());
                    values.extend(&self.values[index * width..][..width]);
                }
                Place::After { index, part, distance } => {
                    largest = largest.max(distance);
                    let row = |index: usize| &self.values[index * width..][..width];
                    let pairs = row(index).iter().zip(row(index + 1));
                    values.extend(pairs.map(|(a, b)| a + part * (b - a)));
                    let [last, next] = [index, index + 1].map(|index| &self.samples[index]);
                    let nearest = if part > 0.5 { next } else { last };
                    let problems = last.problems.iter().chain(&next.problems).copied().collect();
                    samples.push(Sample { time: *stamp, problems, ..nearest.clone() });
                }
            }
        }
        (largest > 0).then_some((samples, values, largest))
    }
}

/// Where a stamp lies among the samples of a series.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Place {
    /// Further than half a sample from all, or in a gap.
    None,
    /// At a sample.
    At(usize),
    /// After a sample by a part of the step to the next one; the distance to the nearest, ns.
    After { index: usize, part: f64, distance: i64 },
}

/// Returns where each stamp lies among times, both increasing; `None` if there are too few for a
/// usual step.
pub(crate) fn places(times: &[i64], stamps: &[i64]) -> Option<Vec<Place>> {
    let step = median_step(times)?;
    let half = step.min(median_step(stamps)?) / 2;
    let longest = (LONGEST * step as f64) as i64;
    let place = |stamp: &i64| {
        let after = times.partition_point(|time| time < stamp);
        let Some(next) = times.get(after) else { return Place::None };
        if next == stamp {
            return Place::At(after);
        }
        let Some(index) = after.checked_sub(1) else { return Place::None };
        let [ahead, behind] = [next - stamp, stamp - times[index]];
        if ahead.min(behind) > half || ahead + behind > longest {
            return Place::None;
        }
        let part = behind as f64 / (ahead + behind) as f64;
        Place::After { index, part, distance: ahead.min(behind) }
    };
    Some(stamps.iter().map(place).collect())
}

/// Returns the usual time between two stamps, ns.
pub(crate) fn median_step(times: &[i64]) -> Option<i64> {
    let mut steps: Vec<i64> = times.windows(2).map(|pair| pair[1] - pair[0]).collect();
    steps.sort_unstable();
    steps.get(steps.len() / 2).copied()
}
