//! Sines and cosines about a point, as functions of how far the angle is from there.
//!
//! With σ = sin d and κ = 1 - cos d, sin(q + d) = sin q (1 - κ) + cos q σ and cos(q + d) = cos q (1
//! - κ) - sin q σ; and σ² = 2κ - κ². So a polynomial of degree D in sine and cosine is a
//! combination of φ₀ .. φ₂_D, where φ₂ₖ = (κ - m)ᵏ and φ₂ₖ₊₁ = σ (κ - m)ᵏ: exact and finite, as the
//! shift of a polynomial is. The middle m of κ over the set halves what products with it are, and
//! what it takes from them is linear.

use reachtube_scalar::{Interval, TaylorTerm};

/// What a factor of an angle may be off by, in roundings of the bound of its magnitude.
pub(super) const TURN_ROUNDINGS: f64 = 16.0;

/// States whose sine and cosine a polynomial has: its variables are others, `plain` of them, then
/// the sines, then the cosines.
#[derive(Debug, Clone)]
pub(super) struct Angles {
    pub plain: usize,
    /// The state of each.
    pub states: Vec<usize>,
    /// The highest exponents of each one's sine and cosine.
    highest: Vec<[usize; 2]>,
    /// Where the factors of each begin, among those of all.
    starts: Vec<usize>,
}

impl Angles {
    /// Those of some polynomials in `plain` variables and two for each of `states`.
    pub fn new<'a>(
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

    /// The variables that stand for the sine and the cosine of angle i.
    pub fn places(&self, i: usize) -> [usize; 2] {
        [self.plain + i, self.plain + self.states.len() + i]
    }

    /// The exponents of sine and cosine of angle i in a monomial.
    pub fn exponents(&self, monomial: &[u8], i: usize) -> [u8; 2] {
        self.places(i).map(|place| monomial[place])
    }

    /// Numbers that a shift is made of: the plain variables, then the factors of each angle.
    pub fn factors(&self) -> Vec<Interval> {
        vec![Interval::ZERO; self.starts[self.states.len()]]
    }

    /// Bounds of the magnitudes of the factors at any angle; zero for the plain variables.
    pub fn magnitudes(&self) -> Vec<f64> {
        let (mut factors, any) = (self.factors(), Interval::centered(0.0, 1.0));
        (0..self.states.len()).for_each(|i| self.columns(i, [any, any, any.abs()], &mut factors));
        factors.iter().map(|factor| factor.mag()).collect()
    }

    /// Where the factor of φ_l is in sin^a cos^b of angle i.
    pub fn factor(&self, i: usize, [sine, cosine]: [u8; 2], l: usize) -> usize {
        self.column(i, sine.into(), cosine.into()) + l
    }

    fn column(&self, i: usize, sine: usize, cosine: usize) -> usize {
        let highest = self.highest[i];
        self.starts[i] + (sine * (highest[1] + 1) + cosine) * (2 * (highest[0] + highest[1]) + 1)
    }

    /// The factors of angle i at q (rad), for a middle of κ from 0 to 1.
    ///
    /// # Guarantee
    ///
    /// Each encloses the exact one.
    pub fn turn(&self, i: usize, q: f64, middle: f64, factors: &mut [Interval]) {
        let (sin, cos) = Interval::point(q).sin_cos();
        self.columns(i, [sin, cos, Interval::point(middle)], factors);
    }

    fn columns(&self, i: usize, [sin, cos, middle]: [Interval; 3], factors: &mut [Interval]) {
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

    /// Which state the slope of a variable is one of, and how large: that of an angle is of its
    /// sine, along the sine's line.
    pub fn along_line(&self, variable: usize, slope: Interval, lines: &[f64]) -> (usize, Interval) {
        match variable.checked_sub(self.plain) {
            None => (variable, slope),
            Some(i) => (self.states[i], slope * lines[i]),
        }
    }

    /// Adds x (1 - κ) + y σ times one column to another one.
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
                // σ² about the middle.
                let rest = Interval::ONE - middle;
                factors[to + l - 1] += y * own * (Interval::ONE - rest.sqr());
                factors[to + l + 1] += y * own * rest * 2.0;
                factors[to + l + 3] -= y * own;
            }
        }
    }
}

/// (σ, κ) for offsets d.
///
/// # Guarantee
///
/// Outer, directed rounding; beyond the circle by rounding at most.
pub(super) fn versed(d: Interval) -> (Interval, Interval) {
    (d.sin(), (d * 0.5).sin().sqr() * 2.0)
}

/// The middle of κ over |d| <= r, about.
pub(super) fn versine_middle(r: f64) -> f64 {
    (0.5 * r.min(std::f64::consts::PI)).sin().powi(2)
}

/// The slope of the line that fits sin d best over |d| <= r, about: 2 J₁(r)/r, that of the first
/// Chebyshev polynomial, and 0 where it falls below.
pub(super) fn sine_slope(r: f64) -> f64 {
    let x = (0.5 * r).powi(2);
    if r < 3.8 {
        1.0 - x / 2.0 * (1.0 - x / 6.0 * (1.0 - x / 12.0 * (1.0 - x / 20.0)))
    } else {
        0.0
    }
    .max(0.0)
}

/// sin d - slope d for offsets d and a slope from 0 to 1.
///
/// # Guarantee
///
/// Outer, directed rounding.
pub(super) fn sine_defect(d: Interval, slope: f64) -> Interval {
    let half = |lo: f64, hi: f64| {
        let side = Interval::new(lo.max(0.0), hi).filter(|_| hi >= 0.0)?;
        Some(if hi < 3.0 { concave_defect(side, slope) } else { side.sin() - side * slope })
    };
    let (above, below) = (half(d.lo(), d.hi()), half(-d.hi(), -d.lo()).map(|x| -x));
    above.into_iter().chain(below).reduce(Interval::hull).unwrap_or(Interval::ENTIRE)
}

/// Over a side in \[0, π\], where it is concave: above the smaller of the values at the ends, and
/// below every tangent.
fn concave_defect(side: Interval, slope: f64) -> Interval {
    let value = |d: f64| Interval::point(d).sin() - Interval::point(d) * slope;
    let top = slope.clamp(-1.0, 1.0).acos().clamp(side.lo(), side.hi());
    let tilt = Interval::point(top).cos() - slope;
    let highest = value(top) + tilt * (side - top);
    value(side.lo()).hull(value(side.hi())).hull(Interval::point(highest.hi()))
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn sines_and_cosines_are_those_of_the_sum(q in -9.0..9.0_f64, d in -1.0..1.0_f64, middle in 0.0..=1.0_f64) {
            let highest = TaylorTerm { exponents: vec![0, 3, 2], coefficient: Interval::ONE };
            let angles = Angles::new(1, &[0], [highest].iter());
            let mut factors = angles.factors();
            angles.turn(0, q, middle, &mut factors);
            let (sine, versine) = versed(Interval::point(d));
            let (sin, cos) = (Interval::point(q) + d).sin_cos();
            for (a, b) in (0..=3_u8).flat_map(|a| (0..=2).map(move |b| (a, b))) {
                let phi = |l: i32| (versine - middle).powi(l / 2) * if l % 2 == 0 { Interval::ONE } else { sine };
                let sum: Interval =
                    (0..=2 * (a + b)).map(|l| factors[angles.factor(0, [a, b], l.into())] * phi(l.into())).sum();
                let exact = sin.powi(a.into()) * cos.powi(b.into());
                prop_assert!(sum.intersection(exact).is_some() && sum.width() < 1e-12, "{a} {b} {sum:?} {exact:?}");
            }
        }

        #[test]
        fn a_sine_is_near_its_line(lo in -4.0..4.0_f64, width in 0.0..4.0_f64, slope in 0.0..1.0_f64, at in 0.0..=1.0_f64) {
            let side = Interval::new(lo, lo + width).unwrap();
            let defect = sine_defect(side, slope);
            let d = (lo + at * width).clamp(lo, lo + width);
            let value = d.sin() - slope * d;
            prop_assert!(defect.lo() - 1e-15 <= value && value <= defect.hi() + 1e-15, "{defect:?} {value}");
            if side.mag() < 3.0 {
                let values = (0..=1000).map(|k| lo + f64::from(k) * 1e-3 * width).map(|d| d.sin() - slope * d);
                let (low, high) = values.fold((f64::MAX, f64::MIN), |(low, high), x| (low.min(x), high.max(x)));
                prop_assert!(defect.width() <= high - low + 1e-5);
            }
        }
    }

    #[test]
    fn the_line_leaves_a_quarter_of_the_cube() {
        for r in [1e-3, 0.1, 0.5, 1.0, 2.0] {
            let defect = sine_defect(Interval::new(-r, r).unwrap(), sine_slope(r));
            assert!(defect.mag() < 1.1 * r.powi(3) / 24.0, "{r}: {defect:?}");
        }
        assert_eq!(sine_slope(5.0), 0.0);
        let (sine, versine) = versed(Interval::new(-9.0, 9.0).unwrap());
        assert!(
            (sine.mag(), versine.lo()) == (1.0, 0.0) && (2.0..2.0 + 1e-14).contains(&versine.hi())
        );
    }
}
