//! The Taylor series Σ A^m B τ^m / m! of e^{Aτ} B within one step.

use reachtube_scalar::Interval;
use reachtube_scalar::rounding::{add_up, div_up, mul_up, sub_up};

use crate::linear::system::LinearSystem;
use crate::sets::interval_matrix::{IntervalMatrix, dot, magnitude, point, product};
use crate::upward::norm_upward;

/// Largest number of terms.
const MOST_TERMS: usize = 200;

/// Largest number of successive halvings of a step in which an entry changes sign.
const DEEPEST: usize = 40;

/// Largest ratio of |f| to the width of its enclosure at a point for which halving cannot decide
/// the sign of f.
pub(crate) const NOISE: f64 = 4.0;

/// The Taylor terms A^m B / m!, m < M, for steps up to a given length.
pub(crate) struct TaylorSeries {
    pub(crate) terms: Vec<IntervalMatrix>,
    /// |A|^M |B| / M! in the norm.
    ///
    /// The truncated terms sum to at most twice this value times τ^M: the ratio of successive terms
    /// is |A| τ / (M + 1), which is below 1/2 up to the given length and a little beyond.
    remainder: f64,
}

impl TaylorSeries {
    /// Computes as many terms as double precision needs for steps up to `longest` (s).
    pub(crate) fn new(system: &LinearSystem, longest: f64) -> Self {
        let a = point(system.a());
        let a_norm = norm_upward(&magnitude(&a));
        let b_norm = norm_upward(&magnitude(&point(system.b())));
        let (mut remainder, mut power) = (b_norm, 1.0);
        let mut terms = vec![point(system.b())];
        for m in 1..MOST_TERMS {
            remainder = div_up(mul_up(remainder, a_norm), m as f64);
            power *= longest;
            if remainder * power <= 1e-18 * b_norm && mul_up(2.0 * a_norm, longest) <= m as f64 {
                return Self { terms, remainder };
            }
            let divisor = Interval::point(m as f64);
            terms.push(product(&a, &terms[m - 1]).map(|x| x / divisor));
        }
        Self { terms, remainder: f64::INFINITY }
    }

    /// Returns entry (i, j) of `start` e^{Aτ} B as a polynomial in τ.
    pub(crate) fn entry(&self, start: &IntervalMatrix, i: usize, j: usize) -> TimePolynomial {
        let coefficient = |term: &IntervalMatrix| dot(start.row(i).iter(), term.column(j).iter());
        let norm = start.row(i).iter().fold(0.0, |sum, x| add_up(sum, x.mag()));
        TimePolynomial {
            coefficients: self.terms.iter().map(coefficient).collect(),
            tail: mul_up(2.0 * norm, self.remainder),
        }
    }
}

/// A polynomial with a truncation error: f(τ) = Σ c_m τ^m + e(τ) with |e(τ)| <= tail τ^M, for
/// 0 <= τ up to the length of the series.
pub(crate) struct TimePolynomial {
    coefficients: Vec<Interval>,
    tail: f64,
}

impl TimePolynomial {
    /// Encloses the range of f over `tau` by the mean value form, and returns the width of f at one
    /// point, which halving `tau` cannot reduce.
    ///
    /// # Guarantee
    ///
    /// Outer, directed rounding.
    pub(crate) fn range(&self, tau: Interval) -> (Interval, f64) {
        let middle = Interval::point(tau.mid());
        let terms = || self.coefficients.iter().enumerate();
        let sum = terms().rev().fold(Interval::ZERO, |sum, (_, c)| sum * middle + *c);
        let value = sum + self.error(tau);
        let slope =
            terms().skip(1).rev().fold(Interval::ZERO, |sum, (m, c)| sum * tau + *c * m as f64);
        (value + slope * (tau - middle), value.width())
    }

    /// Encloses ∫₀^σ f.
    ///
    /// # Guarantee
    ///
    /// Outer, directed rounding.
    pub(crate) fn integral(&self, sigma: Interval) -> Interval {
        let antiderivative = |sum: Interval, (m, c): (usize, &Interval)| {
            sum * sigma + *c / Interval::point(m as f64 + 1.0)
        };
        let sum = self.coefficients.iter().enumerate().rev().fold(Interval::ZERO, antiderivative);
        (sum + self.error(sigma)) * sigma
    }

    /// Encloses ∫_a^b |f| by halving where f may change sign.
    ///
    /// Halving stops where the integral over a piece is at most `negligible` or the enclosure of f
    /// is not tight enough to decide its sign.
    ///
    /// # Guarantee
    ///
    /// Outer, directed rounding.
    pub(crate) fn integral_of_absolute(
        &self,
        a: Interval,
        b: Interval,
        negligible: f64,
    ) -> Interval {
        self.pieces(a, b, negligible, 0)
    }

    /// Returns whether f may change sign within `tau` by more than is negligible or uncertain.
    pub(crate) fn may_turn(&self, tau: Interval, negligible: f64) -> bool {
        let (range, point_width) = self.range(tau);
        range.contains_zero()
            && range.mag() > NOISE * point_width
            && mul_up(range.mag(), tau.width()) > negligible
    }

    fn pieces(&self, a: Interval, b: Interval, negligible: f64, depth: usize) -> Interval {
        let (range, point_width) = self.range(a.hull(b));
        let inner = (self.integral(b) - self.integral(a)).abs();
        if !range.contains_zero() {
            return inner;
        }
        let outer = mul_up(range.mag(), sub_up(b.hi(), a.lo()));
        if depth == DEEPEST || outer <= negligible || range.mag() <= NOISE * point_width {
            return between(inner.lo().min(outer), outer);
        }
        let middle = (a + b) * 0.5;
        self.pieces(a, middle, negligible, depth + 1)
            + self.pieces(middle, b, negligible, depth + 1)
    }

    /// Encloses the truncation error e(τ).
    fn error(&self, tau: Interval) -> Interval {
        if self.tail == 0.0 {
            return Interval::ZERO;
        }
        let power = Interval::point(tau.mag()).powi(self.coefficients.len() as i32);
        Interval::centred(0.0, mul_up(self.tail, power.hi()))
    }
}

/// Returns [lo, hi], or all numbers if an end is not a number.
pub(crate) fn between(lo: f64, hi: f64) -> Interval {
    Interval::new(lo, hi).unwrap_or(Interval::ENTIRE)
}

#[cfg(test)]
mod tests {
    use nalgebra::{dmatrix, dvector};

    use super::*;

    /// Returns e^{Aτ} B = (sin ωτ, cos ωτ) as polynomials, for τ up to `longest`.
    fn oscillation(omega: f64, longest: f64) -> [TimePolynomial; 2] {
        let a = dmatrix![0.0, omega; -omega, 0.0];
        let system = LinearSystem::new(a, dmatrix![0.0; 1.0], dvector![0.0, 0.0]).unwrap();
        let series = TaylorSeries::new(&system, longest);
        [0, 1].map(|i| series.entry(&IntervalMatrix::identity(2, 2), i, 0))
    }

    #[test]
    fn ranges_and_integrals_enclose_sine_and_cosine() {
        let [sine, cosine] = oscillation(3.0, 0.5);
        for k in 0..50 {
            let (a, b) = (0.01 * f64::from(k), 0.01 * f64::from(k + 1));
            let (range, point_width) = sine.range(between(a, b));
            assert!(range.contains((1.5 * (a + b)).sin()) && point_width < 1e-14);
            assert!(
                range.contains((3.0 * a).sin())
                    && range.contains((3.0 * b).sin())
                    && range.width() < 0.04
            );
            let integral = cosine.integral(Interval::point(b));
            assert!((integral - (3.0 * b).sin() / 3.0).mag() < 1e-14);
        }
    }

    #[test]
    fn the_tail_covers_the_truncation_error_of_a_short_series() {
        let [mut sine, _] = oscillation(3.0, 0.5);
        let full = sine.integral(Interval::point(0.5));
        sine.coefficients.truncate(6);
        // Twice |A|⁶ |B| / 6!, the bound of a series of six terms.
        sine.tail = 2.0 * 729.0 / 720.0;
        let short = sine.integral(Interval::point(0.5));
        assert!(short.encloses(&full) && short.width() > 1e-4 && short.width() < 0.04);
        let exact = (3.0f64 * 0.4).sin();
        assert!(sine.range(Interval::point(0.4)).0.contains(exact));
    }

    #[test]
    fn absolute_values_are_integrated_across_a_change_of_sign() {
        let [_, cosine] = oscillation(4.0, 0.75);
        let whole = cosine.integral_of_absolute(Interval::ZERO, Interval::point(0.75), 1e-14);
        let exact = (2.0 - 3.0f64.sin()) / 4.0;
        assert!(whole.contains(exact) || (whole - exact).mag() < 1e-15);
        assert!(whole.width() < 1e-12 && (whole - exact).mag() < 1e-12);
        assert!(
            cosine.may_turn(between(0.0, 0.75), 1e-14)
                && !cosine.may_turn(between(0.0, 0.3), 1e-14)
        );
    }

    #[test]
    fn halving_stops_at_noise() {
        let coefficient = |m: i32| Interval::centred(0.0, 1e-6 * 0.1f64.powi(m));
        let noise = TimePolynomial { coefficients: (0..8).map(coefficient).collect(), tail: 0.0 };
        let integral = noise.integral_of_absolute(Interval::ZERO, Interval::ONE, 0.0);
        assert!(integral.lo() == 0.0 && integral.hi() >= 1e-6 && integral.hi() < 1e-4);
        assert!(!noise.may_turn(between(0.0, 1.0), 0.0));
    }

    #[test]
    fn a_norm_too_large_for_the_series_gives_an_infinite_bound() {
        let [sine, _] = oscillation(1e4, 1.0);
        assert_eq!(
            sine.integral_of_absolute(Interval::ZERO, Interval::ONE, 1e-10).hi(),
            f64::INFINITY
        );
    }
}
