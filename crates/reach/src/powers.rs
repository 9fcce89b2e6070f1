//! Products of many exponentials of one system: floating point, with bounds of the errors.

use nalgebra::DMatrix;
use reachtube_scalar::Interval;
use reachtube_scalar::rounding::{add_up, mul_up};

use crate::LinearSystem;
use crate::exponential::{Step, norm_upper, step};
use crate::matrix::{
    IntervalMatrix, accumulate_upward, ball, magnitude, midpoint, mul_upward, point, relative_error,
};

/// Norm of A s up to which e^{As} is enclosed for all shorter times at once.
const SHORT_STEP_NORM: f64 = 0.5;

/// Parts of one step at most; beyond, the bound is valid but large.
const MOST_SHORT_STEPS: f64 = 4096.0;

/// e^{A t_k} at the samples of a grid, each within `rad` of `mid`.
///
/// Intervals are never multiplied step after step, which would let them grow with every step. The
/// steps are done in floating point, the defect of each is bounded, δ_k = Ẽ_k Φ_k - Ẽ_{k+1}, and
/// the error of Ẽ_k is e_k = Σ_j δ_j e^{A(t_k - t_{j+1})}. Two bounds hold, and the smaller one is
/// taken entry by entry:
///
/// - |e_k| <= (Σ_j |δ_j|) M with M >= |e^{Aτ}| over the whole horizon, which grows linearly (M is
///   found a posteriori, see [`Rounded::bound`]);
/// - |e_{k+1}| <= |e_k| |Φ_k| + |δ_k|, which follows the growth or decay of a system whose entries
///   keep their signs.
pub(crate) struct Powers {
    pub(crate) mid: Vec<DMatrix<f64>>,
    pub(crate) rad: Vec<DMatrix<f64>>,
}

impl Powers {
    /// The first `count` powers of Φ = e^{Ah}.
    pub(crate) fn uniform(phi: &IntervalMatrix, count: usize) -> Self {
        let rounded = Rounded::new(phi.nrows(), count, &|_| phi);
        let bound = rounded.bound(&DMatrix::identity(phi.nrows(), phi.nrows()));
        Self { rad: rounded.errors(&|_| phi, &bound), mid: rounded.mid }
    }

    /// After each of `steps`, with P = `within_step` >= |e^{As}| for every s up to the longest.
    pub(crate) fn of_steps(steps: &[Step], within_step: &DMatrix<f64>) -> Self {
        let phi_at = |k: usize| &steps[k].phi;
        let rounded = Rounded::new(within_step.nrows(), steps.len() + 1, &phi_at);
        Self { rad: rounded.errors(&phi_at, &rounded.bound(within_step)), mid: rounded.mid }
    }

    /// e^{A t_k}.
    ///
    /// # Guarantee
    ///
    /// Outer, directed rounding.
    pub(crate) fn at(&self, k: usize) -> IntervalMatrix {
        ball(&self.mid[k], &self.rad[k])
    }
}

/// Floating-point e^{A t_k}, and bounds of the defects |δ_k| of its steps.
struct Rounded {
    mid: Vec<DMatrix<f64>>,
    defects: Vec<DMatrix<f64>>,
}

impl Rounded {
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

    /// The bounds of |e_k|.
    fn errors<'a>(
        &self,
        phi_at: &impl Fn(usize) -> &'a IntervalMatrix,
        bound: &DMatrix<f64>,
    ) -> Vec<DMatrix<f64>> {
        let mut total = self.mid[0].map(|_| 0.0);
        let mut errors = vec![total.clone()];
        for (k, defect) in self.defects.iter().enumerate() {
            accumulate_upward(&mut total, defect);
            let mut followed = mul_upward(&errors[k], &magnitude(phi_at(k)));
            accumulate_upward(&mut followed, defect);
            errors.push(followed.zip_map(&mul_upward(&total, bound), f64::min));
        }
        errors
    }

    /// M >= |e^{Aτ}| entrywise for every time τ of the horizon that is at most one step, bounded by
    /// P = `within_step`, after a sample; infinite when none is found.
    ///
    /// With P >= |e^{As}| over one step, D = Σ|δ_j| and M̃ = max_k |Ẽ_k|, any M with (M̃ + D M) P
    /// <= M bounds it, by induction over the samples:
    /// |e^{A t_k}| <= |Ẽ_k| + D M as long as M holds up to t_k, and from there to the next sample another factor P covers it. The left side
    /// of the inequality then is such an M as well, and a smaller one.
    fn bound(&self, within_step: &DMatrix<f64>) -> DMatrix<f64> {
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

/// W >= 0 such that the floating-point product of any matrix X with the midpoint of Φ is within |X|
/// W of the exact X Φ.
///
/// W = (N + 1) u |mid Φ| + rad Φ. Where a product underflows, the rounding of |X| W by at least one
/// unit for each product covers it.
fn product_error(phi: &IntervalMatrix) -> DMatrix<f64> {
    let relative = relative_error(phi.nrows());
    phi.map(|x| add_up(mul_up(relative, x.mid().abs()), x.rad()))
}

/// P >= |e^{As}| entrywise for 0 <= s <= h: a horizon in itself, of steps so short that one
/// enclosure over each is good enough.
pub(crate) fn bound_within_step(system: &LinearSystem, h: f64) -> DMatrix<f64> {
    let norm = norm_upper(&magnitude(&point(system.a())));
    // `max` is 1 for NaN too: an infinite norm over no time.
    let parts = MOST_SHORT_STEPS.min((norm * h / SHORT_STEP_NORM).ceil().max(1.0));
    let short = Interval::point(h) / parts;
    let short_step = step(system, short).phi;
    let rounded = Rounded::new(system.states(), parts as usize, &|_| &short_step);
    rounded.bound(&magnitude(&step(system, Interval::ZERO.hull(short)).phi))
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
    fn no_bound_is_infinite_not_wrong() {
        let growth = LinearSystem::new(dmatrix![60.0], dmatrix![1.0], dvector![0.0]).unwrap();
        let phi = step(&growth, Interval::point(0.01)).phi;
        assert_eq!(Rounded::new(1, 101, &|_| &phi).bound(&dmatrix![1.0])[(0, 0)], f64::INFINITY);
        let powers = Powers::uniform(&phi, 101);
        assert!(powers.at(100)[(0, 0)].contains(60f64.exp()));
    }
}
