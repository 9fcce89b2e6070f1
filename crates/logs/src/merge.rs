//! Several topics of joint states as one: samples with the same stamp complement each other, and
//! samples with stamps that differ by at most half a sample after an interpolation.

use reachtube_recordings::{Defect, DefectKind, Error as RecordingsError};

use crate::error::Result;
use crate::sample::{JointQuantity, Labels, MessageFault, Sample, defects};
use crate::series::TopicStates;

/// The samples of all topics.
#[derive(Debug, Default)]
pub(crate) struct Merged {
    pub(crate) samples: Vec<Sample>,
    /// Positions, velocities and efforts of all joints, row-major K x 3n.
    pub(crate) values: Vec<f64>,
    /// Number of samples at both ends that are left out because a topic has not begun yet or has
    /// ended.
    pub(crate) unmatched: usize,
    /// Numbers of the topics whose values were interpolated at the stamps of the first topic, and
    /// the largest difference of their stamps, ns.
    pub(crate) shifts: Vec<(usize, i64)>,
}

/// Joins the topics at equal stamps. A single topic stays as it is.
///
/// # Errors
///
/// The defects of topics whose stamps do not increase.
pub(crate) fn merge(mut series: Vec<TopicStates>, labels: &Labels<'_>) -> Result<Merged> {
    if series.len() == 1 {
        let TopicStates { samples, values, .. } = series.remove(0);
        return Ok(Merged { samples, values, ..Merged::default() });
    }
    let unsorted: Vec<Defect> = series
        .iter()
        .flat_map(|series| defects(&series.samples, 0..series.samples.len(), labels))
        .filter(|defect| defect.kind == DefectKind::Time)
        .collect();
    if !unsorted.is_empty() {
        return Err(RecordingsError::Defects(unsorted).into());
    }
    let width = 3 * labels.joints.len();
    let mut merged = Merged::default();
    for topic in 1..series.len() {
        if let Some((samples, values, largest)) = series[topic].at_stamps_of(&series[0].samples) {
            (series[topic].samples, series[topic].values) = (samples, values);
            merged.shifts.push((topic, largest));
        }
    }
    let mut next = vec![0; series.len()];
    let time = |next: &[usize], topic: usize| series[topic].samples.get(next[topic]);
    while let Some(now) = (0..series.len()).filter_map(|t| Some(time(&next, t)?.time)).min() {
        let mut parts = vec![];
        let mut problems = vec![];
        for (topic, from) in series.iter().enumerate() {
            match from.samples.get(next[topic]).filter(|sample| sample.time == now) {
                Some(sample) => {
                    let at = next[topic] * width;
                    parts.push((sample, &from.values[at..at + width]));
                    next[topic] += 1;
                }
                None => problems.push(MessageFault::Alone { topic }),
            }
        }
        let matched = problems.is_empty();
        let values = joined(&parts, matched, labels.joints.len(), &mut problems);
        merged.values.extend(values);
        let first = parts[0].0;
        merged.samples.push(Sample { problems: problems.into(), ..*first });
    }
    merged.trim(width);
    Ok(merged)
}

/// Joins the values of topics at one stamp, n values of each quantity.
fn joined(
    parts: &[(&Sample, &[f64])],
    matched: bool,
    joints: usize,
    problems: &mut Vec<MessageFault>,
) -> Vec<f64> {
    let is_hard = |problem: &&MessageFault| {
        !matches!(problem, MessageFault::Missing { .. } | MessageFault::Empty { .. })
    };
    problems.extend(parts.iter().flat_map(|(sample, _)| sample.problems.iter().filter(is_hard)));
    let place = |slot: usize| (JointQuantity::ALL[slot / joints], slot % joints);
    let mut join = |slot: usize| {
        let mut given =
            parts.iter().map(|(_, values)| values[slot]).filter(|value| !value.is_nan());
        let value = given.next();
        let (quantity, joint) = place(slot);
        if given.next().is_some() {
            problems.push(MessageFault::Twice { quantity, joint });
        }
        if value.is_none() && matched {
            problems.push(MessageFault::Absent { quantity, joint });
        }
        value.unwrap_or(f64::NAN)
    };
    (0..3 * joints).map(&mut join).collect()
}

impl Merged {
    /// Leaves out the samples before all topics have begun and after one has ended.
    fn trim(&mut self, width: usize) {
        let alone = |sample: &Sample| {
            sample.problems.iter().any(|problem| matches!(problem, MessageFault::Alone { .. }))
        };
        let first = self.samples.iter().take_while(|sample| alone(sample)).count();
        let last = self.samples[first..].iter().rev().take_while(|sample| alone(sample)).count();
        let end = self.samples.len() - last;
        self.samples.truncate(end);
        self.values.truncate(end * width);
        self.samples.drain(..first);
        self.values.drain(..first * width);
        self.unmatched = first + last;
    }
}
