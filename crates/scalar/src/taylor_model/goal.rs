//! Bounds that are as close as a goal asks for, by best-first branch and bound.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use super::bounds::{OVERFLOW_GUARD, inflated};
use super::model::TaylorModel;
use super::tight::{PolynomialSearch, SubBox};
use crate::interval::closed::Interval;
use crate::rounding::add_up;
use crate::taylor::polynomial::TaylorPolynomial;

impl TaylorModel {
    /// Encloses the range over the box. The box is cut until the magnitude of the enclosure is at
    /// most `goal`, or until there are `most_parts` parts for each end of the enclosure.
    ///
    /// # Guarantee
    ///
    /// Outer.
    ///
    /// # Examples
    ///
    /// ```
    /// use reachtube_scalar::{Interval, TaylorBox, TaylorSpace};
    ///
    /// let space = TaylorSpace::new(1, 3).unwrap();
    /// let x = TaylorBox::new(&space, &[Interval::new(-1.0, 1.0).unwrap()]).variable(0);
    /// let wave = x.clone() * x.clone() * x.clone() - x; // within ±0.385
    /// assert!(wave.range().mag() >= 2.0);
    /// assert!(wave.range_to_goal(0.4, 100).mag() <= 0.4);
    /// ```
    #[must_use]
    pub fn range_to_goal(&self, goal: f64, most_parts: usize) -> Interval {
        let whole = self.range();
        if whole.mag() <= goal {
            return whole;
        }
        let goal = goal - self.remainder.mag();
        let [below, above] =
            [-1.0, 1.0].map(|sign| bound_to_goal(&self.polynomial, sign, goal, most_parts));
        let close = Interval::new(-below, above).map(|range| range + self.remainder);
        close.and_then(|range| range.intersection(whole)).unwrap_or(whole)
    }

    /// Returns the model without its smallest terms, which are enclosed by the remainder. The
    /// magnitudes of the terms that are dropped sum up to at most `slack`.
    ///
    /// # Guarantee
    ///
    /// Outer: it encloses each function that this model encloses.
    #[must_use]
    pub fn without_small_terms(&self, slack: f64) -> Self {
        let Some(space) = self.polynomial.space() else { return self.clone() };
        let mut terms = Vec::new();
        self.polynomial.for_each_term(|m, c| terms.push((m, *c)));
        terms.sort_by(|a, b| a.1.abs().total_cmp(&b.1.abs()));
        let (mut dropped, mut count) = (0.0, 0);
        while let Some((_, c)) = terms.get(count) {
            let sum = add_up(dropped, c.abs());
            if sum > slack {
                break;
            }
            (dropped, count) = (sum, count + 1);
        }
        terms.drain(..count);
        terms.sort_by_key(|term| term.0);
        let kept = TaylorPolynomial::sparse(space, terms);
        Self::new(kept, self.remainder).widened(Interval::centred(0.0, dropped))
    }
}

/// A part of the box in the queue; the part with the highest bound comes first.
struct Open(SubBox);

impl PartialEq for Open {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Open {}

impl PartialOrd for Open {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Open {
    fn cmp(&self, other: &Self) -> Ordering {
        self.0.bound.total_cmp(&other.0.bound)
    }
}

/// Returns an upper bound of `sign` times the polynomial over [-1, 1]^k. The search ends where the
/// bound is at most `goal`, or at `most_parts` parts.
fn bound_to_goal(p: &TaylorPolynomial, sign: f64, goal: f64, most_parts: usize) -> f64 {
    let Some(space) = p.space() else { return sign * p.constant_term() };
    let mut terms = Vec::new();
    p.for_each_term(|m, c| terms.push((m, sign * c)));
    let total = inflated(terms.iter().map(|(_, c)| c.abs()).sum(), terms.len());
    if total >= OVERFLOW_GUARD {
        return f64::INFINITY;
    }
    let mut search = PolynomialSearch::new(space, total);
    // Parts below the goal are dropped; they count at the end as the goal or less.
    let (mut queue, mut closed) = (BinaryHeap::new(), f64::NEG_INFINITY);
    queue.push(Open(search.part(terms, 0.0)));
    let mut parts = 1;
    while let Some(Open(part)) = queue.pop() {
        let bound = part.bound;
        let Some(cut) = part.cut.filter(|_| bound > goal && parts < most_parts) else {
            return bound.max(closed);
        };
        for half in search.halves(&part, cut) {
            if half.bound <= goal {
                closed = closed.max(half.bound);
            } else {
                queue.push(Open(half));
            }
        }
        parts += 1;
    }
    closed
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::taylor::polynomial::TaylorTerm;
    use crate::taylor::space::TaylorSpace;

    /// Returns a reproducible number in [-1, 1].
    fn number(bits: &mut u64) -> f64 {
        *bits = bits.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (*bits >> 11) as f64 / 2f64.powi(52) - 1.0
    }

    /// Returns a polynomial of three variables with 16 terms up to degree 6.
    fn random_polynomial(bits: &mut u64) -> TaylorModel {
        let space = TaylorSpace::new(3, 6).unwrap();
        let mut term = || TaylorTerm {
            exponents: (0..3).map(|_| (number(bits).abs() * 4.0) as u8).collect(),
            coefficient: number(bits),
        };
        TaylorModel::from(TaylorPolynomial::from_terms(&space, (0..16).map(|_| term())))
    }

    #[test]
    fn bounds_enclose_values_and_reach_goals_that_are_not_too_close() {
        let mut bits = 3;
        for _ in 0..60 {
            let p = random_polynomial(&mut bits);
            let mut largest = 0.0f64;
            let close = p.range_to_goal(0.0, 200);
            for _ in 0..4000 {
                let at: Vec<f64> =
                    (0..3).map(|_| (1.5 * number(&mut bits)).clamp(-1.0, 1.0)).collect();
                let value = p.polynomial().evaluate(&at);
                largest = largest.max(value.abs());
                assert!(close.lo() - 1e-13 <= value && value <= close.hi() + 1e-13, "{close:?}");
            }
            assert!(p.range().encloses(&close) && close.mag() < 1.2 * largest, "{close:?}");
            let goal = 1.3 * largest;
            let enough = p.range_to_goal(goal, 200);
            assert!(enough.mag() <= goal && enough.encloses(&close), "{enough:?} {goal}");
        }
    }

    #[test]
    fn small_terms_go_into_the_remainder() {
        let mut bits = 5;
        for _ in 0..50 {
            let p = random_polynomial(&mut bits);
            let fewer = p.without_small_terms(0.5);
            assert!(fewer.polynomial().term_count() < p.polynomial().term_count());
            assert!(fewer.remainder().mag() <= 0.5);
            let at: Vec<f64> = (0..3).map(|_| number(&mut bits)).collect();
            let value = |model: &TaylorModel| model.polynomial().evaluate(&at);
            let rest = Interval::point(value(&p) - value(&fewer));
            assert!((fewer.remainder() + Interval::centred(0.0, 1e-14)).encloses(&rest));
        }
    }
}
