//! The floating-point matrix exponential with a bound of its error, fast enough for every step.

use reachtube_scalar::Interval;
use reachtube_scalar::rounding::mul_up;

use crate::linear::phi1_series::truncation;
use crate::sets::square_matrix::SquareMatrix;
use crate::upward::round_up_sum;

/// Truncation error allowed in the bound P of e^{|A|h}.
const COARSE: f64 = 1e-6;

/// Floating-point Φ = e^{Ah} and φ₁ = Σ (Ah)ⁱ/(i+1)!, with ∫₀ʰ e^{As} ds = h φ₁; bounds of their
/// errors; and P >= e^{|A|h}.
///
/// # Guarantee
///
/// For v >= 0, |exact Φ - Φ| v and |exact φ₁ - φ₁| v are at most [`error_times`](Self::error_times)
/// v, and [`bound_times`](Self::bound_times) v is at least e^{|A|s} v for 0 <= s <= h.
///
/// Horner's scheme of degree p forms each product of i factors A h with at most K = (p + 1)(n + 6)
/// roundings, the roundings of h and A h included. Its error is at most γ_K times the same
/// polynomial in
/// |A| h, which is at most P (Higham, section 3.1). The truncation error of the series is bounded
/// in the maximum norm.
#[derive(Debug)]
pub(crate) struct RoundedExponential {
    pub phi: SquareMatrix,
    pub phi1: SquareMatrix,
    /// P without its truncated terms.
    bound: SquareMatrix,
    /// Bound of the truncated terms in each entry of P.
    bound_tail: f64,
    /// Rounding error of Φ and φ₁, relative to P.
    relative: f64,
    /// Truncation error of each entry of Φ and φ₁.
    tail: f64,
    /// Whether each row of A has an entry other than 0. In a row without, Φ, φ₁ and P are exactly
    /// the identity, so that a state whose derivative is zero stays constant.
    moves: Vec<bool>,
    /// Scratch memory: A h.
    x: SquareMatrix,
    /// Scratch memory of Horner's scheme.
    spare: SquareMatrix,
}

impl RoundedExponential {
    pub(crate) fn new(n: usize) -> Self {
        let zero = || SquareMatrix::zero(n);
        let (phi, phi1, bound, x, spare) = (zero(), zero(), zero(), zero(), zero());
        let moves = vec![true; n];
        Self { phi, phi1, bound, bound_tail: 0.0, relative: 0.0, tail: 0.0, moves, x, spare }
    }

    /// Computes the exponential for A and a step h >= 0 that is known to one rounding; returns
    /// whether its error is finite.
    pub(crate) fn update(&mut self, a: &SquareMatrix, h: Interval) -> bool {
        let n = a.n;
        self.x.entries.iter_mut().zip(&a.entries).for_each(|(x, a)| *x = a * h.mid());
        for (i, moves) in self.moves.iter_mut().enumerate() {
            *moves = a.row(i).iter().any(|x| *x != 0.0);
        }
        let row_sum = |i: usize| round_up_sum(a.row(i).iter().map(|x| x.abs()).sum(), n);
        let norm = mul_up((0..n).map(row_sum).fold(0.0, f64::max), h.hi());
        let (degree, tail) = truncation(norm);
        if !(tail.is_finite() && a.entries.iter().all(|a| a.is_finite())) {
            return false;
        }
        horner(&self.x, degree, 1.0, &mut self.phi1, &mut self.spare);
        self.phi.set_product(&self.x, &self.phi1);
        add_identity(&mut self.phi);
        self.relative = 2.0 * f64::EPSILON * ((degree + 1) * (n + 6)) as f64;
        self.tail = 2.0 * tail * (1.0 + norm);
        self.bound_above(norm);
        true
    }

    /// Computes P with as few terms as its tail allows.
    fn bound_above(&mut self, norm: f64) {
        self.x.entries.iter_mut().for_each(|x| *x = x.abs());
        let (mut degree, mut term) = (1, norm);
        loop {
            let next = term * norm / (degree + 1) as f64;
            let ratio = norm / (degree + 2) as f64;
            if ratio < 0.5 && next < COARSE {
                self.bound_tail = 4.0 * next;
                break;
            }
            (degree, term) = (degree + 1, next);
        }
        horner(&self.x, degree, 0.0, &mut self.bound, &mut self.spare);
        let above =
            1.0 + self.relative.max(2.0 * f64::EPSILON * ((degree + 1) * (self.x.n + 6)) as f64);
        self.bound.entries.iter_mut().for_each(|p| *p *= above);
    }

    /// Sets `out` to an upper bound of P v for v >= 0.
    pub(crate) fn bound_times(&self, v: &[f64], out: &mut [f64]) {
        self.bound.apply_absolute(v, out);
        let truncated = round_up_sum(v.iter().sum::<f64>() * self.bound_tail, v.len());
        for ((out, v), moves) in out.iter_mut().zip(v).zip(&self.moves) {
            *out = if *moves { (*out + truncated) * (1.0 + f64::EPSILON) } else { *v };
        }
    }

    /// Sets `out` to an upper bound of the rounding error of the products of Φ with vectors whose
    /// magnitudes are at most v >= 0.
    pub(crate) fn rounding_times(&self, v: &[f64], out: &mut [f64]) {
        self.phi.apply_absolute(v, out);
        let relative = product_error(v.len());
        for (out, moves) in out.iter_mut().zip(&self.moves) {
            *out = if *moves { round_up_sum(*out * relative, 1) } else { 0.0 };
        }
    }

    /// Sets `out` to an upper bound of |error| v for v >= 0, for Φ and for φ₁.
    pub(crate) fn error_times(&self, v: &[f64], out: &mut [f64]) {
        self.bound_times(v, out);
        let truncated = round_up_sum(v.iter().sum::<f64>() * self.tail, v.len());
        for (out, moves) in out.iter_mut().zip(&self.moves) {
            let error = round_up_sum(*out * self.relative + truncated, 4);
            *out = if *moves { error } else { 0.0 };
        }
    }
}

/// Bounds the relative error of a sum of n products times one more factor (Higham, section 3.1).
fn product_error(n: usize) -> f64 {
    (n + 4) as f64 * f64::EPSILON
}

/// Sets `sum` to Σ_{i<=degree} Xⁱ / (i + skip)! times skip!.
fn horner(
    x: &SquareMatrix,
    degree: usize,
    skip: f64,
    sum: &mut SquareMatrix,
    spare: &mut SquareMatrix,
) {
    sum.entries.fill(0.0);
    add_identity(sum);
    for i in (1..=degree).rev() {
        spare.set_product(x, sum);
        let divisor = i as f64 + skip;
        sum.entries.iter_mut().zip(&spare.entries).for_each(|(sum, x)| *sum = x / divisor);
        add_identity(sum);
    }
}

fn add_identity(square: &mut SquareMatrix) {
    square.entries.iter_mut().step_by(square.n + 1).for_each(|x| *x += 1.0);
}

#[cfg(test)]
mod tests {
    use nalgebra::{DMatrix, DVector};
    use proptest::prelude::*;

    use super::*;
    use crate::linear::step::step;
    use crate::linear::system::LinearSystem;

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(200))]
        /// The interval exponential is computed in another way, with other roundings.
        #[test]
        fn the_error_covers_the_enclosed_exponential(
            entries in prop::collection::vec(-3.0..3.0_f64, 16), h in 1e-6..0.6_f64,
        ) {
            let a = DMatrix::from_row_slice(4, 4, &entries);
            let (identity, drift) = (DMatrix::identity(4, 4), DVector::zeros(4));
            let system = LinearSystem::new(a.clone(), identity, drift.clone()).unwrap();
            let exact = step(&system, Interval::point(h));
            let magnitudes = LinearSystem::new(a.abs(), DMatrix::zeros(4, 0), drift).unwrap();
            let largest = step(&magnitudes, Interval::point(h)).phi;
            let mut rounded = RoundedExponential::new(4);
            let square = SquareMatrix { n: 4, entries };
            prop_assert!(rounded.update(&square, Interval::point(h)));
            for j in 0..4 {
                let unit = [0, 1, 2, 3].map(|i| f64::from(i == j));
                let (mut error, mut bound) = ([0.0; 4], [0.0; 4]);
                rounded.error_times(&unit, &mut error);
                rounded.bound_times(&unit, &mut bound);
                for i in 0..4 {
                    let near = |x: f64| Interval::centred(x, error[i]);
                    let phi = rounded.phi.row(i)[j];
                    prop_assert!(near(phi).intersection(exact.phi[(i, j)]).is_some());
                    prop_assert!(error[i] < 1e-12 * largest[(i, j)].hi() + 1e-12);
                    let integral = near(rounded.phi1.row(i)[j]) * h;
                    prop_assert!(integral.intersection(exact.gamma[(i, j)]).is_some());
                    let largest = largest[(i, j)];
                    prop_assert!(bound[i] >= largest.lo() && bound[i] <= largest.hi() + 1e-5);
                }
            }
        }
    }

    #[test]
    fn a_step_too_long_or_not_a_number_has_no_bound() {
        let mut rounded = RoundedExponential::new(1);
        assert!(!rounded.update(&SquareMatrix { n: 1, entries: vec![1e4] }, Interval::ONE));
        assert!(!rounded.update(&SquareMatrix { n: 1, entries: vec![f64::NAN] }, Interval::ONE));
    }
}
