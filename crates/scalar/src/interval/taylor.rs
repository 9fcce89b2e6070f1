//! Taylor polynomials with a proved error: what exp, sin and cos are evaluated by.

use super::Interval;
use crate::rounding::{add_up, div_down, div_up, mul_up};

/// 1 / n! for n ≤ 20, of which n! is an `f64` exactly.
pub(super) const fn inverse_factorial(n: u32) -> Interval {
    let mut factorial = 1.0;
    let mut i = 2;
    while i <= n {
        factorial *= i as f64;
        i += 1;
    }
    Interval { lo: div_down(1.0, factorial), hi: div_up(1.0, factorial) }
}

/// Σ c_i xⁱ + remainder · x^N for |x| ≤ `LARGEST` < 1, where from c_2 on |c_i| falls at least by a
/// factor of 4 each.
///
/// c_0 and c_1 are taken as intervals. The rest weighs so little that it is evaluated in `f64`,
/// with an error bound.
pub(super) struct Series<const N: usize> {
    leading: [Interval; 2],
    /// c_i, rounded; those of c_0 and c_1 are not used.
    rounded: [f64; N],
    /// |c_2|.
    third: f64,
    /// Bounds the error of the rest at an exact x.
    error: f64,
}

impl<const N: usize> Series<N> {
    /// From c_i, and bounds of |remainder| and |x|.
    ///
    /// The rest c_2 + c_3 x + … has Σ |c_i| ≤ 4/3 |c_2|, and Horner's rule of degree d ≤ 12 with
    /// coefficients within 2⁻⁵¹ an error of at most (2d u / (1 - 2d u) + 2⁻⁵¹) 4/3 |c_2| < 2⁻⁴⁶
    /// |c_2|, u = 2⁻⁵³ (Higham, Accuracy and Stability of Numerical Algorithms, (5.3)).
    pub(super) const fn new(
        coefficients: [Interval; N],
        remainder: f64,
        largest: f64,
    ) -> Series<N> {
        let mut rounded = [0.0; N];
        let mut remainder = remainder;
        let mut i = 2;
        while i < N {
            rounded[i] = coefficients[i].lo;
            remainder = mul_up(remainder, largest);
            i += 1;
        }
        let third = coefficients[2].mag();
        let error = add_up(mul_up(third, 64.0 * f64::EPSILON), remainder);
        Series { leading: [coefficients[0], coefficients[1]], rounded, third, error }
    }

    /// The sum at x.
    pub(super) fn at(&self, x: Interval) -> Interval {
        let middle = x.mid();
        let rest = self.rounded[2..].iter().rev().fold(0.0, |sum, c| sum * middle + c);
        // The derivative of the rest is below Σ i 4⁻ⁱ |c_2| < |c_2|.
        let error = add_up(self.error, mul_up(self.third, x.width()));
        (Interval::centered(rest, error) * x + self.leading[1]) * x + self.leading[0]
    }
}
