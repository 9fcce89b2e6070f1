//! Tight bounds of polynomials over [-1, 1]^k by branch and bound.
//!
//! A polynomial that is monotonic in a variable has its extremes where that variable is ±1. The box
//! is bisected where the polynomial is not monotonic.

use super::bounds::{OVERFLOW_GUARD, inflated};
use super::model::TaylorModel;
use crate::interval::closed::Interval;
use crate::rounding::{add_up, mul_up};
use crate::taylor::monomial::{Packing, exponents_only};
use crate::taylor::polynomial::TaylorPolynomial;
use crate::taylor::space::TaylorSpace;

/// Largest number of nested bisections of the box.
const MAX_DEPTH: u32 = 5;

/// Gap between bound and attained value, relative to Σ |c|, at which bisection stops.
const RELATIVE_GAP: f64 = 0.005;

/// Packed monomials with their coefficients; equal monomials are neighbours.
type Terms = Vec<(u128, f64)>;

impl TaylorModel {
    /// Encloses the range over the box, more tightly than [`range`](Self::range) and at a higher
    /// cost.
    ///
    /// The bound is closer where the polynomial is monotonic, or nearly so, in some variables over
    /// parts of the box.
    ///
    /// # Guarantee
    ///
    /// Outer. It is exact up to rounding and the remainder where the linear term of each variable
    /// dominates the derivative of all non-linear terms.
    ///
    /// # Examples
    ///
    /// ```
    /// use reachtube_scalar::{Interval, TaylorBox, TaylorSpace};
    ///
    /// let space = TaylorSpace::new(1, 2).unwrap();
    /// let x = TaylorBox::new(&space, &[Interval::new(1.0, 3.0).unwrap()]).variable(0);
    /// let cup = x.clone() * x.clone() - x; // from 0 to 6
    /// assert!(cup.range().lo() < -0.5);
    /// assert!(cup.tight_range().lo() > -1e-12 && cup.tight_range().hi() >= 6.0);
    /// ```
    pub fn tight_range(&self) -> Interval {
        let whole = self.range();
        let [below, above] = [-1.0, 1.0].map(|sign| upper_bound(&self.polynomial, sign));
        let tight = Interval::new(-below, above).map(|range| range + self.remainder);
        tight.and_then(|range| range.intersection(whole)).unwrap_or(whole)
    }
}

/// Returns an upper bound of `sign` times the polynomial over [-1, 1]^k.
fn upper_bound(p: &TaylorPolynomial, sign: f64) -> f64 {
    let Some(space) = p.space() else { return sign * p.constant_term() };
    let mut terms = Vec::new();
    p.for_each_term(|m, c| terms.push((m, sign * c)));
    let total = inflated(terms.iter().map(|(_, c)| c.abs()).sum(), terms.len());
    if total >= OVERFLOW_GUARD {
        return f64::INFINITY;
    }
    PolynomialSearch::new(space, total).upper_bound(terms, MAX_DEPTH, 0.0)
}

/// The partial derivative in one variable over the box.
#[derive(Clone, Copy, Default)]
struct SlopeBounds {
    /// Derivative of the linear term.
    linear: f64,
    /// Bound of the magnitude of the derivative of all other terms.
    non_linear: f64,
}

impl SlopeBounds {
    fn is_monotonic(self) -> bool {
        self.linear.abs() > self.non_linear
    }
}

/// A branch-and-bound search for an upper bound of a polynomial.
struct PolynomialSearch<'a> {
    space: &'a TaylorSpace,
    /// Σ |c| over the whole box.
    total: f64,
    /// The highest computed value, up to rounding.
    attained: f64,
    slopes: Vec<SlopeBounds>,
    factors: Vec<u8>,
}

/// A part of the box, with the polynomial in the part's own coordinates.
struct SubBox {
    terms: Terms,
    /// Bound of the rounding errors of the terms.
    error: f64,
    /// Upper bound over the part, with the error.
    bound: f64,
    /// The variable to cut; `None` if the bound cannot become smaller.
    cut: Option<usize>,
}

impl<'a> PolynomialSearch<'a> {
    /// Prepares a search for a polynomial whose magnitudes of coefficients sum up to `total`.
    fn new(space: &'a TaylorSpace, total: f64) -> Self {
        let slopes = vec![SlopeBounds::default(); space.variables()];
        Self { space, total, attained: f64::NEG_INFINITY, slopes, factors: Vec::new() }
    }

    /// Returns an upper bound of every function that is within `error` of the given terms.
    fn upper_bound(&mut self, terms: Terms, depth: u32, error: f64) -> f64 {
        let part = self.part(terms, error);
        let is_tight = part.bound - self.attained <= RELATIVE_GAP * self.total;
        match part.cut {
            Some(cut) if depth > 0 && !is_tight => {
                let [low, high] = self.halved_terms(&part, cut);
                let low = self.upper_bound(low.0, depth - 1, low.1);
                low.max(self.upper_bound(high.0, depth - 1, high.1)).min(part.bound)
            }
            _ => part.bound,
        }
    }

    /// Bounds a polynomial over a part, given by its terms in the part's coordinates.
    fn part(&mut self, mut terms: Terms, mut error: f64) -> SubBox {
        // Fix the variables in which the polynomial is monotonic, until none is left.
        loop {
            self.differentiate(&terms);
            let is_linear = |(m, _): &(u128, f64)| self.space.packing.degree(*m) <= 1;
            if terms.iter().all(is_linear) || !self.slopes.iter().any(|slope| slope.is_monotonic())
            {
                break;
            }
            terms = self.restricted_to_maxima(terms, &mut error);
        }
        // Bound.
        let (bound, middle) = self.bound(&terms);
        self.attained = self.attained.max(middle);
        // Branch: bisect the variable with the largest non-linear derivative.
        let cut = (0..self.slopes.len())
            .max_by(|i, j| self.slopes[*i].non_linear.total_cmp(&self.slopes[*j].non_linear))
            .filter(|i| self.slopes[*i].non_linear > 0.0);
        SubBox { terms, error, bound: add_up(bound, error), cut }
    }

    /// Computes the slope in each variable.
    fn differentiate(&mut self, terms: &Terms) {
        self.slopes.fill(SlopeBounds::default());
        for (m, c) in terms {
            self.space.packing.factors(*m, &mut self.factors);
            match self.factors[..] {
                [i] => self.slopes[usize::from(i)].linear = *c,
                _ => {
                    for i in &self.factors {
                        self.slopes[usize::from(*i)].non_linear += c.abs();
                    }
                }
            }
        }
        let count = terms.len() * self.space.order() as usize;
        for slope in &mut self.slopes {
            slope.non_linear = inflated(slope.non_linear, count);
        }
    }

    /// Restricts the polynomial to its maximum in each variable in which it is monotonic: the
    /// variable becomes the sign of its slope.
    fn restricted_to_maxima(&self, mut terms: Terms, error: &mut f64) -> Terms {
        let packing = self.space.packing;
        let monotonic = || self.slopes.iter().enumerate().filter(|(_, slope)| slope.is_monotonic());
        let fixed = monotonic().fold(0, |bits, (i, _)| bits | packing.exponent_mask(i));
        let falling = monotonic().filter(|(_, slope)| slope.linear < 0.0);
        let negative =
            falling.fold(0, |bits, (i, _)| bits | packing.exponent_mask(i) & packing.odd_exponents);
        for (m, c) in &mut terms {
            if (*m & negative).count_ones() % 2 == 1 {
                *c = -*c;
            }
            *m = match exponents_only(*m) & !fixed {
                0 => 0,
                _ => monotonic().fold(*m, |m, (i, _)| packing.without(m, i)),
            };
        }
        self.collect(terms, error)
    }

    /// Restricts the polynomial to the halves of the side of variable i, x_i = ∓1/2 + x_i'/2. The
    /// second number of each half bounds the error, given the error of the polynomial.
    fn halved_terms(&self, part: &SubBox, i: usize) -> [(Terms, f64); 2] {
        let packing = self.space.packing;
        // The terms c_e x_i^e with one monomial of the other variables become neighbours.
        let mut terms = part.terms.clone();
        terms.sort_unstable_by_key(|(m, _)| packing.without(*m, i));
        let mut halves = [Vec::with_capacity(terms.len()), Vec::with_capacity(terms.len())];
        let mut highest = 0;
        for group in terms.chunk_by(|a, b| packing.without(a.0, i) == packing.without(b.0, i)) {
            let others = packing.without(group[0].0, i);
            let degree = group.iter().map(|(m, _)| packing.exponent(*m, i)).max().unwrap_or(0);
            highest = highest.max(degree);
            for k in 0..=degree {
                let (even, odd) = half_coefficient(packing, group, i, k);
                let monomial = others + u128::from(k) * packing.variable(i);
                for (half, coefficient) in halves.iter_mut().zip([even - odd, even + odd]) {
                    if coefficient != 0.0 {
                        half.push((monomial, coefficient));
                    }
                }
            }
        }
        // Each coefficient has at most `highest` additions and three products, and above e = 50 the
        // roundings of binomial coefficients.
        let error = add_up(part.error, self.rounding(3 * highest as usize + 4, terms.len()));
        halves.map(|terms| (terms, error))
    }

    /// Collects like terms, and adds a bound of the rounding of these sums to the error.
    fn collect(&self, mut terms: Terms, error: &mut f64) -> Terms {
        *error = add_up(*error, self.rounding(terms.len(), terms.len()));
        terms.sort_unstable_by_key(|term| term.0);
        terms.dedup_by(|next, kept| {
            let same = next.0 == kept.0;
            if same {
                kept.1 += next.1;
            }
            same
        });
        terms.retain(|(_, c)| *c != 0.0);
        terms
    }

    /// Bounds the rounding of terms whose coefficients are rounded `roundings` times each.
    fn rounding(&self, roundings: usize, terms: usize) -> f64 {
        let underflow = (roundings * (terms + 1)) as f64 * f64::MIN_POSITIVE;
        add_up(mul_up(roundings as f64 * f64::EPSILON, self.total), underflow)
    }

    /// Returns an upper bound over the whole box, and the value at its centre.
    fn bound(&self, terms: &Terms) -> (f64, f64) {
        let odd = self.space.packing.odd_exponents;
        let (mut middle, mut sum) = (0.0, 0.0);
        for (m, c) in terms {
            match *m {
                0 => middle = *c,
                m if m & odd == 0 => sum += c.max(0.0),
                _ => sum += c.abs(),
            }
        }
        (add_up(middle, inflated(sum, terms.len())), middle)
    }
}

/// Returns the coefficient of x_i'^k for x_i = ±1/2 + x_i'/2 of terms that differ in the exponent
/// of x_i alone, as two parts: the coefficient is the first part plus or minus the second one.
///
/// The coefficient is the sum of c_e C(e, k) (±1/2)^(e - k) / 2^k over e ≥ k.
fn half_coefficient(packing: Packing, group: &[(u128, f64)], i: usize, k: u32) -> (f64, f64) {
    let (mut even, mut odd) = (0.0, 0.0);
    for (m, c) in group {
        let e = packing.exponent(*m, i);
        if e >= k {
            let binomial = (0..k).fold(1.0, |b, j| b * f64::from(e - j) / f64::from(j + 1));
            let value = c * binomial * 0.5f64.powi(e as i32);
            if (e - k).is_multiple_of(2) { even += value } else { odd += value }
        }
    }
    (even, odd)
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::taylor::polynomial::TaylorTerm;

    fn polynomial(terms: &[(&[u8], f64)]) -> TaylorModel {
        let space = TaylorSpace::new(terms[0].0.len(), 8).unwrap();
        let term = |(exponents, coefficient): &(&[u8], f64)| TaylorTerm {
            exponents: exponents.to_vec(),
            coefficient: *coefficient,
        };
        TaylorModel::from(TaylorPolynomial::from_terms(&space, terms.iter().map(term)))
    }

    #[test]
    fn a_monotonic_polynomial_has_its_exact_range() {
        // The minimum is near (-1, -1), the maximum is at (1, 1).
        let p = polynomial(&[
            (&[0, 0], 1.0),
            (&[1, 0], 1.0),
            (&[0, 1], 2.0),
            (&[1, 1], 0.25),
            (&[2, 0], 0.125),
        ]);
        let range = p.tight_range();
        assert!(range.contains(4.375) && range.contains(-1.625), "{range:?}");
        assert!(range.width() < 6.0 + 1e-13 && p.range().width() > 6.1);
    }

    #[test]
    fn polynomials_that_are_not_monotonic_are_bisected() {
        // x - x² has its maximum 1/4 at 1/2; 4x³ - 3x crosses [-1, 1] three times.
        let hill = polynomial(&[(&[1], 1.0), (&[2], -1.0)]).tight_range();
        assert!(
            hill.hi() >= 0.25 && hill.hi() < 0.27 && hill.lo() <= -2.0 && hill.lo() > -2.0 - 1e-13
        );
        let chebyshev = polynomial(&[(&[3], 4.0), (&[1], -3.0)]).tight_range();
        assert!(
            chebyshev.encloses(&Interval::centred(0.0, 1.0 - 1e-15)) && chebyshev.width() < 2.1,
            "{chebyshev:?}"
        );
    }

    #[test]
    fn bounds_enclose_values_of_random_polynomials() {
        let mut bits = 1u64;
        let mut random = || {
            bits = bits.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (bits >> 11) as f64 / 2f64.powi(52) - 1.0
        };
        for _ in 0..300 {
            let space: Arc<TaylorSpace> = TaylorSpace::new(3, 4).unwrap();
            let terms: Vec<_> = (0..12)
                .map(|_| {
                    let exponents = (0..3).map(|_| (random().abs() * 3.0) as u8).collect();
                    TaylorTerm { exponents, coefficient: random().powi(3) }
                })
                .collect();
            let p = TaylorModel::from(TaylorPolynomial::from_terms(&space, terms));
            let (tight, wide) = (p.tight_range(), p.range());
            assert!(wide.encloses(&tight));
            for _ in 0..200 {
                let at: Vec<f64> = (0..3).map(|_| random().clamp(-0.5, 0.5) * 2.0).collect();
                let value = p.polynomial().evaluate(&at);
                assert!(
                    tight.lo() - 1e-13 <= value && value <= tight.hi() + 1e-13,
                    "{value} {tight:?}"
                );
            }
        }
    }
}
