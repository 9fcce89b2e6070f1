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
        let step = median_step(&self.samples)?;
        let half = step.min(median_step(reference)?) / 2;
        let longest = (LONGEST * step as f64) as i64;
        let width = self.values.len() / self.samples.len();
        let (mut samples, mut values) = (vec![], vec![]);
        let mut largest = 0;
        for stamp in reference.iter().map(|sample| sample.time) {
            let after = self.samples.partition_point(|sample| sample.time < stamp);
            let Some(next) = self.samples.get(after) else { break };
            if next.time == stamp {
                samples.push(next.clone());
                values.extend(&self.values[after * width..][..width]);
                continue;
            }
            let Some(before) = after.checked_sub(1) else { continue };
            let last = &self.samples[before];
            let [ahead, behind] = [next.time - stamp, stamp - last.time];
            if ahead.min(behind) > half || ahead + behind > longest {
                continue;
            }
            largest = largest.max(ahead.min(behind));
            let part = behind as f64 / (ahead + behind) as f64;
            let [from, to] = [before, after].map(|index| &self.values[index * width..][..width]);
            values.extend(from.iter().zip(to).map(|(a, b)| a + part * (b - a)));
            let nearest = if ahead < behind { next } else { last };
            let problems = last.problems.iter().chain(&next.problems).copied().collect();
            samples.push(Sample { time: stamp, problems, ..nearest.clone() });
        }
        (largest > 0).then_some((samples, values, largest))
    }
}

/// Returns the usual time between two samples, ns.
fn median_step(samples: &[Sample]) -> Option<i64> {
    let mut steps: Vec<i64> = samples.windows(2).map(|pair| pair[1].time - pair[0].time).collect();
    steps.sort_unstable();
    steps.get(steps.len() / 2).copied()
}
