//! Linear equations with a mass matrix that is known over a box only.

use nalgebra::DMatrix;
use reachtube_scalar::rounding::{add_up, div_up, mul_up, sub_down};
use reachtube_scalar::{Interval, TaylorModel};

/// A mass matrix M over a box, preconditioned with the inverse P of its midpoint. M is proved to be
/// invertible everywhere in the box.
pub(crate) struct Preconditioned {
    /// The preconditioner P, n x n.
    inverse: DMatrix<f64>,
    /// Enclosure of 1 - P M, row-major n x n.
    deviation: Vec<Interval>,
    /// A vector w > 0 with |1 - P M| w < w, which proves that M is invertible.
    weights: Vec<f64>,
}

impl Preconditioned {
    /// Preconditions `mass`, row-major n x n; `None` where no proof of invertibility was found.
    pub(crate) fn new(mass: &[TaylorModel]) -> Option<Self> {
        let n = mass.len().isqrt();
        let ranges: Vec<Interval> = mass.iter().map(TaylorModel::range).collect();
        let inverse = DMatrix::from_fn(n, n, |i, j| ranges[i * n + j].mid()).try_inverse()?;
        let entry = |i: usize, j: usize| {
            let product: Interval = (0..n).map(|k| ranges[k * n + j] * inverse[(i, k)]).sum();
            Interval::point(f64::from(i == j)) - product
        };
        let deviation: Vec<Interval> = (0..n * n).map(|ij| entry(ij / n, ij % n)).collect();
        let magnitude = DMatrix::from_fn(n, n, |i, j| deviation[i * n + j].mag());
        // The unrounded weights are a guess; the rounded comparison below is the proof.
        let weights = (DMatrix::identity(n, n) - magnitude).try_inverse()?.column_sum();
        let mass = Self { inverse, deviation, weights: weights.iter().copied().collect() };
        let shrunk = mass.magnitude_times(&mass.weights);
        let shrinks = shrunk.iter().zip(&mass.weights).all(|(s, w)| *w > 0.0 && s < w);
        shrinks.then_some(mass)
    }

    /// Returns the row-sum norm of |1 - P M|, unrounded: the relative spread of M.
    pub(crate) fn spread(&self) -> f64 {
        let n = self.weights.len();
        self.deviation.chunks(n).map(|row| row.iter().map(|d| d.mag()).sum()).fold(0.0, f64::max)
    }

    /// Returns |1 - P M| v, rounded up, for v ≥ 0.
    fn magnitude_times(&self, v: &[f64]) -> Vec<f64> {
        let row = |row: &[Interval]| {
            row.iter().zip(v).fold(0.0, |sum, (d, v)| add_up(sum, mul_up(d.mag(), *v)))
        };
        self.deviation.chunks(v.len()).map(row).collect()
    }

    /// Bounds the solution r of M r = ρ and returns the bounds with P ρ; `None` where they are
    /// infinite.
    ///
    /// The solution satisfies r = P ρ + (1 - P M) r. Any α with |P ρ| ≤ α (w - |1 - P M| w) gives
    /// |r| ≤ α w, and |r| ≤ |P ρ| + |1 - P M| |r| then makes the bound smaller.
    ///
    /// # Guarantee
    ///
    /// Outer, with directed rounding: r lies in the bounds for every M and ρ over the box.
    pub(crate) fn solve(
        &self,
        residual: &[TaylorModel],
    ) -> Option<(Vec<Interval>, Vec<TaylorModel>)> {
        // P ρ.
        let n = residual.len();
        let load = |i: usize| {
            let terms = (0..n).map(|j| &TaylorModel::from(self.inverse[(i, j)]) * &residual[j]);
            terms.fold(TaylorModel::from(0.0), |sum, term| &sum + &term)
        };
        let load: Vec<TaylorModel> = (0..n).map(load).collect();
        let ranges: Vec<Interval> = load.iter().map(TaylorModel::range).collect();
        // |r| ≤ α w.
        let shrunk = self.magnitude_times(&self.weights);
        let needed = |i: usize| div_up(ranges[i].mag(), sub_down(self.weights[i], shrunk[i]));
        let scale = (0..n).map(needed).fold(0.0, f64::max);
        let mut radius: Vec<f64> = self.weights.iter().map(|w| mul_up(scale, *w)).collect();
        // |r| ≤ |P ρ| + |1 - P M| |r|.
        for _ in 0..4 {
            let rest = self.magnitude_times(&radius);
            radius =
                rest.iter().zip(&ranges).map(|(rest, load)| add_up(load.mag(), *rest)).collect();
        }
        let rest = self.magnitude_times(&radius);
        let bounds: Vec<Interval> =
            ranges.iter().zip(&rest).map(|(load, r)| *load + Interval::centred(0.0, *r)).collect();
        let finite = bounds.iter().all(|b| b.mag().is_finite());
        finite.then_some((bounds, load))
    }
}
