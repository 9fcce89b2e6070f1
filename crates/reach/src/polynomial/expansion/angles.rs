//! Sines and cosines about a point, as functions of the offset d of the angle.
//!
//! With σ = sin d and κ = 1 - cos d,
//!
//! - sin(q + d) = sin q (1 - κ) + cos q σ,
//! - cos(q + d) = cos q (1 - κ) - sin q σ,
//! - σ² = 2κ - κ².
//!
//! A polynomial of degree D in sine and cosine is therefore a combination of φ₀ .. φ₂_D, where
//! φ₂ₖ = (κ - m)ᵏ and φ₂ₖ₊₁ = σ (κ - m)ᵏ. The combination is exact and finite, like the recentred
//! form of a polynomial. The middle m of κ over the set halves the magnitude of products with
//! κ - m. The removed terms, such as m σ, join the constant and linear parts.

use reachtube_scalar::{Interval, TaylorTerm};

/// Largest error of a factor of an angle, in roundings of its magnitude bound.
pub(crate) const FACTOR_ROUNDINGS: f64 = 16.0;

/// The angles of a polynomial: states whose sines and cosines are variables of it.
///
/// The variables are `plain` states and inputs, then the sines, then the cosines of the angles.
#[derive(Debug, Clone)]
pub(crate) struct Angles {
    /// Number of variables that are states or inputs.
    pub plain: usize,
    /// State of each angle.
    pub states: Vec<usize>,
    /// Highest exponents of the sine and of the cosine of each angle.
    highest: Vec<[usize; 2]>,
    /// Index of the first factor of each angle among all factors.
    starts: Vec<usize>,
}

impl Angles {
    /// Collects the highest exponents in polynomials with `plain` variables and two more per state
    /// in `states`.
    pub(crate) fn new<'a>(
        plain: usize,
        states: &[usize],
        terms: impl Iterator<Item = &'a TaylorTerm<Interval>>,
    ) -> Self {
        let mut angles = Self {
            plain,
            states: states.to_vec(),
            highest: vec![[0; 2]; states.len()],
            starts: vec![plain; states.len() + 1],
        };
        for term in terms {
            for i in 0..states.len() {
                let [sine, cosine] = angles.exponents(&term.exponents, i).map(usize::from);
                angles.highest[i] =
                    [angles.highest[i][0].max(sine), angles.highest[i][1].max(cosine)];
            }
        }
        for (i, [sine, cosine]) in angles.highest.iter().enumerate() {
            angles.starts[i + 1] =
                angles.starts[i] + (sine + 1) * (cosine + 1) * (2 * (sine + cosine) + 1);
        }
        angles
    }

    /// Returns the indices of the variables sin and cos of angle i.
    pub(crate) fn variables(&self, i: usize) -> [usize; 2] {
        [self.plain + i, self.plain + self.states.len() + i]
    }

    /// Returns the exponents of sine and cosine of angle i in a monomial.
    pub(crate) fn exponents(&self, monomial: &[u8], i: usize) -> [u8; 2] {
        self.variables(i).map(|variable| monomial[variable])
    }

    /// Allocates the factors of a recentring: the plain variables, then the factors of each angle.
    pub(crate) fn factors(&self) -> Vec<Interval> {
        vec![Interval::ZERO; self.starts[self.states.len()]]
    }

    /// Bounds the magnitudes of the factors at any angle; the plain variables have the bound 0.
    pub(crate) fn magnitudes(&self) -> Vec<f64> {
        let (mut factors, any) = (self.factors(), Interval::centred(0.0, 1.0));
        (0..self.states.len())
            .for_each(|i| self.set_factors(i, [any, any, any.abs()], &mut factors));
        factors.iter().map(|factor| factor.mag()).collect()
    }

    /// Returns the index of the factor of φ_l in sinᵃ cosᵇ of angle i.
    pub(crate) fn factor(&self, i: usize, [sine, cosine]: [u8; 2], l: usize) -> usize {
        self.column(i, sine.into(), cosine.into()) + l
    }

    /// Returns the index of the first factor of sinᵃ cosᵇ of angle i.
    fn column(&self, i: usize, sine: usize, cosine: usize) -> usize {
        let highest = self.highest[i];
        self.starts[i] + (sine * (highest[1] + 1) + cosine) * (2 * (highest[0] + highest[1]) + 1)
    }

    /// Sets the factors of angle i at q (rad), for a middle of κ from 0 to 1.
    ///
    /// # Guarantee
    ///
    /// Each factor encloses the exact one.
    pub(crate) fn expand_at(&self, i: usize, q: f64, middle: f64, factors: &mut [Interval]) {
        let (sin, cos) = Interval::point(q).sin_cos();
        self.set_factors(i, [sin, cos, Interval::point(middle)], factors);
    }

    /// Sets the factors of all sinᵃ cosᵇ of angle i, each from one of a lower degree.
    fn set_factors(&self, i: usize, [sin, cos, middle]: [Interval; 3], factors: &mut [Interval]) {
        let [sines, cosines] = self.highest[i];
        factors[self.starts[i]..self.starts[i + 1]].fill(Interval::ZERO);
        factors[self.starts[i]] = Interval::ONE;
        for sine in 0..=sines {
            if sine > 0 {
                self.multiply(
                    i,
                    [self.column(i, sine - 1, 0), self.column(i, sine, 0)],
                    [sin, cos, middle],
                    factors,
                );
            }
            for cosine in 1..=cosines {
                let columns = [self.column(i, sine, cosine - 1), self.column(i, sine, cosine)];
                self.multiply(i, columns, [cos, -sin, middle], factors);
            }
        }
    }

    /// Converts the slope of a variable to the slope of a state or input.
    ///
    /// The slope of an angle is the slope of its sine, times the slope of the line that stands for
    /// the sine.
    pub(crate) fn chain_slope(
        &self,
        variable: usize,
        slope: Interval,
        sine_slopes: &[f64],
    ) -> (usize, Interval) {
        match variable.checked_sub(self.plain) {
            None => (variable, slope),
            Some(i) => (self.states[i], slope * sine_slopes[i]),
        }
    }

    /// Adds the column `from`, times x (1 - κ) + y σ, to the column `to`.
    fn multiply(
        &self,
        i: usize,
        [from, to]: [usize; 2],
        [x, y, middle]: [Interval; 3],
        factors: &mut [Interval],
    ) {
        let [sines, cosines] = self.highest[i];
        for l in 0..2 * (sines + cosines) {
            let own = factors[from + l];
            if own == Interval::ZERO {
                continue;
            }
            factors[to + l] += x * (Interval::ONE - middle) * own;
            factors[to + l + 2] -= x * own;
            if l % 2 == 0 {
                factors[to + l + 1] += y * own;
            } else {
                // With c = 1 - m and p = κ - m, σ² = 1 - c² + 2 c p - p².
                let c = Interval::ONE - middle;
                factors[to + l - 1] += y * own * (Interval::ONE - c.sqr());
                factors[to + l + 1] += y * own * c * 2.0;
                factors[to + l + 3] -= y * own;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::polynomial::expansion::sine_bounds::sine_and_versine;

    proptest! {
        #[test]
        fn the_expansion_agrees_with_sine_and_cosine_of_the_sum(
            q in -9.0..9.0_f64, d in -1.0..1.0_f64, middle in 0.0..=1.0_f64,
        ) {
            let highest = TaylorTerm { exponents: vec![0, 3, 2], coefficient: Interval::ONE };
            let angles = Angles::new(1, &[0], [highest].iter());
            let mut factors = angles.factors();
            angles.expand_at(0, q, middle, &mut factors);
            let (sine, versine) = sine_and_versine(Interval::point(d));
            let (sin, cos) = (Interval::point(q) + d).sin_cos();
            for (a, b) in (0..=3_u8).flat_map(|a| (0..=2).map(move |b| (a, b))) {
                let phi = |l: i32| {
                    (versine - middle).powi(l / 2) * if l % 2 == 0 { Interval::ONE } else { sine }
                };
                let factor = |l: u8| factors[angles.factor(0, [a, b], l.into())];
                let sum: Interval = (0..=2 * (a + b)).map(|l| factor(l) * phi(l.into())).sum();
                let exact = sin.powi(a.into()) * cos.powi(b.into());
                prop_assert!(
                    sum.intersection(exact).is_some() && sum.width() < 1e-12,
                    "{a} {b} {sum:?} {exact:?}"
                );
            }
        }
    }
}
