//! e^{A t_k} and e^{A t_k} Γ(h_k) at the samples of a grid.

use std::ops::Range;

use nalgebra::{DMatrix, DMatrixViewMut};
use rayon::prelude::*;
use reachtube_scalar::Interval;
use reachtube_scalar::rounding::{add_up, mul_up};

use crate::LinearSystem;
use crate::exponential::{self, Step, connected};
use crate::matrix::{IntervalMatrix, UNDERFLOW, product, relative_error};
use crate::powers::Powers;
use crate::sums::larger;

/// Where the bound of an error is less, the products it belongs to did not overflow.
const FAR_FROM_OVERFLOW: f64 = 1e280;

/// So many samples, one after another, share the bounds of their errors, but for the first ones.
const TOGETHER: usize = 6;

/// The pairs [e^{A t_k}, e^{A t_k} Γ(h_k)], N x (N + m), at the samples of a grid; by the second, Γ
/// grows over step k.
///
/// Numbers and their radii are apart and side by side, column by column: what is done to all is
/// done to long rows of numbers.
#[derive(Debug, Clone)]
pub(crate) struct Samples {
    states: usize,
    inputs: usize,
    /// So many samples have radii of their own.
    first: usize,
    mid: Vec<f64>,
    /// Such that mid ± rad holds the exact number also where it is rounded.
    rad: Vec<f64>,
}

impl Samples {
    /// Of so many samples, `steps` between them, with P = `within_step` >= |e^{As}| for every s up
    /// to the longest. After the last sample there is no step, and no increment.
    pub(crate) fn after(
        system: &LinearSystem,
        steps: &[Step],
        count: usize,
        within_step: &DMatrix<f64>,
    ) -> Self {
        let powers = Powers::of_steps(steps, within_step);
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

    /// At t_k = k h for k < count; `step` is that of length h.
    ///
    /// With k = b L + j, L about √count, the pair is the product of e^{A b L h} with the pair at j:
    /// neither factor takes more than √count steps, and the products, which are most of the work,
    /// are large and independent of each other.
    pub(crate) fn uniform(system: &LinearSystem, step: &Step, h: Interval, count: usize) -> Self {
        let length = count.isqrt().max(1).next_multiple_of(TOGETHER);
        let short = Powers::uniform(&step.phi, length + 1);
        let pair = |j: usize| [short.at(j), product(&short.at(j), &step.gamma)];
        let (first, long) = rayon::join(
            || Self::from_pairs(system, (0..length).map(pair).collect()),
            || {
                Powers::uniform(
                    &leap(system, &short.at(length), h * length as f64),
                    count.div_ceil(length),
                )
            },
        );
        let (block, size) = (Block::new(system, &first), first.mid.len());
        let mut samples = first.extended(long.mid.len());
        let shared = samples.rad[size..].par_chunks_exact_mut((size / TOGETHER).max(1));
        let blocks = samples.mid[size..].par_chunks_exact_mut(size.max(1)).zip(shared);
        let factors = long.mid[1..].par_iter().zip(&long.rad[1..]);
        blocks
            .zip(factors)
            .for_each(|((mid, rad), (left, error))| block.after(left, error, mid, rad));
        samples.mid.truncate(count * block.zero.len());
        samples
    }

    /// With room for so many blocks like this one, which nobody touches before the threads come to
    /// them.
    fn extended(self, blocks: usize) -> Self {
        let size = self.mid.len();
        let mut all = Self {
            mid: vec![0.0; size * blocks],
            rad: vec![0.0; size + size / TOGETHER * (blocks - 1)],
            ..self
        };
        all.mid[..size].copy_from_slice(&self.mid);
        all.rad[..size].copy_from_slice(&self.rad);
        all
    }

    /// e^{A t_k}, N x N.
    pub(crate) fn exponential(&self, k: usize) -> IntervalMatrix {
        let entries = intervals(self.ends(k, 0..self.states));
        IntervalMatrix::from_iterator(self.states, self.states, entries)
    }

    /// e^{A t_k} Γ(h_k), N x m.
    pub(crate) fn increment(&self, k: usize) -> IntervalMatrix {
        IntervalMatrix::from_iterator(self.states, self.inputs, intervals(self.increment_ends(k)))
    }

    /// Its lower and upper ends, column by column.
    pub(crate) fn increment_ends(&self, k: usize) -> impl Iterator<Item = (f64, f64)> {
        self.ends(k, self.states..self.states + self.inputs)
    }

    /// The lower and upper ends of some columns of pair k.
    pub(crate) fn ends(&self, k: usize, columns: Range<usize>) -> impl Iterator<Item = (f64, f64)> {
        let n = self.states;
        let start = |pair: usize| pair * n * (n + self.inputs);
        let shared =
            |k: usize| if k < self.first { k } else { self.first + (k - self.first) / TOGETHER };
        let columns = |pair: usize| start(pair) + columns.start * n..start(pair) + columns.end * n;
        self.mid[columns(k)]
            .iter()
            .zip(&self.rad[columns(shared(k))])
            .map(|(mid, rad)| (mid - rad, mid + rad))
    }

    /// At least the largest absolute value of each entry of the exponential over all samples, N x
    /// N.
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

/// e^{At}, which lies in `steps`, the power of one step, and in what its own series says.
fn leap(system: &LinearSystem, steps: &IntervalMatrix, t: Interval) -> IntervalMatrix {
    let whole = exponential::step(system, t).phi;
    steps.zip_map(&whole, |x, y| x.intersection(y).expect("both hold the exact entry"))
}

fn intervals(ends: impl Iterator<Item = (f64, f64)>) -> impl Iterator<Item = Interval> {
    ends.map(|(lo, hi)| Interval::new(lo, hi).unwrap_or(Interval::ENTIRE))
}

/// The pairs of the first samples, to be multiplied with later exponentials.
struct Block {
    mid: DMatrix<f64>,
    /// The largest of each entry over [`TOGETHER`] pairs: rad + (N + 2) u |mid| above |mid| + rad.
    spread: DMatrix<f64>,
    /// Which entries of a pair are zero whatever the time, N x (N + m).
    zero: DMatrix<bool>,
}

impl Block {
    fn new(system: &LinearSystem, samples: &Samples) -> Self {
        let zero = unlinked(system);
        let (n, width) = zero.shape();
        let mid = DMatrix::from_column_slice(n, width * samples.first, &samples.mid);
        // One unit more for the rounding of the two ends.
        let relative = relative_error(n + 1);
        let mut spread = DMatrix::zeros(2 * n, width * samples.first / TOGETHER);
        let columns = samples.mid.chunks_exact(n.max(1)).zip(samples.rad.chunks_exact(n.max(1)));
        for (at, (mid, rad)) in columns.enumerate() {
            let group = (at / (width * TOGETHER) * width + at % width) * 2 * n;
            let (of_errors, of_sizes) = spread.as_mut_slice()[group..group + 2 * n].split_at_mut(n);
            for (((mid, rad), error), size) in mid.iter().zip(rad).zip(of_errors).zip(of_sizes) {
                *error = larger(*error, add_up(*rad, mul_up(relative, mid.abs())));
                *size = larger(*size, add_up(*rad, mid.abs()));
            }
        }
        Self { mid, spread, zero }
    }

    /// The products of E, within `error` of `left`, with each pair P, and their radii.
    ///
    /// |E P - Ẽ P̃| <= |Ẽ| (rad P + (N + 1) u |P̃|) + rad E (|P̃| + rad P) where Ẽ P̃ is taken in floating point. One more u |Ẽ| |P̃| is above
    /// the rounding of Ẽ P̃ ± that.
    fn after(&self, left: &DMatrix<f64>, error: &DMatrix<f64>, mid: &mut [f64], rad: &mut [f64]) {
        let n = left.nrows();
        let mut sizes = DMatrix::zeros(n, 2 * n);
        sizes.columns_mut(0, n).copy_from(&left.abs());
        sizes.columns_mut(n, n).copy_from(error);
        DMatrixViewMut::from_slice(mid, n, self.mid.ncols()).gemm(1.0, left, &self.mid, 0.0);
        DMatrixViewMut::from_slice(rad, n, self.spread.ncols()).gemm(
            1.0,
            &sizes,
            &self.spread,
            0.0,
        );
        self.raise(rad);
    }

    /// Sums of products of sizes become upper bounds: ∞ where products may have overflowed, 0 where
    /// there are none.
    fn raise(&self, errors: &mut [f64]) {
        let upward = 1.0 + 2.0 * relative_error(2 * self.mid.nrows());
        for pair in errors.chunks_exact_mut(self.zero.len()) {
            for (error, &zero) in pair.iter_mut().zip(self.zero.as_slice()) {
                let raised = *error * upward + UNDERFLOW;
                let is_known = raised < FAR_FROM_OVERFLOW;
                *error = if zero {
                    0.0
                } else if is_known {
                    raised
                } else {
                    f64::INFINITY
                };
            }
        }
    }
}

/// Which entries of [e^{Aτ}, e^{Aτ} B] are zero for every τ.
fn unlinked(system: &LinearSystem) -> DMatrix<bool> {
    let (n, m) = (system.states(), system.inputs());
    let linked = connected(system.a());
    let reached =
        |i: usize, j: usize| (0..n).any(|via| linked[(i, via)] && system.b()[(via, j)] != 0.0);
    DMatrix::from_fn(n, n + m, |i, j| if j < n { !linked[(i, j)] } else { !reached(i, j - n) })
}

#[cfg(test)]
mod tests {
    use nalgebra::{dmatrix, dvector};

    use super::*;
    use crate::step;

    #[test]
    fn products_of_two_powers_hold_what_steps_one_by_one_reach() {
        let system = LinearSystem::new(
            dmatrix![0.0, 1.0, 0.0; -4.0, -0.1, 0.0; 0.0, 0.0, -2.0],
            dmatrix![0.0; 1.0; 0.5],
            dvector![0.0, 0.0, 0.0],
        )
        .unwrap();
        let step = step(&system, Interval::point(0.01));
        let one_by_one = Powers::uniform(&step.phi, 1000);
        let samples = Samples::uniform(&system, &step, Interval::point(0.01), 1000);
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
