//! Products of many exponentials of one system: floating point, with bounds of the errors.

use nalgebra::DMatrix;
use rayon::prelude::*;
use reachtube_scalar::Interval;
use reachtube_scalar::rounding::{add_up, mul_up};

use crate::LinearSystem;
use crate::exponential::{Step, connected, norm_upper, step};
use crate::matrix::{
    IntervalMatrix, UNDERFLOW, accumulate_upward, ball, magnitude, midpoint, mul_upward, point, product,
    radius, relative_error,
};

/// Norm of A s up to which e^{As} is enclosed for all shorter times at once.
const SHORT_STEP_NORM: f64 = 0.5;

/// Parts of one step at most; beyond, the bound is valid but large.
const MOST_SHORT_STEPS: f64 = 4096.0;

/// e^{A t_k} at the samples of a grid, each within `rad` of `mid`.
///
/// Intervals are never multiplied step after step, which would let them grow with every step. The steps are done in floating point, the
/// defect of each is bounded, δ_k = Ẽ_k Φ_k - Ẽ_{k+1}, and the error of Ẽ_k is e_k = Σ_j δ_j e^{A(t_k - t_{j+1})}. Two bounds hold, and the
/// smaller one is taken entry by entry:
///
/// - |e_k| <= (Σ_j |δ_j|) M with M >= |e^{Aτ}| over the whole horizon, which grows linearly (M is found a posteriori, see
///   [`Rounded::bound`]);
/// - |e_{k+1}| <= |e_k| |Φ_k| + |δ_k|, which follows the growth or decay of a system whose entries keep their signs.
pub(crate) struct Powers {
    mid: Vec<DMatrix<f64>>,
    rad: Vec<DMatrix<f64>>,
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

    /// M >= |e^{Aτ}| entrywise for every time τ of the horizon that is at most one step, bounded by P = `within_step`, after a sample;
    /// infinite when none is found.
    ///
    /// With P >= |e^{As}| over one step, D = Σ|δ_j| and M̃ = max_k |Ẽ_k|, any M with (M̃ + D M) P <= M bounds it, by induction over the samples:
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

/// W >= 0 such that the floating-point product of any matrix X with the midpoint of Φ is within |X| W of the exact X Φ.
///
/// W = (N + 1) u |mid Φ| + rad Φ. Where a product underflows, the rounding of |X| W by at least one unit for each product covers it.
fn product_error(phi: &IntervalMatrix) -> DMatrix<f64> {
    let relative = relative_error(phi.nrows());
    phi.map(|x| add_up(mul_up(relative, x.mid().abs()), x.rad()))
}

/// P >= |e^{As}| entrywise for 0 <= s <= h: a horizon in itself, of steps so short that one enclosure over each is good enough.
pub(crate) fn bound_within_step(system: &LinearSystem, h: f64) -> DMatrix<f64> {
    let norm = norm_upper(&magnitude(&point(system.a())));
    // `max` is 1 for NaN too: an infinite norm over no time.
    let parts = MOST_SHORT_STEPS.min((norm * h / SHORT_STEP_NORM).ceil().max(1.0));
    let short = Interval::point(h) / parts;
    let short_step = step(system, short).phi;
    let rounded = Rounded::new(system.states(), parts as usize, &|_| &short_step);
    rounded.bound(&magnitude(&step(system, Interval::ZERO.hull(short)).phi))
}

/// What a linear system does at the samples of a grid.
pub(crate) struct Samples {
    /// e^{A t_k} at each sample.
    pub(crate) exponential: Vec<IntervalMatrix>,
    /// e^{A t_k} Γ(h_k) of each step at least, by which Γ grows.
    pub(crate) increments: Vec<IntervalMatrix>,
}

impl Samples {
    /// Of so many samples, `steps` between them, with P = `within_step` >= |e^{As}| for every s up to the longest.
    pub(crate) fn after(steps: &[Step], count: usize, within_step: &DMatrix<f64>) -> Self {
        let powers = Powers::of_steps(steps, within_step);
        let exponential: Vec<_> = (0..count).into_par_iter().map(|k| powers.at(k)).collect();
        let increment = |(start, step): (&IntervalMatrix, &Step)| product(start, &step.gamma);
        let increments = exponential.par_iter().zip(steps).map(increment).collect();
        Self { exponential, increments }
    }

    /// At t_k = k h for k < count.
    ///
    /// With k = b L + j, L about √count, both are the product of e^{A b L h} with those of j: neither factor takes more than √count steps,
    /// and the products, which are most of the work, are large and independent of each other.
    pub(crate) fn uniform(system: &LinearSystem, step: &Step, count: usize) -> Self {
        let length = count.isqrt().max(1);
        let short = Powers::uniform(&step.phi, length + 1);
        let long = Powers::uniform(&short.at(length), count.div_ceil(length));
        let first = FirstPairs::new(system, step, &short, length);
        let later = long.mid.par_iter().zip(&long.rad).skip(1);
        let blocks: Vec<_> = later.map(|(mid, rad)| first.after(mid, rad)).collect();
        let pairs = first.pairs.into_iter().chain(blocks.into_iter().flatten());
        let (exponential, increments) = pairs.take(count).unzip();
        Self { exponential, increments }
    }
}

/// e^{A t_k} and e^{A t_k} Γ(h).
type Pair = (IntervalMatrix, IntervalMatrix);

/// The pairs of the first samples.
struct FirstPairs {
    pairs: Vec<Pair>,
    /// Midpoints of all, side by side.
    mid: DMatrix<f64>,
    /// rad + (N + 2) u |mid| above |mid| + rad.
    spread: DMatrix<f64>,
    /// Which entries of a pair are zero whatever the time, N x (N + m).
    zero: DMatrix<bool>,
}

impl FirstPairs {
    fn new(system: &LinearSystem, step: &Step, short: &Powers, length: usize) -> Self {
        let zero = unlinked(system);
        let (n, width) = zero.shape();
        let pair = |j: usize| (short.at(j), product(&short.at(j), &step.gamma));
        let pairs: Vec<Pair> = (0..length).map(pair).collect();
        let entries = pairs.iter().flat_map(|(exponential, increment)| exponential.iter().chain(increment));
        let all = IntervalMatrix::from_iterator(n, width * length, entries.copied());
        let (mid, rad) = (midpoint(&all), radius(&all));
        // One unit more for the rounding of the two ends.
        let relative = relative_error(n + 1);
        let mut spread = DMatrix::zeros(2 * n, width * length);
        spread.rows_mut(0, n).copy_from(&mid.zip_map(&rad, |m, r| add_up(r, mul_up(relative, m.abs()))));
        spread.rows_mut(n, n).copy_from(&mid.zip_map(&rad, |m, r| add_up(r, m.abs())));
        Self { pairs, mid, spread, zero }
    }

    /// The products of E, within `rad` of `mid`, with each pair P.
    ///
    /// |E P - Ẽ P̃| <= |Ẽ| (rad P + (N + 1) u |P̃|) + rad E (|P̃| + rad P) where Ẽ P̃ is taken in floating point. One more u |Ẽ| |P̃| is above
    /// the rounding of Ẽ P̃ ± that.
    fn after(&self, mid: &DMatrix<f64>, rad: &DMatrix<f64>) -> Vec<Pair> {
        let n = mid.nrows();
        let mut sizes = DMatrix::zeros(n, 2 * n);
        sizes.columns_mut(0, n).copy_from(&mid.abs());
        sizes.columns_mut(n, n).copy_from(rad);
        let (products, errors) = (mid * &self.mid, sizes * &self.spread);
        let upward = 1.0 + 2.0 * relative_error(2 * n);
        let around = |mid: f64, error: f64| {
            let rad = error * upward + UNDERFLOW;
            Interval::new(mid - rad, mid + rad).unwrap_or(Interval::ENTIRE)
        };
        let size = self.zero.len();
        let pairs = products.as_slice().chunks_exact(size).zip(errors.as_slice().chunks_exact(size));
        let entries =
            |(mid, error): (&[f64], &[f64])| self.pair(mid.iter().zip(error).map(|(m, e)| around(*m, *e)));
        pairs.map(entries).collect()
    }

    /// The pair of these `entries`, column by column, but zero where it always is.
    fn pair(&self, entries: impl Iterator<Item = Interval>) -> Pair {
        let (n, width) = self.zero.shape();
        let mut kept = entries.zip(self.zero.iter()).map(|(x, &zero)| if zero { Interval::ZERO } else { x });
        let exponential = IntervalMatrix::from_iterator(n, n, kept.by_ref().take(n * n));
        (exponential, IntervalMatrix::from_iterator(n, width - n, kept))
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

    fn rotation(omega: f64) -> LinearSystem {
        LinearSystem::new(dmatrix![0.0, omega; -omega, 0.0], dmatrix![0.0; 1.0], dvector![0.0, 0.0]).unwrap()
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
        let samples = Samples::uniform(&system, &step, 1000);
        assert_eq!(samples.exponential.len(), 1000);
        for (k, (exponential, increment)) in samples.exponential.iter().zip(&samples.increments).enumerate() {
            let other = one_by_one.at(k);
            for (x, y) in exponential.iter().zip(&other) {
                assert!(
                    x.intersection(*y).is_some() && x.width() < 2.5 * y.width() + 1e-14,
                    "{k}: {x:?} {y:?}"
                );
            }
            for (x, y) in increment.iter().zip(&product(&other, &step.gamma)) {
                assert!(x.intersection(*y).is_some() && x.hull(*y).width() < 1e-13, "{k}: {x:?} {y:?}");
            }
            assert_eq!(exponential[(0, 2)], Interval::ZERO);
        }
    }
}
