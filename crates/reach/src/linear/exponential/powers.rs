//! Products of many exponentials of one system, in floating point with bounds of their errors.

use nalgebra::DMatrix;
use reachtube_scalar::Interval;
use reachtube_scalar::rounding::{add_up, mul_up};

use crate::linear::step::{PropagationStep, step};
use crate::linear::system::LinearSystem;
use crate::sets::interval_matrix::{IntervalMatrix, ball, magnitude, midpoint, point};
use crate::upward::{accumulate_upward, mul_upward, norm_upward, relative_error};

/// Largest norm of A s for which one enclosure of e^{As} covers all shorter times.
const SHORT_STEP_NORM: f64 = 0.5;

/// Largest number of parts of one step; beyond it, the bound is valid but large.
const MOST_SHORT_STEPS: f64 = 4096.0;

/// Enclosures of e^{A t_k} at the samples of a grid: each matrix lies within `rad` of `mid`.
///
/// Repeated products of interval matrices would widen with every step. Instead, the products Ẽ_k
/// are floating-point matrices and the defect δ_k = Ẽ_k Φ_k - Ẽ_{k+1} of each step is bounded. The
/// error of Ẽ_k is e_k = Σ_j δ_j e^{A(t_k - t_{j+1})}. Two bounds hold, and each entry takes the
/// smaller one:
///
/// - |e_k| <= (Σ_j |δ_j|) M with M >= |e^{Aτ}| over the whole horizon grows linearly with k where
///   e^{At} stays bounded; [`RoundedProducts::horizon_bound`] finds M a posteriori;
/// - |e_{k+1}| <= |e_k| |Φ_k| + |δ_k| follows the growth or decay of a system whose entries keep
///   their signs.
///
/// Where e^{At} grows to about 1/ε over the horizon, Σ|δ_j| is no longer small and no M is found.
/// The second bound alone is left. For entries that change sign, it grows exponentially faster than
/// the entries.
pub(crate) struct MatrixPowers {
    pub(crate) mid: Vec<DMatrix<f64>>,
    pub(crate) rad: Vec<DMatrix<f64>>,
}

impl MatrixPowers {
    /// Computes the first `count` powers of Φ = e^{Ah}, from the power 0 on.
    pub(crate) fn uniform(phi: &IntervalMatrix, count: usize) -> Self {
        let rounded = RoundedProducts::new(phi.nrows(), count, &|_| phi);
        let bound = rounded.horizon_bound(&DMatrix::identity(phi.nrows(), phi.nrows()));
        Self { rad: rounded.errors(&|_| phi, &bound), mid: rounded.mid }
    }

    /// Computes the exponential at the start and after each of `steps`.
    ///
    /// P = `within_step` must satisfy P >= |e^{As}| for every s up to the longest step.
    pub(crate) fn of_steps(steps: &[PropagationStep], within_step: &DMatrix<f64>) -> Self {
        let phi_at = |k: usize| &steps[k].phi;
        let rounded = RoundedProducts::new(within_step.nrows(), steps.len() + 1, &phi_at);
        let bound = rounded.horizon_bound(within_step);
        Self { rad: rounded.errors(&phi_at, &bound), mid: rounded.mid }
    }

    /// Returns e^{A t_k}, N x N.
    ///
    /// # Guarantee
    ///
    /// Outer, directed rounding.
    pub(crate) fn at(&self, k: usize) -> IntervalMatrix {
        ball(&self.mid[k], &self.rad[k])
    }
}

/// Floating-point products Ẽ_k of exponentials, and bounds of the defects |δ_k| of their steps.
struct RoundedProducts {
    mid: Vec<DMatrix<f64>>,
    defects: Vec<DMatrix<f64>>,
}

impl RoundedProducts {
    fn new<'a>(states: usize, count: usize, phi_at: &impl Fn(usize) -> &'a IntervalMatrix) -> Self {
        let mut mid = vec![DMatrix::identity(states, states)];
        let mut defects = Vec::new();
        for k in 1..count {
            let phi = phi_at(k - 1);
            defects.push(mul_upward(&mid[k - 1].abs(), &product_error(phi)));
            mid.push(&mid[k - 1] * midpoint(phi));
        }
        Self { mid, defects }
    }

    /// Bounds the errors |e_k|, given M = `bound`.
    fn errors<'a>(
        &self,
        phi_at: &impl Fn(usize) -> &'a IntervalMatrix,
        bound: &DMatrix<f64>,
    ) -> Vec<DMatrix<f64>> {
        let mut total = self.mid[0].map(|_| 0.0);
        let mut errors = vec![total.clone()];
        for (k, defect) in self.defects.iter().enumerate() {
            accumulate_upward(&mut total, defect);
            let mut carried = mul_upward(&errors[k], &magnitude(phi_at(k)));
            accumulate_upward(&mut carried, defect);
            errors.push(carried.zip_map(&mul_upward(&total, bound), f64::min));
        }
        errors
    }

    /// Finds M >= |e^{Aτ}| entrywise for every time τ from 0 to one step after the last sample;
    /// infinite when the search fails.
    ///
    /// Let P = `within_step` >= |e^{As}| over one step, D = Σ|δ_j| and M̃ = max_k |Ẽ_k|. Any M with
    /// (M̃ + D M) P <= M is a bound, by induction over the samples: |e^{A t_k}| <= |Ẽ_k| + D M
    /// where M holds up to t_k, and the factor P covers the times up to the next sample. The left
    /// side of the inequality is then a smaller bound, which is returned.
    fn horizon_bound(&self, within_step: &DMatrix<f64>) -> DMatrix<f64> {
        let mut largest = self.mid[0].clone();
        let mut defects = self.mid[0].map(|_| 0.0);
        for (mid, defect) in self.mid.iter().skip(1).zip(&self.defects) {
            largest.zip_apply(mid, |max, x| *max = max.max(x.abs()));
            accumulate_upward(&mut defects, defect);
        }
        let mut candidate = mul_upward(&largest, within_step) * 2.0;
        for _ in 0..8 {
            let mut inside = mul_upward(&defects, &candidate);
            accumulate_upward(&mut inside, &largest);
            let image = mul_upward(&inside, within_step);
            if image.iter().zip(&candidate).all(|(i, c)| i <= c && c.is_finite()) {
                return image;
            }
            candidate = candidate.sup(&image) * 2.0;
        }
        candidate.map(|_| f64::INFINITY)
    }
}

/// Returns W >= 0 such that the floating-point product of any matrix X with the midpoint of Φ is
/// within |X| W of the exact X Φ.
///
/// W = (N + 1) u |mid Φ| + rad Φ. Upward rounding of |X| W by at least one unit per product covers
/// products that underflow.
fn product_error(phi: &IntervalMatrix) -> DMatrix<f64> {
    let relative = relative_error(phi.nrows());
    phi.map(|x| add_up(mul_up(relative, x.mid().abs()), x.rad()))
}

/// Returns P >= |e^{As}| entrywise for 0 <= s <= h.
///
/// The interval is divided into parts so short that one enclosure covers each part tightly.
pub(crate) fn bound_within_step(system: &LinearSystem, h: f64) -> DMatrix<f64> {
    let norm = norm_upward(&magnitude(&point(system.a())));
    // An infinite norm times a zero step is NaN, for which `max` also returns 1.
    let parts = MOST_SHORT_STEPS.min((norm * h / SHORT_STEP_NORM).ceil().max(1.0));
    let short = Interval::point(h) / parts;
    let short_step = step(system, short).phi;
    let rounded = RoundedProducts::new(system.states(), parts as usize, &|_| &short_step);
    rounded.horizon_bound(&magnitude(&step(system, Interval::ZERO.hull(short)).phi))
}

#[cfg(test)]
mod tests {
    use nalgebra::{dmatrix, dvector};

    use super::*;

    fn rotation(omega: f64) -> LinearSystem {
        LinearSystem::new(dmatrix![0.0, omega; -omega, 0.0], dmatrix![0.0; 1.0], dvector![0.0, 0.0])
            .unwrap()
    }

    #[test]
    fn the_bound_within_a_long_step_does_not_grow_with_its_norm() {
        let bound = bound_within_step(&rotation(100.0), 0.5);
        assert!(bound.iter().all(|&p| (1.0..2.0).contains(&p)), "{bound}");
        let decay = LinearSystem::new(dmatrix![-80.0], dmatrix![1.0], dvector![0.0]).unwrap();
        assert!((1.0..2.0).contains(&bound_within_step(&decay, 1.0)[(0, 0)]));
    }

    #[test]
    fn a_bound_that_does_not_exist_is_infinite() {
        let growth = LinearSystem::new(dmatrix![60.0], dmatrix![1.0], dvector![0.0]).unwrap();
        let phi = step(&growth, Interval::point(0.01)).phi;
        let bound = RoundedProducts::new(1, 101, &|_| &phi).horizon_bound(&dmatrix![1.0]);
        assert_eq!(bound[(0, 0)], f64::INFINITY);
        let powers = MatrixPowers::uniform(&phi, 101);
        assert!(powers.at(100)[(0, 0)].contains(60f64.exp()));
    }
}
