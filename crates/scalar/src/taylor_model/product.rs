//! Products and multiples.

use super::bounds::{Norms, OVERFLOW_GUARD, PARTIAL_SUMS, range};
use super::model::TaylorModel;
use super::polarisation::product_of_parts;
use crate::interval::closed::Interval;
use crate::rounding::{add_up, mul_up};
use crate::taylor::polynomial::{Form, TaylorPolynomial};

/// A bound above which numbers are normal and far from underflow.
const UNDERFLOW_GUARD: f64 = 1e-290;

impl TaylorModel {
    pub(super) fn product(&self, other: &Self) -> Self {
        match (self.as_number(), other.as_number()) {
            (Some(k), _) => other.scaled(k),
            (_, Some(k)) => self.scaled(k),
            _ => self.product_of_functions(other),
        }
    }

    fn product_of_functions(&self, other: &Self) -> Self {
        let (a, b) = (&self.polynomial, &other.polynomial);
        // Products with a remainder.
        let cross_terms = self.cross_terms(other);
        if cross_terms == Interval::ENTIRE {
            return Self::entire();
        }
        let (x, y) = (Norms::new(a), Norms::new(b));
        let bound = mul_up(x.total(), y.total());
        if bound > OVERFLOW_GUARD {
            return Self::from(self.range() * other.range());
        }
        let order = a.space().or(b.space()).map_or(0, |space| space.order());
        // Truncation: the largest part comes from two terms of degree p/2 + 1 each, which gets a
        // closer bound.
        let degree = order / 2 + 1;
        let parts = product_of_parts(a, b, degree, [&x, &y].map(|norms| norms.of_degree(degree)));
        // All other truncated terms, and rounding.
        let error = add_up(x.truncation(&y, order, degree), rounding_error(&x, &y, order, bound));
        Self::new(a * b, cross_terms + parts + Interval::centred(0.0, error))
    }

    /// Encloses (P + R)(Q + S) - P Q for polynomials P, Q and remainders R, S.
    fn cross_terms(&self, other: &Self) -> Interval {
        let times = |p: &TaylorPolynomial, r: Interval| {
            if r == Interval::ZERO { Interval::ZERO } else { range(p) * r }
        };
        let (r, s) = (self.remainder, other.remainder);
        times(&self.polynomial, s) + times(&other.polynomial, r) + r * s
    }

    fn scaled(&self, k: f64) -> Self {
        if k == 0.0 {
            return Self::from(0.0);
        }
        let Some(error) = scaling_error(&self.polynomial, k.abs(), is_power_of_two(k)) else {
            return Self::from(self.range() * k);
        };
        Self::new(self.polynomial.scaled(&k), self.remainder * k + error)
    }

    /// Returns self / k for a finite k ≠ 0.
    ///
    /// # Guarantee
    ///
    /// Outer.
    #[must_use]
    pub fn divided(&self, k: f64) -> Self {
        let Some(error) = scaling_error(&self.polynomial, k.recip().abs(), is_power_of_two(k))
        else {
            return Self::from(self.range() / Interval::point(k));
        };
        let quotient = self.polynomial.map_coefficients(|c| c / k);
        Self::new(quotient, self.remainder / k + error)
    }
}

/// Bounds the sum of the rounding errors when each coefficient is multiplied by about k; `None` if
/// a product might overflow.
///
/// Each product is rounded once, with a relative error of at most ε/2, or an absolute error of at
/// most 2⁻¹⁰⁷⁵ where it underflows. With a power of two, only underflow causes an error.
fn scaling_error(p: &TaylorPolynomial, k: f64, is_power_of_two: bool) -> Option<Interval> {
    let sum = mul_up(Norms::new(p).total(), k);
    if sum > OVERFLOW_GUARD || !k.is_normal() {
        return None;
    }
    let rounding = if is_power_of_two { 0.0 } else { mul_up(sum, f64::EPSILON) };
    let underflow =
        if smallest_magnitude(p) * k > UNDERFLOW_GUARD { 0.0 } else { f64::MIN_POSITIVE };
    Some(Interval::centred(0.0, add_up(rounding, underflow)))
}

/// Returns the smallest magnitude of a non-zero coefficient; ∞ if there is none.
fn smallest_magnitude(p: &TaylorPolynomial) -> f64 {
    let smaller = |least: f64, c: &f64| {
        let size = if *c == 0.0 { f64::INFINITY } else { c.abs() };
        if size < least { size } else { least }
    };
    match &p.form {
        Form::Constant(c) => smaller(f64::INFINITY, c),
        Form::Sparse(_, terms) => terms.iter().map(|(_, c)| c).fold(f64::INFINITY, smaller),
        Form::Dense(_, coefficients) => {
            let (chunks, rest) = coefficients.as_chunks::<PARTIAL_SUMS>();
            let mut least = [f64::INFINITY; PARTIAL_SUMS];
            for chunk in chunks {
                least.iter_mut().zip(chunk).for_each(|(least, c)| *least = smaller(*least, c));
            }
            least.iter().chain(rest).fold(f64::INFINITY, smaller)
        }
    }
}

fn is_power_of_two(k: f64) -> bool {
    k.is_normal() && k.to_bits() & ((1 << 52) - 1) == 0
}

/// Bounds the rounding error of a product of polynomials over [-1, 1]^k, where `bound` ≥ N(a) N(b).
///
/// The coefficient of a monomial m is a sum of products a_α b_β, α + β = m, in some order. At most
/// S of them are not zero: S is at most the number of terms of either factor and the number of
/// divisors of m, which is at most 2^p.
///
/// A product is rounded once itself and in at most S - 1 additions, because adding zero is exact.
/// In any order of summation it gets a factor 1 + θ, |θ| ≤ γ = S u / (1 - S u), u = ε/2 (Higham,
/// Accuracy and Stability of Numerical Algorithms, Lemma 3.1).
///
/// Over [-1, 1]^k the sum of the errors is at most γ Σ |a_α| |b_β| ≤ γ N(a) N(b). γ ≤ (S + 1) u for
/// S < 2²⁵, and γ ≤ 2 S u for S < 2⁵². A product that underflows adds 2⁻¹⁰⁷⁵; there are fewer than
/// 2⁵² products.
fn rounding_error(x: &Norms, y: &Norms, order: u32, bound: f64) -> f64 {
    let divisors = 1usize.checked_shl(order).unwrap_or(usize::MAX);
    let summands = x.terms.min(y.terms).min(divisors);
    let factor = if summands < 1 << 25 { summands + 1 } else { 2 * summands };
    add_up(mul_up(factor as f64 * (0.5 * f64::EPSILON), bound), f64::MIN_POSITIVE)
}
