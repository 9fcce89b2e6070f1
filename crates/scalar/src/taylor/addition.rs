//! Rounding of sums of coefficients: plainly, or while something is recorded about each sum.

use crate::scalar::Scalar;

/// An addition of coefficients.
pub(crate) trait Addition<C: Scalar> {
    fn sum(&mut self, a: &C, b: C) -> C;

    /// Replaces each a_i by a_i + b_i, or by a_i - b_i where `minus`.
    fn accumulate(&mut self, a: &mut [C], b: &[C], minus: bool) {
        for (a, b) in a.iter_mut().zip(b) {
            *a = self.sum(a, negated_if(minus, b));
        }
    }
}

/// The addition of the scalar type, with nothing recorded.
pub(super) struct PlainAddition;

impl<C: Scalar> Addition<C> for PlainAddition {
    fn sum(&mut self, a: &C, b: C) -> C {
        a.clone() + b
    }
}

/// Returns -c where `minus`, else c.
pub(super) fn negated_if<C: Scalar>(minus: bool, c: &C) -> C {
    if minus { -c.clone() } else { c.clone() }
}
