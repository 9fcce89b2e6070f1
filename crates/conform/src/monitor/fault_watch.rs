//! What is done with the numbers that faults change: ranges are learnt, or watched.

use reachtube_recordings::Sample;

use crate::data::residual::Residual;
use crate::monitor::alarm::{Alarm, Fault};
use crate::monitor::statistics::{Range, Shape, Statistics};

/// What is done with the samples of a motion.
#[derive(Debug)]
pub(crate) enum Task {
    /// Learns how fast parts move: sums of squared velocities.
    Speeds { squares: Vec<f64>, count: u64 },
    /// Learns the ripple, by sums of products of the parts of a torque, and the mean square of the
    /// torque of 1 kg at the tip.
    Ripple { products: Vec<[f64; 5]>, load: f64, count: u64 },
    /// Learns the range of each number.
    Ranges(Vec<Option<Range>>),
    /// Learns by which factors the ranges hold other motions: first the ranges of sudden
    /// torques, then the ranges of drags and the payload.
    Scores { ranges: Vec<Option<Range>>, largest: [f64; 2] },
    /// Raises an alarm when a number leaves its range.
    Watch { ranges: Vec<Option<Range>>, outside: Vec<bool> },
}

/// The numbers that faults change, and what is done with them.
#[derive(Debug)]
pub(crate) struct FaultWatch {
    residual: Box<dyn Residual>,
    statistics: Statistics,
    pub task: Task,
}

impl FaultWatch {
    pub(crate) fn new(residual: Box<dyn Residual>, shape: Shape, step: f64, task: Task) -> Self {
        Self { residual, statistics: Statistics::new(shape, step), task }
    }

    pub(crate) fn clear(&mut self) {
        self.residual.clear();
        self.statistics.clear();
        if let Task::Watch { outside, .. } = &mut self.task {
            outside.fill(false);
        }
    }

    /// Takes a sample with its input (n, N m), and hands alarms that begin to `raise`.
    pub(crate) fn take(&mut self, sample: &Sample, u: &[f64], raise: impl FnMut(Alarm)) {
        let Self { residual, statistics, task } = self;
        if !residual.take(sample, u) {
            return;
        }
        let residual = residual.torques();
        statistics.take(residual);
        match task {
            Task::Speeds { squares, count } => {
                *count += 1;
                let speeds = squares.iter_mut().zip(&residual.speed);
                speeds.for_each(|(sum, speed)| *sum += speed * speed);
            }
            Task::Ripple { products, load, count } => {
                let all = products.iter_mut().zip(&statistics.above);
                let all = all.filter_map(|(sums, above)| Some((sums, (*above)?)));
                all.for_each(|(sums, above)| add_products(sums, above));
                *count += 1;
                let moving = residual.weight.iter().enumerate();
                let moving = moving.filter(|(part, _)| statistics.is_moving(*part));
                *load += moving.map(|(_, weight)| weight * weight).sum::<f64>();
            }
            Task::Ranges(ranges) => {
                let known = ranges.iter_mut().zip(&statistics.values);
                let known = known.filter_map(|(range, value)| Some((range, (*value)?)));
                known.for_each(|(range, value)| {
                    let [low, high] = range.unwrap_or([value; 2]);
                    *range = Some([low.min(value), high.max(value)]);
                });
            }
            Task::Scores { ranges, largest } => {
                let parts = ranges.len() / 2;
                for (index, (range, value)) in ranges.iter().zip(&statistics.values).enumerate() {
                    let (Some([low, high]), Some(value)) = (*range, *value) else { continue };
                    let score = (value - 0.5 * (low + high)).abs() / (0.5 * (high - low));
                    let largest = &mut largest[usize::from(index >= parts)];
                    *largest = largest.max(score);
                }
            }
            Task::Watch { ranges, outside } => {
                watch(ranges, outside, &statistics.values, sample.time, raise);
            }
        }
    }
}

fn add_products(sums: &mut [f64; 5], [torque, sine, cosine]: [f64; 3]) {
    let products = [sine * sine, sine * cosine, cosine * cosine, sine * torque, cosine * torque];
    sums.iter_mut().zip(products).for_each(|(sum, product)| *sum += product);
}

/// Raises an alarm for each value that leaves its range now.
fn watch(
    ranges: &[Option<Range>],
    outside: &mut [bool],
    values: &[Option<f64>],
    time: f64,
    mut raise: impl FnMut(Alarm),
) {
    let n = values.len() / 2;
    for (index, (range, value)) in ranges.iter().zip(values).enumerate() {
        let (Some(range), Some(value)) = (*range, *value) else {
            outside[index] = false;
            continue;
        };
        let is_outside = value < range[0] || value > range[1];
        let begins = is_outside && !outside[index];
        outside[index] = is_outside;
        if begins {
            let (fault, part) = match index / n {
                0 => (Fault::Push, Some(index + 1)),
                1 if index < 2 * n => (Fault::Drag, Some(index - n + 1)),
                _ => (Fault::Payload, None),
            };
            raise(Alarm { time, fault, part, value, range });
        }
    }
}
