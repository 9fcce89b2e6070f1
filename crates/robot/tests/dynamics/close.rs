//! Comparison of vectors.

/// Asserts that two vectors agree within 1e-10 of the largest expected entry.
pub(crate) fn assert_close(found: &[f64], expected: &[f64], what: &str) {
    assert_eq!(found.len(), expected.len(), "{what}");
    let scale = expected.iter().fold(0.0, |a: f64, b| a.max(b.abs()));
    for (f, e) in found.iter().zip(expected) {
        assert!((f - e).abs() <= 1e-10 * scale, "{what}: {found:?} is not {expected:?}");
    }
}
