//! Validated matrix exponential and input integrals over one step.

use reachtube_scalar::Interval;
use reachtube_scalar::rounding::mul_up;

use crate::linear::phi1_series::phi1_series;
use crate::linear::sparsity::connected;
use crate::linear::system::LinearSystem;
use crate::sets::interval_matrix::{IntervalMatrix, IntervalVector, magnitude, point, product};
use crate::upward::norm_upward;

/// Largest norm of A h for which the Taylor series is summed; above it, h is halved repeatedly and
/// the result is doubled as often.
const SERIES_NORM: f64 = 0.5;

/// The matrices of one step of length h of a linear system with constant input:
/// x(h) = Φ x(0) + Γ u + γ.
#[derive(Debug, Clone)]
pub struct PropagationStep {
    /// Φ = e^{Ah}, N x N.
    pub phi: IntervalMatrix,
    /// Γ = ∫₀ʰ e^{Aτ} dτ B, N x m.
    pub gamma: IntervalMatrix,
    /// γ = ∫₀ʰ e^{Aτ} dτ d, N entries.
    pub drift: IntervalVector,
}

/// Encloses the step of `system` for every length in `h` (s, h >= 0).
///
/// # Guarantee
///
/// Outer, proved with directed rounding: for every real h in the interval, Φ, Γ and γ lie in the
/// returned matrices. An entry that is zero for every h (no path through A) is the point 0.
#[must_use]
pub fn step(system: &LinearSystem, h: Interval) -> PropagationStep {
    // Scale: halve h until the norm of A h suits the series.
    let (halvings, short) = halve(system, h);
    let n = system.states();
    // Sum the series over the short step.
    let x = point(system.a()) * short;
    let phi1 = phi1_series(&x, &connected(system.a()));
    let mut phi = IntervalMatrix::identity(n, n) + product(&x, &phi1);
    let integral = phi1 * short;
    let mut gamma = product(&integral, &point(system.b()));
    let mut drift = integral * system.drift().map(Interval::point);
    // Square: double the step as often as h was halved.
    for _ in 0..halvings {
        gamma += product(&phi, &gamma);
        drift = &drift + &phi * &drift;
        phi = product(&phi, &phi);
    }
    PropagationStep { phi, gamma, drift }
}

/// Returns the number of halvings and the halved length.
fn halve(system: &LinearSystem, h: Interval) -> (u32, Interval) {
    let mut short = h;
    let mut halvings = 0;
    let norm = norm_upward(&magnitude(&point(system.a())));
    while norm.is_finite() && mul_up(norm, short.hi()) > SERIES_NORM && halvings < 1000 {
        short *= 0.5;
        halvings += 1;
    }
    (halvings, short)
}
