//! e^{A t_k} and e^{A t_k} Γ(h_k) at the samples of a grid.

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

/// So many samples, one after another, share the bounds of their errors.
const TOGETHER: usize = 6;

/// The pairs [e^{A t_k}, e^{A t_k} Γ(h_k)], N x (N + m), at the samples of a grid; by the second, Γ grows over step k.
///
/// Their ends are apart and side by side, column by column: what is done to all is done to long rows of numbers.
#[derive(Debug, Clone)]
pub(crate) struct Samples {
    states: usize,
    inputs: usize,
    lo: Vec<f64>,
    hi: Vec<f64>,
}

impl Samples {
    /// Of so many samples, `steps` between them, with P = `within_step` >= |e^{As}| for every s up to the longest. After the last sample there
    /// is no step, and no increment.
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
            let increment = steps.get(k).map_or_else(|| none.clone(), |step| product(&start, &step.gamma));
            [start, increment]
        };
        Self::from_pairs(system, (0..count).into_par_iter().map(pair).collect())
    }

    fn from_pairs(system: &LinearSystem, pairs: Vec<[IntervalMatrix; 2]>) -> Self {
        let (states, inputs) = (system.states(), system.inputs());
        let size = pairs.len() * states * (states + inputs);
        let mut samples = Self { states, inputs, lo: Vec::with_capacity(size), hi: Vec::with_capacity(size) };
        for matrix in pairs.iter().flatten() {
            samples.lo.extend(matrix.as_slice().iter().map(|x| x.lo()));
            samples.hi.extend(matrix.as_slice().iter().map(|x| x.hi()));
        }
        samples
    }

    /// At t_k = k h for k < count; `step` is that of length h.
    ///
    /// With k = b L + j, L about √count, the pair is the product of e^{A b L h} with the pair at j: neither factor takes more than √count
    /// steps, and the products, which are most of the work, are large and independent of each other.
    pub(crate) fn uniform(system: &LinearSystem, step: &Step, h: Interval, count: usize) -> Self {
        let length = count.isqrt().max(1);
        let short = Powers::uniform(&step.phi, length + 1);
        let pair = |j: usize| [short.at(j), product(&short.at(j), &step.gamma)];
        let (first, long) = rayon::join(
            || Self::from_pairs(system, (0..length).map(pair).collect()),
            || Powers::uniform(&leap(system, &short.at(length), h * length as f64), count.div_ceil(length)),
        );
        let (block, size) = (Block::new(system, &first), first.lo.len());
        // Zeros that nobody has written yet cost nothing until the threads come to them.
        let all = || vec![0.0; size * long.mid.len()];
        let mut samples = Self { lo: all(), hi: all(), ..first };
        samples.lo[..size].copy_from_slice(&first.lo);
        samples.hi[..size].copy_from_slice(&first.hi);
        let blocks =
            samples.lo.par_chunks_exact_mut(size.max(1)).zip(samples.hi.par_chunks_exact_mut(size.max(1)));
        let factors = long.mid.par_iter().zip(&long.rad);
        blocks.zip(factors).skip(1).for_each(|((lo, hi), (mid, rad))| block.after(mid, rad, lo, hi));
        let kept = count * block.zero.len();
        samples.lo.truncate(kept);
        samples.hi.truncate(kept);
        samples
    }

    /// e^{A t_k}, N x N.
    pub(crate) fn exponential(&self, k: usize) -> IntervalMatrix {
        let (lo, hi) = self.ends(k);
        IntervalMatrix::from_iterator(
            self.states,
            self.states,
            intervals(lo, hi).take(self.states * self.states),
        )
    }

    /// e^{A t_k} Γ(h_k), N x m.
    pub(crate) fn increment(&self, k: usize) -> IntervalMatrix {
        let ((lo, hi), start) = (self.ends(k), self.states * self.states);
        IntervalMatrix::from_iterator(self.states, self.inputs, intervals(&lo[start..], &hi[start..]))
    }

    /// Its lower and upper ends, column by column.
    pub(crate) fn increment_ends(&self, k: usize) -> impl Iterator<Item = (f64, f64)> {
        let ((lo, hi), start) = (self.ends(k), self.states * self.states);
        lo[start..].iter().copied().zip(hi[start..].iter().copied())
    }

    /// The lower and the upper ends of pair k, column by column.
    pub(crate) fn ends(&self, k: usize) -> (&[f64], &[f64]) {
        let size = self.states * (self.states + self.inputs);
        let pair = k * size..(k + 1) * size;
        (&self.lo[pair.clone()], &self.hi[pair])
    }

    /// The largest absolute value of each entry of the exponential over all samples, N x N.
    pub(crate) fn largest(&self) -> DMatrix<f64> {
        let n = self.states;
        let mut largest = vec![0.0; n * n];
        for ends in [&self.lo, &self.hi] {
            for pair in ends.chunks_exact((n * (n + self.inputs)).max(1)) {
                largest.iter_mut().zip(pair).for_each(|(max, x)| *max = larger(x.abs(), *max));
            }
        }
        DMatrix::from_vec(n, n, largest)
    }
}

/// e^{At}, which lies in `steps`, the power of one step, and in what its own series says.
fn leap(system: &LinearSystem, steps: &IntervalMatrix, t: Interval) -> IntervalMatrix {
    let whole = exponential::step(system, t).phi;
    steps.zip_map(&whole, |x, y| x.intersection(y).expect("both hold the exact entry"))
}

fn intervals(lo: &[f64], hi: &[f64]) -> impl Iterator<Item = Interval> {
    lo.iter().zip(hi).map(|(&lo, &hi)| Interval::new(lo, hi).unwrap_or(Interval::ENTIRE))
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
        let columns = samples.lo.len() / n.max(1);
        let mid = DMatrix::from_iterator(n, columns, intervals(&samples.lo, &samples.hi).map(Interval::mid));
        // One unit more for the rounding of the two ends.
        let relative = relative_error(n + 1);
        let mut spread = DMatrix::zeros(2 * n, columns.div_ceil(width * TOGETHER) * width);
        let (groups, rows) = (spread.as_mut_slice(), 2 * n);
        let ends = samples.lo.chunks_exact(n.max(1)).zip(samples.hi.chunks_exact(n.max(1)));
        for (at, (lo, hi)) in ends.enumerate() {
            let group = at / (width * TOGETHER) * width + at % width;
            let (of_errors, of_sizes) = groups[group * rows..(group + 1) * rows].split_at_mut(n);
            for ((x, error), size) in intervals(lo, hi).zip(of_errors).zip(of_sizes) {
                let (mid, rad) = (x.mid().abs(), x.rad());
                *error = larger(*error, add_up(rad, mul_up(relative, mid)));
                *size = larger(*size, add_up(rad, mid));
            }
        }
        Self { mid, spread, zero }
    }

    /// The ends of the products of E, within `rad` of `mid`, with each pair P.
    ///
    /// |E P - Ẽ P̃| <= |Ẽ| (rad P + (N + 1) u |P̃|) + rad E (|P̃| + rad P) where Ẽ P̃ is taken in floating point. One more u |Ẽ| |P̃| is above
    /// the rounding of Ẽ P̃ ± that.
    fn after(&self, mid: &DMatrix<f64>, rad: &DMatrix<f64>, lo: &mut [f64], hi: &mut [f64]) {
        let (n, columns) = self.mid.shape();
        let mut sizes = DMatrix::zeros(n, 2 * n);
        sizes.columns_mut(0, n).copy_from(&mid.abs());
        sizes.columns_mut(n, n).copy_from(rad);
        let mut errors = sizes * &self.spread;
        self.raise(&mut errors);
        DMatrixViewMut::from_slice(lo, n, columns).gemm(1.0, mid, &self.mid, 0.0);
        let size = self.zero.len();
        let groups = lo.chunks_mut(size * TOGETHER).zip(hi.chunks_mut(size * TOGETHER));
        for ((lo, hi), errors) in groups.zip(errors.as_slice().chunks_exact(size)) {
            for (lo, hi) in lo.chunks_exact_mut(size).zip(hi.chunks_exact_mut(size)) {
                for ((lo, hi), &error) in lo.iter_mut().zip(hi).zip(errors) {
                    let is_known = error < FAR_FROM_OVERFLOW;
                    let mid = if is_known { *lo } else { 0.0 };
                    (*lo, *hi) = (mid - error, mid + error);
                }
            }
        }
    }

    /// Sums of products of sizes become upper bounds: ∞ where products may have overflowed, 0 where there are none.
    fn raise(&self, errors: &mut DMatrix<f64>) {
        let upward = 1.0 + 2.0 * relative_error(2 * self.mid.nrows());
        for pair in errors.as_mut_slice().chunks_exact_mut(self.zero.len()) {
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
    let reached = |i: usize, j: usize| (0..n).any(|via| linked[(i, via)] && system.b()[(via, j)] != 0.0);
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
                assert!(x.intersection(*y).is_some() && x.width() <= y.width() + 1e-14, "{k}: {x:?} {y:?}");
            }
            for (x, y) in increment.iter().zip(&product(&other, &step.gamma)) {
                assert!(x.intersection(*y).is_some() && x.hull(*y).width() < 1e-13, "{k}: {x:?} {y:?}");
            }
            assert_eq!(exponential[(0, 2)], Interval::ZERO);
        }
    }
}
