//! Products.

use super::TaylorModel;
use super::bounds::{LANES, LARGEST, Norms, range};
use super::polarisation::product_of_parts;
use crate::rounding::{add_up, mul_up};
use crate::taylor::Form;
use crate::{Interval, TaylorPolynomial};

/// Numbers above it are normal and far from underflow.
const UNDERFLOW: f64 = 1e-290;

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
        let cross = self.cross(other);
        if cross == Interval::ENTIRE {
            return Self::unknown();
        }
        let (x, y) = (Norms::new(a), Norms::new(b));
        let bound = mul_up(x.total(), y.total());
        if bound > LARGEST {
            return Self::from(self.range() * other.range());
        }
        let order = a.space().or(b.space()).map_or(0, |space| space.order());
        // Of the products that are cut off, those of two parts of the lowest such degree weigh
        // most.
        let degree = order / 2 + 1;
        let parts = product_of_parts(a, b, degree, [&x, &y].map(|norms| norms.of(degree)));
        let left_out = add_up(x.cut_off(&y, order, degree), rounding_error(&x, &y, order, bound));
        Self::new(a * b, cross + parts + Interval::centered(0.0, left_out))
    }

    /// Of (P + R)(Q + S) all but P Q.
    fn cross(&self, other: &Self) -> Interval {
        let times = |p: &TaylorPolynomial, r: Interval| {
            if r == Interval::ZERO { Interval::ZERO } else { range(p) * r }
        };
        let (r, s) = (self.remainder, other.remainder);
        times(&self.polynomial, s) + times(&other.polynomial, r) + r * s
    }

    /// k self for a finite k.
    pub(super) fn scaled(&self, k: f64) -> Self {
        if k == 0.0 {
            return Self::from(0.0);
        }
        let Some(error) = scaling_error(&self.polynomial, k.abs(), is_power_of_two(k)) else {
            return Self::from(self.range() * k);
        };
        Self::new(self.polynomial.scaled(&k), self.remainder * k + error)
    }

    /// self / k for a finite k that is not zero.
    pub(super) fn divided(&self, k: f64) -> Self {
        let Some(error) = scaling_error(&self.polynomial, k.recip().abs(), is_power_of_two(k))
        else {
            return Self::from(self.range() / Interval::point(k));
        };
        let quotient = self.polynomial.map_coefficients(|c| c / k);
        Self::new(quotient, self.remainder / k + error)
    }
}

/// A bound of what rounding the coefficients times about k changes in total; `None` where one might
/// overflow.
///
/// Each is rounded once, within ε/2 of itself, and within 2⁻¹⁰⁷⁵ where it underflows; with a power
/// of two, only underflow is an error.
fn scaling_error(p: &TaylorPolynomial, k: f64, is_power_of_two: bool) -> Option<Interval> {
    let sum = mul_up(Norms::new(p).total(), k);
    if sum > LARGEST || !k.is_normal() {
        return None;
    }
    let rounding = if is_power_of_two { 0.0 } else { mul_up(sum, f64::EPSILON) };
    let underflow = if least(p) * k > UNDERFLOW { 0.0 } else { f64::MIN_POSITIVE };
    Some(Interval::centered(0.0, add_up(rounding, underflow)))
}

/// The least magnitude of a coefficient that is not zero; ∞ where there is none.
fn least(p: &TaylorPolynomial) -> f64 {
    let smaller = |least: f64, c: &f64| {
        let size = if *c == 0.0 { f64::INFINITY } else { c.abs() };
        if size < least { size } else { least }
    };
    match &p.form {
        Form::Constant(c) => smaller(f64::INFINITY, c),
        Form::Sparse(_, terms) => terms.iter().map(|(_, c)| c).fold(f64::INFINITY, smaller),
        Form::Dense(_, coefficients) => {
            let (chunks, rest) = coefficients.as_chunks::<LANES>();
            let mut least = [f64::INFINITY; LANES];
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

/// A bound of what rounding changes in a product of polynomials of which the product of norms is
/// `bound`.
///
/// The coefficient of a monomial m is a sum of products a_α b_β, α + β = m, in some order. At most
/// S of them are not zero: no more than either factor has terms, and no more than m has divisors,
/// which is 2^p at most. In whatever order they are summed, a product is rounded once itself and in
/// S - 1 additions at most (adding zero is exact), so it enters with a factor 1 + θ, |θ| ≤ γ = S u
/// / (1 - S u), u = ε/2 (Higham, Accuracy and Stability of Numerical Algorithms, Lemma 3.1). Over
/// [-1, 1]^k the errors sum up to γ Σ |a_α| |b_β| ≤ γ N(a) N(b) at most, and γ ≤ (S + 1) u for S <
/// 2²⁵, γ ≤ 2 S u for S < 2⁵². A product that underflows costs 2⁻¹⁰⁷⁵ more; there are fewer than
/// 2⁵² products.
fn rounding_error(x: &Norms, y: &Norms, order: u32, bound: f64) -> f64 {
    let divisors = 1usize.checked_shl(order).unwrap_or(usize::MAX);
    let summands = x.terms.min(y.terms).min(divisors);
    let factor = if summands < 1 << 25 { summands + 1 } else { 2 * summands };
    add_up(mul_up(factor as f64 * (0.5 * f64::EPSILON), bound), f64::MIN_POSITIVE)
}
