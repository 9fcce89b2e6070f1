//! Cost of the widths of the reachable sets.

use std::collections::HashMap;

use crate::data::shape::Shape;
use crate::program::block::Block;
use crate::program::gains::Gains;

/// Number of units in a second, in which cells of time are counted: half picoseconds.
const UNITS: f64 = 2e12;

/// The time that each sample of several lists of sample times stands for.
///
/// A sample stands for the time until halfway to its neighbours, and the first and the last one of
/// a list for as much on their outer side. Lists share a time at which there are several of them.
/// So the sum over samples is an integral over time, whatever the sample rate is.
pub(crate) struct SampleTimes {
    /// For each list and sample, the time as a part of `step`; 1 on a uniform grid.
    pub parts: Vec<Vec<f64>>,
    /// The mean time between samples, s.
    pub step: f64,
}

impl SampleTimes {
    pub(crate) fn new<'t>(lists: impl Iterator<Item = &'t [f64]>) -> Self {
        let picoseconds = |times: &[f64]| -> Vec<i128> {
            times.iter().map(|t| (t * 0.5 * UNITS).round() as i128).collect()
        };
        let lists: Vec<Vec<i128>> = lists.map(picoseconds).collect();
        // A list of one sample has no gap of its own.
        let gaps = lists.iter().filter_map(|times| Some(times.get(1)? - times[0]));
        let shortest = gaps.min().unwrap_or((0.5 * UNITS) as i128).max(1);
        let edges: Vec<Vec<i128>> = lists.iter().map(|times| edges(times, shortest)).collect();
        let spans = || edges.iter().filter_map(|e| Some((*e.first()?, *e.last()?)));
        let cells: usize = lists.iter().map(Vec::len).sum();
        let total: i128 = spans().map(|(first, last)| last - first).sum();
        let mean = total as f64 / cells.max(1) as f64;
        let counts = counts(spans());
        let of_list = |edges: &Vec<i128>| {
            let mut at = 0;
            let cells =
                edges.windows(2).map(|cell| part((cell[0], cell[1]), &counts, mean, &mut at));
            cells.collect()
        };
        Self { parts: edges.iter().map(of_list).collect(), step: mean / UNITS }
    }
}

/// Returns where the cells of samples begin and end, in half picoseconds, for times in picoseconds.
fn edges(times: &[i128], only: i128) -> Vec<i128> {
    let (Some(first), Some(last)) = (times.first(), times.last()) else { return Vec::new() };
    let gap = |pair: Option<&[i128]>| pair.map_or(only, |pair| pair[1] - pair[0]);
    let begin = 2 * first - gap(times.windows(2).next());
    let end = 2 * last + gap(times.windows(2).next_back());
    let between = times.windows(2).map(|pair| pair[0] + pair[1]);
    std::iter::once(begin).chain(between).chain([end]).collect()
}

/// Returns where the number of lists changes, and how many there are from there on.
fn counts(spans: impl Iterator<Item = (i128, i128)>) -> Vec<(i128, f64)> {
    let mut changes: Vec<(i128, f64)> =
        spans.flat_map(|(first, last)| [(first, 1.0), (last, -1.0)]).collect();
    changes.sort_by_key(|(at, _)| *at);
    let mut counts: Vec<(i128, f64)> = Vec::new();
    for (at, change) in changes {
        let before = counts.last().map_or(0.0, |(_, count)| *count);
        match counts.last_mut() {
            Some(last) if last.0 == at => last.1 += change,
            _ => counts.push((at, before + change)),
        }
    }
    counts
}

/// Returns a cell's part of the `mean` one, shared among the lists that are there; `at` is the
/// place in `counts` where the search begins.
fn part((from, to): (i128, i128), counts: &[(i128, f64)], mean: f64, at: &mut usize) -> f64 {
    while counts.get(*at + 1).is_some_and(|(next, _)| *next <= from) {
        *at += 1;
    }
    let (mut here, mut part) = (from, 0.0);
    for (k, (_, count)) in counts.iter().enumerate().skip(*at) {
        let end = counts.get(k + 1).map_or(to, |(next, _)| to.min(*next));
        part += (end - here) as f64 / mean / count;
        here = end;
        if here == to {
            break;
        }
    }
    part
}

/// Returns, for each of several lists of sample times, how much each sample counts in the paper's
/// sums: samples at one time together count 1.
pub(crate) fn distinct_shares<'t>(lists: impl Iterator<Item = &'t [f64]> + Clone) -> Vec<Vec<f64>> {
    let nanoseconds = |t: &f64| (t * 1e9).round() as i64;
    let mut counts = HashMap::new();
    lists.clone().flatten().for_each(|t| *counts.entry(nanoseconds(t)).or_insert(0.0) += 1.0);
    lists.map(|times| times.iter().map(|t| 1.0 / counts[&nanoseconds(t)]).collect()).collect()
}

/// Returns the cost of each radius (r_x, r_u), and of each noise radius, for the weight of each
/// state, in mean steps.
pub(super) fn cost(
    shape: Shape,
    blocks: &[Block],
    parts: &[Vec<f64>],
    weights: &[f64],
) -> (Vec<f64>, Vec<f64>) {
    let radii = shape.radii();
    let (mut cost, mut noise) = (vec![0.0; radii], vec![0.0; shape.outputs]);
    for (block, parts) in blocks.iter().zip(parts) {
        let samples = block.coefficients.chunks_exact(shape.entries());
        for (rows, part) in samples.zip(parts) {
            for (i, row) in rows.chunks_exact(2 * radii).enumerate() {
                let weight = 2.0 * part * weights[i];
                let gains = Gains { gains: &row[radii..], scale: &block.scale };
                gains.iter().zip(&mut cost).for_each(|(a, w)| *w += weight * a);
                noise[i] += weight;
            }
        }
    }
    (cost, noise)
}

#[cfg(test)]
mod tests {
    use super::SampleTimes;

    fn times(count: usize, step: f64) -> Vec<f64> {
        (0..count).map(|k| k as f64 * step).collect()
    }

    #[test]
    fn samples_of_a_uniform_grid_count_one_step_each() {
        let (long, short) = (times(500, 0.004), times(200, 0.004));
        let found = SampleTimes::new([&*long, &*short].into_iter());
        assert_eq!(found.step, 0.004);
        let expected = |k: usize| if k < 200 { 0.5 } else { 1.0 };
        assert!(found.parts[0].iter().enumerate().all(|(k, part)| *part == expected(k)));
        assert_eq!(found.parts[1], vec![0.5; 200]);
    }

    #[test]
    fn neither_rate_nor_jitter_nor_further_lists_change_the_whole_time() {
        let whole = |lists: &[Vec<f64>]| {
            let found = SampleTimes::new(lists.iter().map(Vec::as_slice));
            found.step * found.parts.iter().flatten().sum::<f64>()
        };
        let near = |lists: &[Vec<f64>], time: f64| {
            assert!((whole(lists) - time).abs() < 1e-7, "{} for {time}", whole(lists));
        };
        let uniform = times(101, 0.01);
        let jittered: Vec<f64> =
            uniform.iter().enumerate().map(|(k, t)| t + 4e-9 * (k % 3) as f64).collect();
        near(std::slice::from_ref(&uniform), 1.01);
        near(&[uniform.clone(), jittered], 1.01);
        near(&[times(201, 0.005)], 1.005);
        near(&[uniform, times(201, 0.005)], 1.01);
        near(&[vec![0.0]], 1.0);
        near(&[vec![0.0], vec![0.0, 0.5]], 1.0);
        near(&[vec![0.0, 1.0, 5.0]], 7.5);
    }
}
