//! Truncated power series with a proved error bound, for exp, sin and cos.

use super::closed::Interval;
use crate::rounding::{add_up, div_down, div_up, mul_up};

/// Encloses 1 / n! for n ≤ 20, for which n! is an `f64` exactly.
pub(super) const fn inverse_factorial(n: u32) -> Interval {
    let mut factorial = 1.0;
    let mut i = 2;
    while i <= n {
        factorial *= i as f64;
        i += 1;
    }
    Interval { lo: div_down(1.0, factorial), hi: div_up(1.0, factorial) }
}

/// The series Σ c_i xⁱ + remainder · x^N over i < N, for |x| ≤ `largest` < 1.
///
/// From c_2 on, each |c_i| is at most a quarter of the one before. c_0 and c_1 are intervals. The
/// tail c_2 + c_3 x + … is so small that it is evaluated in `f64`, with an error bound.
pub(super) struct PowerSeries<const N: usize> {
    leading: [Interval; 2],
    /// c_i, rounded; the entries for c_0 and c_1 are not used.
    rounded: [f64; N],
    /// |c_2|.
    third: f64,
    /// Error bound of the tail at an exact x.
    error: f64,
}

impl<const N: usize> PowerSeries<N> {
    /// Returns the series for coefficients c_i, a bound of |remainder| and the bound `largest` of
    /// |x|.
    ///
    /// The tail has Σ |c_i| ≤ 4/3 |c_2|. Its coefficients are within 2⁻⁵¹ (relative). Horner's rule
    /// of degree d ≤ 12 then has an error of at most (2d u / (1 - 2d u) + 2⁻⁵¹) 4/3 |c_2|, which is
    /// below 2⁻⁴⁶ |c_2|, with u = 2⁻⁵³ (Higham, Accuracy and Stability of Numerical Algorithms,
    /// (5.3)).
    pub(super) const fn new(
        coefficients: [Interval; N],
        remainder: f64,
        largest: f64,
    ) -> PowerSeries<N> {
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
        PowerSeries { leading: [coefficients[0], coefficients[1]], rounded, third, error }
    }

    /// Encloses the series at every number of x.
    pub(super) fn evaluate(&self, x: Interval) -> Interval {
        let middle = x.mid();
        let tail = self.rounded[2..].iter().rev().fold(0.0, |sum, c| sum * middle + c);
        // The derivative of the tail is below Σ i 4⁻ⁱ |c_2| < |c_2|.
        let error = add_up(self.error, mul_up(self.third, x.width()));
        (Interval::centred(tail, error) * x + self.leading[1]) * x + self.leading[0]
    }
}
