//! The rigorous matrix exponential over one step.

use nalgebra::DMatrix;
use reachtube_scalar::Interval;
use reachtube_scalar::rounding::{add_up, div_up, mul_up, sub_down};

use crate::LinearSystem;
use crate::matrix::{IntervalMatrix, IntervalVector, add_product, magnitude, point, product};

/// Norm of A h below which the Taylor series is summed; above it, h is halved and the result
/// squared.
const SERIES_NORM: f64 = 0.5;

/// What one step of length h does to a linear system with constant input: x(h) = Φ x(0) + Γ u + γ.
#[derive(Debug, Clone)]
pub struct Step {
    /// Φ = e^{Ah}, N x N.
    pub phi: IntervalMatrix,
    /// Γ = ∫₀ʰ e^{Aτ} dτ B, N x m.
    pub gamma: IntervalMatrix,
    /// γ = ∫₀ʰ e^{Aτ} dτ d, N.
    pub drift: IntervalVector,
}

/// The step of `system` for every length in `h` (s, h >= 0).
///
/// # Guarantee
///
/// Outer, proved with directed rounding: for every real h in the interval, Φ, Γ and γ lie in the
/// matrices returned. An entry that is zero for every h (no path through A) is the point 0.
pub fn step(system: &LinearSystem, h: Interval) -> Step {
    let (halvings, small) = halve(system, h);
    let n = system.states();
    let x = point(system.a()) * small;
    let phi1 = phi1_series(&x, &connected(system.a()));
    let mut phi = IntervalMatrix::identity(n, n) + product(&x, &phi1);
    let integral = phi1 * small;
    let mut gamma = product(&integral, &point(system.b()));
    let mut drift = integral * system.drift().map(Interval::point);
    for _ in 0..halvings {
        gamma += product(&phi, &gamma);
        drift = &drift + &phi * &drift;
        phi = product(&phi, &phi);
    }
    Step { phi, gamma, drift }
}

fn halve(system: &LinearSystem, h: Interval) -> (u32, Interval) {
    let mut small = h;
    let mut halvings = 0;
    let norm = norm_upper(&magnitude(&point(system.a())));
    while norm.is_finite() && mul_up(norm, small.hi()) > SERIES_NORM && halvings < 1000 {
        small *= 0.5;
        halvings += 1;
    }
    (halvings, small)
}

/// φ₁(X) = Σ Xⁱ/(i+1)! for a norm of X below 1, by Horner, with the truncated terms enclosed.
fn phi1_series(x: &IntervalMatrix, connected: &DMatrix<bool>) -> IntervalMatrix {
    let n = x.nrows();
    let norm = norm_upper(&magnitude(x));
    let (degree, remainder) = truncation(norm);
    let identity = IntervalMatrix::identity(n, n);
    let mut sum = identity.clone();
    for i in (1..=degree).rev() {
        let divisor = Interval::point(i as f64 + 1.0);
        sum = &identity + product(x, &sum).map(|entry| entry / divisor);
    }
    let symmetric = Interval::centered(0.0, remainder);
    sum.zip_map(connected, |entry, linked| if linked { entry + symmetric } else { entry })
}

/// The degree at which the series may stop, and an upper bound of what it leaves out:
/// Σ_{i>p} xⁱ/(i+1)! <= x^{p+1}/(p+2)! / (1 - x/(p+3)), for x < p + 3.
pub(crate) fn truncation(norm: f64) -> (usize, f64) {
    let mut term = div_up(norm, 2.0);
    for degree in 1..60 {
        term = div_up(mul_up(term, norm), degree as f64 + 2.0);
        let tail = div_up(term, sub_down(1.0, div_up(norm, degree as f64 + 3.0)));
        if (0.0..=f64::EPSILON / 256.0).contains(&tail) {
            return (degree, tail);
        }
    }
    (60, f64::INFINITY)
}

/// Largest row sum, rounded upward.
pub(crate) fn norm_upper(magnitudes: &DMatrix<f64>) -> f64 {
    let row_sum = |row: usize| magnitudes.row(row).iter().fold(0.0, |sum, &x| add_up(sum, x));
    (0..magnitudes.nrows()).map(row_sum).fold(0.0, f64::max)
}

/// Which entries of some power of A can be non-zero: j can be reached from i through entries of A.
pub(crate) fn connected(a: &DMatrix<f64>) -> DMatrix<bool> {
    let n = a.nrows();
    let mut linked = DMatrix::from_fn(n, n, |i, j| i == j || a[(i, j)] != 0.0);
    for via in 0..n {
        for i in 0..n {
            for j in 0..n {
                linked[(i, j)] |= linked[(i, via)] && linked[(via, j)];
            }
        }
    }
    linked
}

/// The derivative ẋ = A x + B u + d, enclosed for every x and u in the vectors given.
pub(crate) fn derivative(system: &LinearSystem, x: &[Interval], u: &[Interval]) -> IntervalVector {
    let mut sum = system.drift().map(Interval::point);
    add_product(sum.as_mut_slice(), &point(system.a()), x);
    add_product(sum.as_mut_slice(), &point(system.b()), u);
    sum
}

#[cfg(test)]
mod tests {
    use nalgebra::dmatrix;

    use super::*;

    #[test]
    fn the_remainder_covers_the_terms_left_out() {
        for norm in [1e-300, 1e-9, 0.01, 0.3, 0.5] {
            let (degree, remainder) = truncation(norm);
            let mut term = (2..=degree + 2).fold(1.0, |term, i| term / i as f64)
                * norm.powi(degree as i32 + 1);
            let mut rest = 0.0;
            for i in degree + 1..degree + 30 {
                rest += term;
                term *= norm / (i as f64 + 2.0);
            }
            assert!(
                remainder >= rest * (1.0 - 1e-12) && remainder <= 1.4 * rest + 1e-300,
                "{norm}: {remainder:e} {rest:e}"
            );
        }
        assert_eq!(truncation(0.0), (1, 0.0));
        assert_eq!(truncation(f64::INFINITY).1, f64::INFINITY);
        assert!(truncation(50.0).1 > 0.0);
    }

    #[test]
    fn an_entry_is_linked_when_a_path_leads_there() {
        let chain = dmatrix![0.0, 1.0, 0.0; 0.0, 0.0, 1.0; 0.0, 0.0, 0.0];
        let expected = dmatrix![true, true, true; false, true, true; false, false, true];
        assert_eq!(connected(&chain), expected);
    }

    #[test]
    fn the_largest_row_sum_is_rounded_upward() {
        assert_eq!(norm_upper(&dmatrix![1.0, 2.0; 0.5, 0.25]), 3.0);
        assert!(norm_upper(&dmatrix![1.0, 1e-20]) > 1.0);
    }
}
