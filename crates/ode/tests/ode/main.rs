//! Tests of the integrators against exact solutions and against each other.

mod agreement;
mod convergence;
mod divergence;
mod ensemble;

/// Returns the largest |a_i - b_i| of two vectors.
fn distance(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len());
    let largest = a.iter().zip(b).map(|(a, b)| (a - b).abs()).max_by(f64::total_cmp).unwrap();
    assert!(!largest.is_nan(), "{a:?} {b:?}");
    largest
}

/// Returns the order of convergence: the slope of log error over log step between the first and the
/// last pair (step, error).
fn order(errors: &[(f64, f64)]) -> f64 {
    let (first, last) = (errors[0], errors[errors.len() - 1]);
    (first.1 / last.1).ln() / (first.0 / last.0).ln()
}
