//! The Taylor series of φ₁(X) = Σ Xⁱ/(i+1)!, with an enclosed truncation error.

use nalgebra::DMatrix;
use reachtube_scalar::Interval;
use reachtube_scalar::rounding::{div_up, mul_up, sub_down};

use crate::sets::interval_matrix::{IntervalMatrix, magnitude, product};
use crate::upward::norm_upward;

/// Encloses φ₁(X) for a norm of X below 1, by Horner's scheme.
///
/// Entries that are not `connected` are zero in every power of X and carry no truncation error.
///
/// # Guarantee
///
/// Outer, directed rounding.
pub(crate) fn phi1_series(x: &IntervalMatrix, connected: &DMatrix<bool>) -> IntervalMatrix {
    let n = x.nrows();
    let norm = norm_upward(&magnitude(x));
    let (degree, remainder) = truncation(norm);
    let identity = IntervalMatrix::identity(n, n);
    let mut sum = identity.clone();
    for i in (1..=degree).rev() {
        let divisor = Interval::point(i as f64 + 1.0);
        sum = &identity + product(x, &sum).map(|entry| entry / divisor);
    }
    let symmetric = Interval::centred(0.0, remainder);
    sum.zip_map(connected, |entry, linked| if linked { entry + symmetric } else { entry })
}

/// Returns a degree p for the truncated series and an upper bound of its truncation error,
/// Σ_{i>p} xⁱ/(i+1)! <= x^{p+1}/(p+2)! / (1 - x/(p+3)) for x = `norm` < p + 3.
///
/// The bound is infinite if 60 terms are not enough for double precision.
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_remainder_covers_the_truncated_terms() {
        for norm in [1e-300, 1e-9, 0.01, 0.3, 0.5] {
            let (degree, remainder) = truncation(norm);
            let mut term = (2..=degree + 2).fold(1.0, |term, i| term / i as f64)
                * norm.powi(degree as i32 + 1);
            let mut truncated = 0.0;
            for i in degree + 1..degree + 30 {
                truncated += term;
                term *= norm / (i as f64 + 2.0);
            }
            assert!(
                remainder >= truncated * (1.0 - 1e-12) && remainder <= 1.4 * truncated + 1e-300,
                "{norm}: {remainder:e} {truncated:e}"
            );
        }
        assert_eq!(truncation(0.0), (1, 0.0));
        assert_eq!(truncation(f64::INFINITY).1, f64::INFINITY);
        assert!(truncation(50.0).1 > 0.0);
    }
}
