//! Enclosures of e^{A t_k} and e^{A t_k} Γ(h_k) at the samples of a grid.

use std::ops::Range;

use nalgebra::DMatrix;
use rayon::prelude::*;
use reachtube_scalar::Interval;
use reachtube_scalar::rounding::{add_up, mul_up};

use crate::linear::column_sums::larger;
use crate::linear::exponential::block::{ExponentialBlock, SHARED};
use crate::linear::exponential::powers::MatrixPowers;
use crate::linear::step::{PropagationStep, step};
use crate::linear::system::LinearSystem;
use crate::sets::interval_matrix::{IntervalMatrix, product};

/// The pairs [e^{A t_k}, e^{A t_k} Γ(h_k)], N x (N + m), at the samples of a grid.
///
/// The second matrix of a pair is the increment of Γ over step k. Midpoints and radii are stored in
/// separate arrays, pair by pair and column by column, so that loops over all entries vectorise.
#[derive(Debug, Clone)]
pub(crate) struct SampleMatrices {
    states: usize,
    inputs: usize,
    /// Number of samples, from the first on, with radii of their own; later samples share them.
    first: usize,
    mid: Vec<f64>,
    /// Radii so large that the rounded ends of mid ± rad enclose the exact number.
    rad: Vec<f64>,
}

impl SampleMatrices {
    /// Encloses the pairs at `count` samples separated by `steps`.
    ///
    /// P = `within_step` must satisfy P >= |e^{As}| for every s up to the longest step. The
    /// increment at the last sample, which no step follows, is zero.
    pub(crate) fn after(
        system: &LinearSystem,
        steps: &[PropagationStep],
        count: usize,
        within_step: &DMatrix<f64>,
    ) -> Self {
        let powers = MatrixPowers::of_steps(steps, within_step);
        let none = IntervalMatrix::from_element(system.states(), system.inputs(), Interval::ZERO);
        let pair = |k: usize| {
            let start = powers.at(k);
            let increment =
                steps.get(k).map_or_else(|| none.clone(), |step| product(&start, &step.gamma));
            [start, increment]
        };
        Self::from_pairs(system, (0..count).into_par_iter().map(pair).collect())
    }

    fn from_pairs(system: &LinearSystem, pairs: Vec<[IntervalMatrix; 2]>) -> Self {
        let (states, inputs, first) = (system.states(), system.inputs(), pairs.len());
        let entries = || pairs.iter().flatten().flat_map(|matrix| matrix.as_slice());
        let size = first * states * (states + inputs);
        let (mut mid, mut rad) = (Vec::with_capacity(size), Vec::with_capacity(size));
        mid.extend(entries().map(|x| x.mid()));
        rad.extend(entries().map(|x| match x.rad() {
            0.0 => 0.0,
            rad => add_up(rad, mul_up(f64::EPSILON, x.mag())),
        }));
        Self { states, inputs, first, mid, rad }
    }

    /// Encloses the pairs at t_k = k h for k < `count`; `step` is the step of length h.
    ///
    /// With k = b L + j and L about √count, pair k is the product of e^{A b L h} with pair j.
    /// Neither factor takes more than √count steps. The products are most of the work, and they are
    /// large and independent of each other.
    pub(crate) fn uniform(
        system: &LinearSystem,
        step: &PropagationStep,
        h: Interval,
        count: usize,
    ) -> Self {
        // Powers of one step, up to one block of L samples.
        let length = count.isqrt().max(1).next_multiple_of(SHARED);
        let short = MatrixPowers::uniform(&step.phi, length + 1);
        let pair = |j: usize| [short.at(j), product(&short.at(j), &step.gamma)];
        // Pairs of the first block, and powers of a whole block.
        let (first, long) = rayon::join(
            || Self::from_pairs(system, (0..length).map(pair).collect()),
            || {
                MatrixPowers::uniform(
                    &over_block(system, &short.at(length), h * length as f64),
                    count.div_ceil(length),
                )
            },
        );
        // Products of both give all later blocks, in parallel.
        let block = ExponentialBlock::new(system, first.first, &first.mid, &first.rad);
        let size = first.mid.len();
        let mut samples = first.extended(long.mid.len());
        let shared = samples.rad[size..].par_chunks_exact_mut((size / SHARED).max(1));
        let blocks = samples.mid[size..].par_chunks_exact_mut(size.max(1)).zip(shared);
        let factors = long.mid[1..].par_iter().zip(&long.rad[1..]);
        blocks
            .zip(factors)
            .for_each(|((mid, rad), (left, error))| block.multiply(left, error, mid, rad));
        samples.mid.truncate(count * block.pair_size());
        samples
    }

    /// Encloses the pairs [Φᵏ, Φᵏ Γ] for k < `count` of a step that is repeated, whatever Φ is.
    pub(crate) fn of_step(system: &LinearSystem, step: &PropagationStep, count: usize) -> Self {
        let powers = MatrixPowers::uniform(&step.phi, count);
        let pair = |k: usize| [powers.at(k), product(&powers.at(k), &step.gamma)];
        Self::from_pairs(system, (0..count).into_par_iter().map(pair).collect())
    }

    /// Allocates room for `blocks` blocks of this size, this one included.
    ///
    /// Zeroed memory stays untouched until the threads write to it.
    fn extended(self, blocks: usize) -> Self {
        let size = self.mid.len();
        let mut all = Self {
            mid: vec![0.0; size * blocks],
            rad: vec![0.0; size + size / SHARED * (blocks - 1)],
            ..self
        };
        all.mid[..size].copy_from_slice(&self.mid);
        all.rad[..size].copy_from_slice(&self.rad);
        all
    }

    /// Returns e^{A t_k}, N x N.
    pub(crate) fn exponential(&self, k: usize) -> IntervalMatrix {
        let entries = intervals(self.ends(k, 0..self.states));
        IntervalMatrix::from_iterator(self.states, self.states, entries)
    }

    /// Returns e^{A t_k} Γ(h_k), N x m.
    pub(crate) fn increment(&self, k: usize) -> IntervalMatrix {
        IntervalMatrix::from_iterator(self.states, self.inputs, intervals(self.increment_ends(k)))
    }

    /// Iterates over the lower and upper ends of e^{A t_k} Γ(h_k), column by column.
    pub(crate) fn increment_ends(&self, k: usize) -> impl Iterator<Item = (f64, f64)> {
        self.ends(k, self.states..self.states + self.inputs)
    }

    /// Iterates over the lower and upper ends of some columns of pair k.
    pub(crate) fn ends(&self, k: usize, columns: Range<usize>) -> impl Iterator<Item = (f64, f64)> {
        let (mid, rad) = self.balls(k, columns);
        mid.iter().zip(rad).map(|(mid, rad)| (mid - rad, mid + rad))
    }

    /// Returns midpoints and radii of e^{A t_k}, each N x N, column by column.
    pub(crate) fn exponential_ball(&self, k: usize) -> (&[f64], &[f64]) {
        self.balls(k, 0..self.states)
    }

    /// Returns midpoints and radii of some columns of pair k.
    fn balls(&self, k: usize, columns: Range<usize>) -> (&[f64], &[f64]) {
        let n = self.states;
        let start = |pair: usize| pair * n * (n + self.inputs);
        let columns = |pair: usize| start(pair) + columns.start * n..start(pair) + columns.end * n;
        let shared = if k < self.first { k } else { self.first + (k - self.first) / SHARED };
        (&self.mid[columns(k)], &self.rad[columns(shared)])
    }

    /// Bounds the absolute value of each entry of the exponential over all samples, N x N.
    pub(crate) fn largest(&self) -> DMatrix<f64> {
        let n = self.states;
        let largest = |all: &[f64]| {
            let mut largest = DMatrix::zeros(n, n);
            for pair in all.chunks_exact((n * (n + self.inputs)).max(1)) {
                let entries = largest.as_mut_slice().iter_mut().zip(pair);
                entries.for_each(|(max, x): (&mut f64, &f64)| *max = larger(x.abs(), *max));
            }
            largest
        };
        largest(&self.mid).zip_map(&largest(&self.rad), add_up)
    }
}

/// Encloses e^{At} over a whole block by the intersection of `power`, the power of one step, and
/// the direct series.
fn over_block(system: &LinearSystem, power: &IntervalMatrix, t: Interval) -> IntervalMatrix {
    let direct = step(system, t).phi;
    power.zip_map(&direct, |x, y| x.intersection(y).expect("both enclose the exact entry"))
}

fn intervals(ends: impl Iterator<Item = (f64, f64)>) -> impl Iterator<Item = Interval> {
    ends.map(|(lo, hi)| Interval::new(lo, hi).unwrap_or(Interval::ENTIRE))
}

#[cfg(test)]
mod tests {
    use nalgebra::{dmatrix, dvector};

    use super::*;

    #[test]
    fn products_of_two_powers_agree_with_single_steps() {
        let system = LinearSystem::new(
            dmatrix![0.0, 1.0, 0.0; -4.0, -0.1, 0.0; 0.0, 0.0, -2.0],
            dmatrix![0.0; 1.0; 0.5],
            dvector![0.0, 0.0, 0.0],
        )
        .unwrap();
        let step = step(&system, Interval::point(0.01));
        let one_by_one = MatrixPowers::uniform(&step.phi, 1000);
        let samples = SampleMatrices::uniform(&system, &step, Interval::point(0.01), 1000);
        for k in 0..1000 {
            let (exponential, increment) = (samples.exponential(k), samples.increment(k));
            let other = one_by_one.at(k);
            for (x, y) in exponential.iter().zip(&other) {
                assert!(
                    x.intersection(*y).is_some() && x.width() <= y.width() + 1e-14,
                    "{k}: {x:?} {y:?}"
                );
            }
            for (x, y) in increment.iter().zip(&product(&other, &step.gamma)) {
                assert!(
                    x.intersection(*y).is_some() && x.hull(*y).width() < 1e-13,
                    "{k}: {x:?} {y:?}"
                );
            }
            assert_eq!(exponential[(0, 2)], Interval::ZERO);
        }
    }
}
