//! Bounds that are as close as a goal asks for, by best-first branch and bound.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use super::bounds::{OVERFLOW_GUARD, inflated};
use super::model::TaylorModel;
use super::tight::{Part, PolynomialSearch};
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
struct Open(Part);

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
