//! The state-transition matrix of a linear system whose matrix varies within an interval matrix.

use reachtube_scalar::Interval;

use crate::sets::interval_matrix::{IntervalMatrix, magnitude, product};
use crate::upward::norm_upward;

/// Number of terms of the series before its remainder.
const TERMS: usize = 4;

/// Encloses Ψ(1, 0) for Ψ̇ = A(τ) Ψ with any A(τ) in `a` at each time 0 <= τ <= 1, and
/// Ψ(1, τ) - I for every τ.
///
/// # Guarantee
///
/// Outer, directed rounding: each product of A at different times lies in the product of the
/// interval matrices, and so do means of such products. The truncation error is at most
/// |A|^p / p! / (1 - |A| / (p + 1)) in the norm.
pub(crate) fn transition(a: &IntervalMatrix) -> (IntervalMatrix, IntervalMatrix) {
    let n = a.nrows();
    let identity = IntervalMatrix::identity(n, n);
    // Terms Aⁱ / i! of the series.
    let (mut power, mut sum, mut change) =
        (identity.clone(), identity, IntervalMatrix::from_element(n, n, Interval::ZERO));
    for i in 1..TERMS {
        power = product(&power, a).map(|x| x / Interval::point(i as f64));
        sum += &power;
        change += power.map(|x| x.hull(Interval::ZERO));
    }
    // Truncation error.
    let norm = Interval::point(norm_upward(&magnitude(a)));
    let truncated =
        (1..=TERMS).fold(Interval::ONE, |term, i| term * norm / Interval::point(i as f64));
    let tail = truncated / (Interval::ONE - norm / Interval::point(TERMS as f64 + 1.0));
    let tail = if tail.lo() >= 0.0 { Interval::centred(0.0, tail.hi()) } else { Interval::ENTIRE };
    (sum.map(|x| x + tail), change.map(|x| x + tail))
}
