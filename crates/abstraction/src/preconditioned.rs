//! Linear equations with a mass matrix that is known over a box only.

use std::sync::Arc;

use nalgebra::DMatrix;
use reachtube_robot::ltdl;
use reachtube_scalar::rounding::{add_up, div_up, mul_up, sub_down};
use reachtube_scalar::{Interval, TaylorModel, TaylorPolynomial, TaylorSpace};

use crate::equations::InputPolynomial;

/// Highest order of the series X of M⁻¹; a longer one helps little where it converges and harms
/// where it does not.
const SERIES_ORDER: u32 = 4;

/// A mass matrix M over a box, preconditioned with a series X of its inverse about the middle. M is
/// proved to be invertible everywhere in the box.
pub(crate) struct Preconditioned {
    /// M, row-major n x n.
    mass: Vec<TaylorModel>,
    /// The preconditioner X, row-major n x n: polynomials in the positions.
    inverse: Vec<TaylorModel>,
    /// Upper bounds of |1 - X M|, n x n.
    deviation: DMatrix<f64>,
    /// A vector w > 0 with |1 - X M| w < w, which proves that M is invertible.
    weights: Vec<f64>,
}

impl Preconditioned {
    /// Preconditions `mass`, row-major n x n; `None` where no proof of invertibility was found.
    pub(crate) fn new(mass: Vec<TaylorModel>, space: &Arc<TaylorSpace>) -> Option<Self> {
        let n = mass.len().isqrt();
        let inverse = inverse_series(&mass, space, SERIES_ORDER.min(space.order()));
        let entry = |i: usize, j: usize| {
            let products = (0..n).map(|k| &inverse[i * n + k] * &mass[k * n + j]);
            let one = TaylorModel::from(f64::from(i == j));
            products.fold(one, |rest, product| rest - product).range().mag()
        };
        let deviation = DMatrix::from_fn(n, n, entry);
        // The unrounded weights are a guess; the rounded comparison below is the proof.
        let weights = (DMatrix::identity(n, n) - &deviation).try_inverse()?.column_sum();
        let mass = Self { mass, inverse, deviation, weights: weights.iter().copied().collect() };
        let shrunk = mass.deviation_times(&mass.weights);
        let shrinks = shrunk.iter().zip(&mass.weights).all(|(s, w)| *w > 0.0 && s < w);
        shrinks.then_some(mass)
    }

    /// Returns the largest ratio of |1 - X M| w to w, unrounded: how far X is from the inverse.
    pub(crate) fn spread(&self) -> f64 {
        let shrunk = self.deviation_times(&self.weights);
        shrunk.iter().zip(&self.weights).map(|(s, w)| s / w).fold(0.0, f64::max)
    }

    /// Returns |1 - X M| v, rounded up, for v ≥ 0.
    fn deviation_times(&self, v: &[f64]) -> Vec<f64> {
        let row = |i: usize| {
            v.iter()
                .enumerate()
                .fold(0.0, |sum, (j, v)| add_up(sum, mul_up(self.deviation[(i, j)], *v)))
        };
        (0..v.len()).map(row).collect()
    }

    /// Returns X (l - M f), n: nearly the solution of M r = l - M f.
    pub(crate) fn residual(
        &self,
        load: &[InputPolynomial],
        acceleration: &[InputPolynomial],
    ) -> Vec<InputPolynomial> {
        let n = load.len();
        let residual: Vec<InputPolynomial> = (0..n)
            .map(|i| {
                let inertial = (0..n).map(|j| acceleration[j].scaled(&self.mass[i * n + j]));
                inertial.fold(load[i].clone(), |sum, term| sum - term)
            })
            .collect();
        let row = |i: usize| {
            let terms = (0..n).map(|j| residual[j].scaled(&self.inverse[i * n + j]));
            terms.fold(InputPolynomial::from(0.0), |sum, term| sum + term)
        };
        (0..n).map(row).collect()
    }

    /// Bounds the solution r of M r = ρ, given the ranges of X ρ; `None` where a bound is infinite.
    ///
    /// The solution satisfies r = X ρ + (1 - X M) r. Any α with |X ρ| ≤ α (w - |1 - X M| w) gives
    /// |r| ≤ α w, and |r| ≤ |X ρ| + |1 - X M| |r| then makes the bound smaller.
    ///
    /// # Guarantee
    ///
    /// Outer, with directed rounding: r lies in the bounds for every M and ρ over the box.
    pub(crate) fn solve(&self, load: &[Interval]) -> Option<Vec<Interval>> {
        let n = load.len();
        // |r| ≤ α w.
        let shrunk = self.deviation_times(&self.weights);
        let needed = |i: usize| div_up(load[i].mag(), sub_down(self.weights[i], shrunk[i]));
        let scale = (0..n).map(needed).fold(0.0, f64::max);
        let mut radius: Vec<f64> = self.weights.iter().map(|w| mul_up(scale, *w)).collect();
        // |r| ≤ |X ρ| + |1 - X M| |r|.
        for _ in 0..8 {
            let rest = self.deviation_times(&radius);
            radius = rest.iter().zip(load).map(|(rest, load)| add_up(load.mag(), *rest)).collect();
        }
        let rest = self.deviation_times(&radius);
        let bounds: Vec<Interval> =
            load.iter().zip(&rest).map(|(load, r)| *load + Interval::centred(0.0, *r)).collect();
        bounds.iter().all(|b| b.mag().is_finite()).then_some(bounds)
    }
}

/// Returns a series of M⁻¹ to `order` about the middle of the box, row-major n x n, in double
/// precision.
fn inverse_series(mass: &[TaylorModel], space: &Arc<TaylorSpace>, order: u32) -> Vec<TaylorModel> {
    let n = mass.len().isqrt();
    let indices: Vec<usize> = (0..space.variables()).collect();
    let low = TaylorSpace::new(space.variables(), order).expect("a lower order fits");
    let mut factors: Vec<TaylorPolynomial> =
        mass.iter().map(|m| m.polynomial().embedded(&low, &indices)).collect();
    ltdl::factor(&mut factors, n);
    let column = |j: usize| {
        let mut column: Vec<TaylorPolynomial> =
            (0..n).map(|i| TaylorPolynomial::from(f64::from(i == j))).collect();
        ltdl::solve(&factors, &mut column);
        column
    };
    let columns: Vec<_> = (0..n).map(column).collect();
    (0..n * n)
        .map(|ij| columns[ij % n][ij / n].embedded(space, &indices).stored_densely().into())
        .collect()
}
