//! Tight bounds of polynomials over [-1, 1]^k: what is monotonic in a variable has its extremes
//! where that is ±1, and what is not is halved.

use super::TaylorModel;
use super::bounds::{LARGEST, inflated};
use crate::rounding::{add_up, mul_up};
use crate::taylor::{collected, exponents_only};
use crate::{Interval, TaylorPolynomial, TaylorSpace};

/// Halvings of the box at most, one after another.
const DEEPEST: u32 = 5;

/// A part of the width of the range that is not worth halving for.
const NEGLIGIBLE: f64 = 0.005;

/// Packed monomials with their coefficients, those of one monomial beside each other.
type Terms = Vec<(u128, f64)>;

impl TaylorModel {
    /// The values over the box, as [`range`](Self::range), and closer where the polynomial is
    /// monotonic in some variables or close to it in parts of the box. It costs more.
    ///
    /// # Guarantee
    ///
    /// Outer. Exact but for rounding and the remainder where the polynomial is monotonic in each
    /// variable, by more than its non-linear terms.
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
        let [below, above] = [-1.0, 1.0].map(|sign| highest(&self.polynomial, sign));
        let tight = Interval::new(-below, above).map(|range| range + self.remainder);
        tight.and_then(|range| range.intersection(whole)).unwrap_or(whole)
    }
}

/// An upper bound of `sign` times the polynomial.
fn highest(p: &TaylorPolynomial, sign: f64) -> f64 {
    let Some(space) = p.space() else { return sign * p.constant_term() };
    let mut terms = Vec::new();
    p.for_each_term(|m, c| terms.push((m, sign * c)));
    let total = inflated(terms.iter().map(|(_, c)| c.abs()).sum(), terms.len());
    if total >= LARGEST {
        return f64::INFINITY;
    }
    let (best, factors) = (f64::NEG_INFINITY, Vec::new());
    let slopes = vec![Slope::default(); space.variables()];
    Search { space, total, best, slopes, factors }.highest(terms, DEEPEST, 0.0)
}

/// The derivative in one variable: of its linear term, and at most so much of all others.
#[derive(Clone, Copy, Default)]
struct Slope {
    linear: f64,
    others: f64,
}

impl Slope {
    fn is_monotonic(self) -> bool {
        self.linear.abs() > self.others
    }
}

/// Polynomials on their way to a bound of the first one, of which they are restrictions.
struct Search<'a> {
    space: &'a TaylorSpace,
    /// Σ |c| of the first.
    total: f64,
    /// The highest value seen, but for rounding.
    best: f64,
    slopes: Vec<Slope>,
    factors: Vec<u8>,
}

impl Search<'_> {
    /// A bound of a polynomial that is within `error` of the one asked for.
    fn highest(&mut self, mut terms: Terms, depth: u32, mut error: f64) -> f64 {
        loop {
            self.differentiate(&terms);
            let is_done = |(m, _): &(u128, f64)| self.space.packing.degree(*m) <= 1;
            if terms.iter().all(is_done) || !self.slopes.iter().any(|slope| slope.is_monotonic()) {
                break;
            }
            terms = self.at_ends(terms, &mut error);
        }
        let (bound, middle) = self.bound(&terms);
        self.best = self.best.max(middle);
        let widest = (0..self.slopes.len())
            .max_by(|i, j| self.slopes[*i].others.total_cmp(&self.slopes[*j].others));
        let is_enough = bound - self.best <= NEGLIGIBLE * self.total;
        match widest {
            Some(i) if depth > 0 && !is_enough && self.slopes[i].others > 0.0 => {
                let [low, high] = [-0.5, 0.5].map(|at| {
                    let mut error = error;
                    let half = self.half(&terms, i, at, &mut error);
                    self.highest(half, depth - 1, error)
                });
                low.max(high).min(add_up(bound, error))
            }
            _ => add_up(bound, error),
        }
    }

    fn differentiate(&mut self, terms: &Terms) {
        self.slopes.fill(Slope::default());
        for (m, c) in terms {
            self.space.packing.factors(*m, &mut self.factors);
            match self.factors[..] {
                [i] => self.slopes[usize::from(i)].linear = *c,
                _ => {
                    self.factors.iter().for_each(|i| self.slopes[usize::from(*i)].others += c.abs())
                }
            }
        }
        let count = terms.len() * self.space.order() as usize;
        self.slopes.iter_mut().for_each(|slope| slope.others = inflated(slope.others, count));
    }

    /// The polynomial where each variable in which it is monotonic has the sign of its slope.
    fn at_ends(&self, mut terms: Terms, error: &mut f64) -> Terms {
        let packing = self.space.packing;
        let monotonic = || self.slopes.iter().enumerate().filter(|(_, slope)| slope.is_monotonic());
        let fixed = monotonic().fold(0, |bits, (i, _)| bits | packing.bits_of(i));
        let falling = monotonic().filter(|(_, slope)| slope.linear < 0.0);
        let negative =
            falling.fold(0, |bits, (i, _)| bits | packing.bits_of(i) & packing.odd_exponents);
        for (m, c) in &mut terms {
            if (*m & negative).count_ones() % 2 == 1 {
                *c = -*c;
            }
            *m = match exponents_only(*m) & !fixed {
                0 => 0,
                _ => monotonic().fold(*m, |m, (i, _)| packing.without(m, i)),
            };
        }
        self.collected(terms, error)
    }

    /// The polynomial over half of the side of variable i, x_i = `at` + x_i'/2.
    fn half(&self, terms: &Terms, i: usize, at: f64, error: &mut f64) -> Terms {
        let packing = self.space.packing;
        let mut all = Vec::with_capacity(2 * terms.len());
        for (m, c) in terms {
            let exponent = packing.exponent(*m, i);
            let (mut key, mut choices) = (*m, 1.0);
            for step in 0..=exponent {
                // c C(e, e - step) at^step / 2^(e - step), of which only the product with c is
                // rounded up to e = 50.
                let factor = choices * at.powi(step as i32) * 0.5f64.powi((exponent - step) as i32);
                all.push((key, c * factor));
                key = if step < exponent { key - packing.variable(i) } else { key };
                choices = choices * f64::from(exponent - step) / f64::from(step + 1);
            }
        }
        self.collected(all, error)
    }

    /// Terms of one monomial summed. The rounding of so many, and of three products in each, is
    /// added to the error.
    fn collected(&self, terms: Terms, error: &mut f64) -> Terms {
        let roundings = (terms.len() + 3) as f64;
        let rounding =
            add_up(mul_up(roundings * f64::EPSILON, self.total), roundings * f64::MIN_POSITIVE);
        *error = add_up(*error, rounding);
        collected(terms)
    }

    /// A bound over the whole box, and the value in its middle.
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

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::TaylorTerm;

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
        // From (-1, -1), where all but the square are below, to (1, 1).
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
    fn what_turns_is_halved() {
        // x - x² has its maximum 1/4 at 1/2; 4x³ - 3x goes between -1 and 1 three times.
        let hill = polynomial(&[(&[1], 1.0), (&[2], -1.0)]).tight_range();
        assert!(
            hill.hi() >= 0.25 && hill.hi() < 0.27 && hill.lo() <= -2.0 && hill.lo() > -2.0 - 1e-13
        );
        let chebyshev = polynomial(&[(&[3], 4.0), (&[1], -3.0)]).tight_range();
        assert!(
            chebyshev.encloses(&Interval::centered(0.0, 1.0 - 1e-15)) && chebyshev.width() < 2.1,
            "{chebyshev:?}"
        );
    }

    #[test]
    fn values_of_random_polynomials_are_within() {
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
