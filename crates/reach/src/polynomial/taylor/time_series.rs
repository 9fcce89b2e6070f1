//! The solution over one step as a power series in time, with a bound of its defect.

use reachtube_scalar::{Interval, TaylorModel};

use crate::polynomial::taylor::monomials::Monomials;
use crate::polynomial::taylor::set::TaylorSet;

/// The power series P(τ, s) = Σ X_i(s) τⁱ, i <= K, of the solution from x(0) = X₀(s), with the time
/// τ in steps, 0 <= τ <= 1.
///
/// The error of P is measured by its defect h f(P) - dP/dτ for a fixed input. The terms of the
/// defect below τᴷ are the truncation errors, in s, and the rounding errors of the X_i. The terms
/// from τᴷ on are bounded.
#[derive(Debug)]
pub(crate) struct TimeSeries {
    /// Terms of each monomial below τᴷ; terms of each state up to τᴷ.
    terms: Vec<Vec<TaylorModel>>,
    /// Ranges of these terms below τᴷ.
    ranges: Vec<Vec<Interval>>,
    /// Sum of the terms of each monomial from τᴷ on, divided by τᴷ.
    tails: Vec<Interval>,
    /// Terms i ρ_i of each state, with the discarded remainder ρ_i of X_i, 0 < i <= K.
    defects: Vec<Vec<Interval>>,
    /// Defect of each state from τᴷ on, divided by τᴷ.
    defect_tails: Vec<Interval>,
    order: usize,
}

impl TimeSeries {
    /// Computes the series from the polynomials of `start` (N), under the fixed `input` (m), over a
    /// step of length h, to the order K = `order` in time.
    pub(crate) fn new(
        monomials: &Monomials,
        start: &TaylorSet,
        input: &[f64],
        h: Interval,
        order: usize,
    ) -> Self {
        let states = start.polynomials.len();
        let inputs = input.iter().map(|u| TaylorModel::from(*u));
        let mut series = Self {
            terms: start.polynomials.iter().cloned().chain(inputs).map(|term| vec![term]).collect(),
            ranges: Vec::new(),
            tails: vec![Interval::ZERO; monomials.count()],
            defects: vec![Vec::with_capacity(order); states],
            defect_tails: vec![Interval::ZERO; states],
            order,
        };
        series.terms.resize(monomials.count(), Vec::with_capacity(order));
        let h = TaylorModel::from(h);
        for i in 0..order {
            series.multiply(monomials, i);
            series.extend(monomials, i, &h);
        }
        series.bound(monomials, &start.ranges, &h);
        series
    }

    /// Computes the terms of the products at τⁱ.
    fn multiply(&mut self, monomials: &Monomials, i: usize) {
        for (product, [left, right]) in monomials.products.iter().enumerate() {
            let mut sum = TaylorModel::from(0.0);
            for j in 0..=i {
                if let (Some(x), Some(y)) =
                    (self.terms[*left].get(j), self.terms[*right].get(i - j))
                {
                    sum += x * y;
                }
            }
            self.terms[monomials.variables + product].push(sum);
        }
    }

    /// Computes X_{i+1} = h f_i / (i + 1), keeps its polynomial and records its remainder as a
    /// defect.
    fn extend(&mut self, monomials: &Monomials, i: usize, h: &TaylorModel) {
        for (state, row) in monomials.rows.iter().enumerate() {
            let mut sum = if i == 0 {
                TaylorModel::from(monomials.constants[state])
            } else {
                TaylorModel::from(0.0)
            };
            for (index, coefficient) in row {
                if let Some(term) = self.terms[*index].get(i) {
                    sum += term * &TaylorModel::from(*coefficient);
                }
            }
            let count = i as f64 + 1.0;
            let next = (&sum * h).divided(count);
            self.defects[state].push(next.remainder() * count);
            self.terms[state].push(TaylorModel::from(next.polynomial().clone()));
        }
    }

    /// Bounds the ranges of all terms, given the ranges of the first terms, and the tails.
    fn bound(&mut self, monomials: &Monomials, first: &[Interval], h: &TaylorModel) {
        self.ranges =
            self.terms.iter().map(|terms| terms.iter().map(TaylorModel::range).collect()).collect();
        for ((ranges, tail), first) in self.ranges.iter_mut().zip(&mut self.tails).zip(first) {
            *tail = ranges[self.order];
            ranges.truncate(self.order);
            ranges[0] = *first;
        }
        for (product, [left, right]) in monomials.products.iter().enumerate() {
            self.tails[monomials.variables + product] = self.tail_of_product(*left, *right);
        }
        for (state, row) in monomials.rows.iter().enumerate() {
            let sum: Interval =
                row.iter().map(|(index, coefficient)| self.tails[*index] * *coefficient).sum();
            self.defect_tails[state] = sum * h.range();
        }
    }

    /// Bounds the terms of a product from τᴷ on, divided by τᴷ.
    fn tail_of_product(&self, left: usize, right: usize) -> Interval {
        let (x, y) = (&self.ranges[left], &self.ranges[right]);
        let mut sum = Interval::ZERO;
        for (i, x) in x.iter().enumerate() {
            for y in y.iter().skip(self.order - i) {
                sum += (*x * *y).hull(Interval::ZERO);
            }
        }
        let (below, tail) = (
            [left, right].map(|factor| over_step(&self.ranges[factor])),
            [left, right].map(|factor| self.tails[factor]),
        );
        sum + below[0] * tail[1] + below[1] * tail[0] + (tail[0] * tail[1]).hull(Interval::ZERO)
    }

    /// Encloses P of a state over the step.
    ///
    /// # Guarantee
    ///
    /// Outer, directed rounding.
    pub(crate) fn range(&self, state: usize) -> Interval {
        over_step(&self.ranges[state]) + self.tails[state].hull(Interval::ZERO)
    }

    /// Returns P of a state at the end of the step.
    pub(crate) fn end(&self, state: usize) -> TaylorModel {
        self.terms[state].iter().rev().fold(TaylorModel::from(0.0), |sum, term| &sum + term)
    }

    /// Encloses the defect of a state at any time of the step.
    ///
    /// # Guarantee
    ///
    /// Outer, directed rounding.
    pub(crate) fn defect(&self, state: usize) -> Interval {
        over_step(&self.defects[state]) + self.defect_tails[state].hull(Interval::ZERO)
    }

    /// Encloses the integral of the defect of a state over the step.
    ///
    /// # Guarantee
    ///
    /// Outer, directed rounding.
    pub(crate) fn defect_integral(&self, state: usize) -> Interval {
        let terms = self.defects[state].iter().chain([&self.defect_tails[state]]).enumerate();
        terms.map(|(i, defect)| *defect / Interval::point(i as f64 + 1.0)).sum()
    }
}

/// Encloses Σ c_i τⁱ for 0 <= τ <= 1.
fn over_step(terms: &[Interval]) -> Interval {
    let later = terms.iter().skip(1).map(|c| c.hull(Interval::ZERO)).sum::<Interval>();
    terms.first().map_or(later, |first| *first + later)
}

#[cfg(test)]
mod tests {
    use reachtube_scalar::{TaylorPolynomial, TaylorSpace};

    use super::*;

    /// Computes the series of ẋ = x² + u over a step of length h from 1 + [-r, r], to the given
    /// orders in s and in time.
    fn square(h: f64, r: f64, orders: (u32, usize), u: f64) -> TimeSeries {
        let space = TaylorSpace::new(2, 2).unwrap();
        let [x, u_variable] = [0, 1].map(|i| TaylorPolynomial::<Interval>::variable(&space, i));
        let monomials = Monomials::new(2, &[&x * &x + u_variable]);
        let start = TaylorSet::new(
            &TaylorSpace::new(1, orders.0).unwrap(),
            &[Interval::centred(1.0, r)],
            usize::MAX,
        );
        TimeSeries::new(&monomials, &start, &[u], Interval::point(h), orders.1)
    }

    #[test]
    fn the_series_agrees_with_the_solution() {
        // The solution is 1 / (1 - t) = 1 + t + t² + ...
        let series = square(0.125, 0.0, (1, 6), 0.0);
        for (i, term) in series.terms[0].iter().enumerate() {
            assert!((term.range() - 0.125f64.powi(i as i32)).mag() < 1e-16, "{term:?}");
        }
        let end: f64 = (0..=6).map(|i| 0.125f64.powi(i)).sum();
        assert!((series.end(0).range() - end).mag() < 1e-15);
    }

    #[test]
    fn the_defect_is_enclosed_and_tight() {
        // For each start, the exact defect h f(P) - dP/dτ is a polynomial in τ.
        for (h, r, orders, u) in
            [(0.1, 0.0, (1, 3), 0.0), (0.1, 0.2, (2, 4), 0.5), (0.05, 0.3, (1, 5), -1.0)]
        {
            let series = square(h, r, orders, u);
            let (bound, integral) = (series.defect(0), series.defect_integral(0));
            let mut largest: f64 = 0.0;
            for s in [-1.0, -0.3, 0.0, 0.8, 1.0] {
                let c: Vec<f64> =
                    series.terms[0].iter().map(|term| term.polynomial().evaluate(&[s])).collect();
                let p = |tau: f64| c.iter().rev().fold(0.0, |sum, c| sum * tau + c);
                let slope = |tau: f64| {
                    (1..c.len()).map(|i| i as f64 * c[i] * tau.powi(i as i32 - 1)).sum::<f64>()
                };
                let defect = |tau: f64| h * (p(tau).powi(2) + u) - slope(tau);
                let taus: Vec<f64> = (0..=1000).map(|k| f64::from(k) / 1000.0).collect();
                for tau in &taus {
                    let near = bound + Interval::centred(0.0, 1e-14);
                    assert!(near.contains(defect(*tau)), "{} is not in {bound:?}", defect(*tau));
                    assert!((series.range(0) + Interval::centred(0.0, 1e-14)).contains(p(*tau)));
                    largest = largest.max(defect(*tau).abs());
                }
                // Integral by Simpson's rule, with an error below 1e-12.
                let weight =
                    |k: usize| if k == 0 || k == 1000 { 1.0 } else { 2.0 + 2.0 * (k % 2) as f64 };
                let sum =
                    taus.iter().enumerate().map(|(k, tau)| weight(k) * defect(*tau)).sum::<f64>()
                        / 3000.0;
                assert!(
                    (integral + Interval::centred(0.0, 1e-12)).contains(sum),
                    "{sum} is not in {integral:?}"
                );
            }
            assert!(bound.mag() < 4.0 * largest, "{bound:?} {largest}");
        }
    }
}
