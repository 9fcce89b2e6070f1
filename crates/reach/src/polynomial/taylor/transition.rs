//! The state-transition matrix of a linear system whose matrix varies within an interval matrix.

use nalgebra::DMatrix;
use reachtube_scalar::Interval;
use reachtube_scalar::rounding::div_up;

use crate::linear::sparsity::reached;
use crate::sets::interval_matrix::{IntervalMatrix, magnitude, product};
use crate::upward::{accumulate_upward, mul_upward, norm_upward};

/// Number of terms of the series before its remainder.
const TERMS: usize = 4;

/// Number of terms from which on the remainder is bounded in the norm, not entry by entry.
const TERMS_BY_ENTRY: usize = 12;

/// Encloses Ψ(1, 0) for Ψ̇ = A(τ) Ψ with any A(τ) in `a` at each time 0 <= τ <= 1, and
/// Ψ(1, τ) - I for every τ.
///
/// # Guarantee
///
/// Outer, directed rounding: each product of A at different times lies in the product of the
/// interval matrices, and so do means of such products. An entry that no path through A changes is
/// exact, so that a state whose derivative is zero stays constant.
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
    let tail = truncation(&magnitude(&power), &magnitude(a)).map(symmetric);
    (sum + &tail, change + tail)
}

/// Bounds the magnitudes of the terms from [`TERMS`] on, in sum, given the magnitudes of the last
/// term before and of A.
///
/// From the term q = [`TERMS_BY_ENTRY`] on, it is at most |T| |A| / q / (1 - |A| / (q + 1)) in the
/// norm, with the term T before.
fn truncation(last: &DMatrix<f64>, a: &DMatrix<f64>) -> DMatrix<f64> {
    let (mut term, mut sum) = (last.clone(), last.map(|_| 0.0));
    for i in TERMS..TERMS_BY_ENTRY {
        term = mul_upward(&term, a).map(|x| div_up(x, i as f64));
        accumulate_upward(&mut sum, &term);
    }
    let (q, norm) = (TERMS_BY_ENTRY as f64, Interval::point(norm_upward(a)));
    let next = Interval::point(norm_upward(&term)) * norm / Interval::point(q);
    let rest = next / (Interval::ONE - norm / Interval::point(q + 1.0));
    let rest = if rest.lo() >= 0.0 { rest.hi() } else { f64::INFINITY };
    let rest = reached(a, a).map(|reached| if reached { rest } else { 0.0 });
    accumulate_upward(&mut sum, &rest);
    sum
}

fn symmetric(radius: f64) -> Interval {
    Interval::centred(0.0, radius)
}

#[cfg(test)]
mod tests {
    use nalgebra::dmatrix;

    use super::*;
    use crate::sets::interval_matrix::point;

    #[test]
    fn the_exponential_of_a_stiff_spring_is_enclosed_closely() {
        // Aᵗ has the frequency √160 per unit of time / 100: e^A = [cos w, sin w / v; ..].
        let a = point(&dmatrix![0.0, 0.01, 0.0; -1.6, 0.0, 0.3; 0.0, 0.0, 0.0]);
        let (flow, change) = transition(&a);
        let w = 0.016f64.sqrt();
        for (entry, exact) in [((0, 0), w.cos()), ((0, 1), 0.01 * w.sin() / w)] {
            let near = Interval::centred(exact, 1e-15);
            assert!(flow[entry].intersection(near).is_some(), "{:?} {exact}", flow[entry]);
            assert!(flow[entry].width() < 1e-4, "{:?}", flow[entry]);
            let change = change[entry] + f64::from(entry.0 == entry.1);
            assert!(change.contains(exact));
        }
        // The last state is constant.
        assert_eq!(
            flow.row(2).iter().copied().collect::<Vec<_>>(),
            [0.0, 0.0, 1.0].map(Interval::point)
        );
        assert!(change.row(2).iter().all(|x| *x == Interval::ZERO));
    }

    #[test]
    fn a_step_too_long_has_no_bound() {
        let (flow, _) = transition(&point(&dmatrix![20.0]));
        assert_eq!(flow[(0, 0)], Interval::ENTIRE);
    }
}
