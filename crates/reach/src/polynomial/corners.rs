//! The range of a polynomial over a box, by the corners of some of its sides.
//!
//! An odd power is x times an even one, as φ₂ₖ₊₁ = σ (κ - m)ᵏ is. So x, x², σ and κ - m are once at
//! most in a monomial whose higher powers are bounded apart: in each the polynomial is affine.
//! Whatever the other factors are, over those that are chosen it is therefore largest and smallest
//! at corners of their box. At one of them the terms of Σ_S a_S Π_{i ∈ S} x_i cancel as they do,
//! which a sum of ranges does not see; all 2ⁿ take n 2ⁿ products together.
//!
//! Where both x and x² are chosen, x³ is x times a range, so that the polynomial is affine in the
//! pair, and corners are those of a trapezoid about the parabola: (±r, r²) and, on the tangents
//! there, (±r/2, 0). For an angle they are (±sin r, 1 - cos r) and (±tan(r/2), 0).

use reachtube_scalar::Interval;

use super::powers::PowerTable;

/// Factors that are chosen at most: all corners are kept.
const MOST: usize = 20;

/// Roundings of a term that has a chosen factor, those of the factor's ends included.
pub(super) const ROUNDINGS: usize = 8;

/// A monomial, or a part of one, over a box: the chosen factors in it, each divided by its largest
/// magnitude, times all else.
#[derive(Debug, Clone, Copy)]
pub(super) struct Monomial {
    /// A bit each chosen factor.
    chosen: u32,
    /// The range of all else, up to rounding.
    rest: [f64; 2],
}

impl Monomial {
    pub const ONE: Self = Self { chosen: 0, rest: [1.0; 2] };

    #[inline]
    pub fn times(self, other: Self) -> Self {
        let ([a, b], [c, d]) = (self.rest, other.rest);
        let products = [a * c, a * d, b * c, b * d];
        let smaller = |x: f64, y: f64| if x < y { x } else { y };
        let larger = |x: f64, y: f64| if x > y { x } else { y };
        let lo = smaller(smaller(products[0], products[1]), smaller(products[2], products[3]));
        let hi = larger(larger(products[0], products[1]), larger(products[2], products[3]));
        Self { chosen: self.chosen | other.chosen, rest: [lo, hi] }
    }

    #[inline]
    pub fn magnitude(self) -> f64 {
        self.rest[0].abs().max(self.rest[1].abs())
    }
}

/// A chosen factor, divided by its largest magnitude.
#[derive(Debug)]
struct Side {
    /// Its ends where its square is least, and where it is largest.
    ends: [[f64; 2]; 2],
    /// Corners in a row for which it is the same of both.
    run: usize,
}

/// Scratch memory for one polynomial after the other.
#[derive(Debug)]
pub(super) struct Corners {
    /// Chosen factors at most.
    most: usize,
    /// Of those present, squares last.
    sides: Vec<Side>,
    /// What the powers are as parts of monomials.
    parts: Vec<Monomial>,
    /// How much of the sum has each of the factors.
    weights: Vec<f64>,
    /// The coefficients a_S, each a middle and a radius, and then the values at the corners.
    values: Vec<[f64; 2]>,
}

impl Corners {
    /// Of `most` factors, for powers as those in a table.
    pub fn new(most: usize, powers: &PowerTable) -> Self {
        let most = most.min(MOST);
        Self {
            most,
            sides: Vec::with_capacity(most),
            parts: vec![Monomial::ONE; powers.len()],
            weights: vec![0.0; powers.len()],
            values: Vec::with_capacity(1 << most),
        }
    }

    /// Begins a sum with the powers divided into chosen factors and others.
    pub fn divide(&mut self, powers: &PowerTable, chosen: &[usize]) {
        self.sides.clear();
        self.values.clear();
        self.values.resize(1 << chosen.len(), [0.0; 2]);
        for (start, powers) in powers.lists() {
            let bit = |place: usize| chosen.iter().position(|own| *own == place).map(|i| 1 << i);
            let (odd, even) = (bit(start), bit(start + 1).filter(|_| powers.len() > 1));
            for (k, part) in self.parts[start..start + powers.len()].iter_mut().enumerate() {
                *part = divided(powers, k + 1, odd, even);
            }
        }
        for &place in chosen {
            let (side, size) = (powers.at(place), powers.at(place).mag().max(f64::MIN_POSITIVE));
            let trapezoid = powers.trapezoid(place);
            let square =
                trapezoid.and_then(|(square, _)| chosen.iter().position(|own| *own == square));
            let waist = trapezoid.map(|(_, waist)| waist).filter(|_| square.is_some());
            let whole = [side.lo() / size, side.hi() / size];
            let ends = waist.map_or([whole; 2], |waist| [[-waist, waist], [-1.0, 1.0]]);
            self.sides.push(Side { ends, run: 1 << square.unwrap_or(chosen.len()) });
        }
    }

    #[inline]
    pub fn part(&self, place: usize) -> Monomial {
        self.parts[place]
    }

    /// Adds c times a monomial.
    #[inline]
    pub fn add(&mut self, c: f64, monomial: Monomial) {
        let [lo, hi] = monomial.rest;
        let [middle, radius] = &mut self.values[monomial.chosen as usize];
        *middle += c * (0.5 * (lo + hi));
        *radius += c.abs() * (0.5 * (hi - lo));
    }

    /// The range of the sum, up to [`ROUNDINGS`] of each term a factor.
    pub fn range(&mut self) -> Option<Interval> {
        for (i, Side { ends, run }) in self.sides.iter().enumerate().rev() {
            for (values, ends) in self.values.chunks_exact_mut(*run).zip(ends.iter().cycle()) {
                values.chunks_exact_mut(2 << i).for_each(|pair| turn(pair, *ends));
            }
        }
        let larger = |[lo, hi]: [f64; 2], [middle, radius]: &[f64; 2]| {
            [lo.min(middle - radius), hi.max(middle + radius)]
        };
        let [lo, hi] = self.values.iter().fold([f64::INFINITY, f64::NEG_INFINITY], larger);
        Interval::new(lo, hi)
    }

    /// Adds to the weights of the factors that a power has: `place` is that of the variable itself.
    pub fn weigh(&mut self, place: usize, exponent: u32, weight: f64) {
        if exponent % 2 == 1 {
            self.weights[place] += weight;
        }
        if exponent / 2 == 1 {
            self.weights[place + 1] += weight;
        }
    }

    /// The factors of most weight, in place of `chosen`, squares last; the weights are zero again.
    pub fn choose(&mut self, powers: &PowerTable, chosen: &mut Vec<usize>) {
        chosen.clear();
        for _ in 0..self.most {
            let weights = self.weights.iter().enumerate().filter(|(_, weight)| **weight > 0.0);
            let Some((place, _)) = weights.max_by(|x, y| x.1.total_cmp(y.1)) else { break };
            self.weights[place] = 0.0;
            chosen.push(place);
        }
        self.weights.fill(0.0);
        chosen.sort_unstable_by_key(|place| !powers.is_first(*place));
    }
}

/// From coefficients without and with a factor, a half each, to values at its ends.
fn turn(pair: &mut [[f64; 2]], [lo, hi]: [f64; 2]) {
    let (without, with) = pair.split_at_mut(pair.len() / 2);
    for (x, y) in without.iter_mut().zip(with) {
        let ([a, b], [c, d]) = (*x, *y);
        *x = [a + c * lo, b + d * lo.abs()];
        *y = [a + c * hi, b + d * hi.abs()];
    }
}

/// The power to an exponent >= 1, with the bits of the first and the second where they are chosen.
fn divided(powers: &[Interval], exponent: usize, odd: Option<u32>, even: Option<u32>) -> Monomial {
    let of = |power: Interval| Monomial { chosen: 0, rest: [power.lo(), power.hi()] };
    let (odd, even) = (odd.filter(|_| exponent % 2 == 1), even.filter(|_| exponent / 2 == 1));
    let even = even.filter(|_| odd.is_none());
    if odd.or(even).is_none() {
        return of(powers[exponent - 1]);
    }
    let own = |bit: Option<u32>, power: Interval| match bit {
        Some(chosen) => Monomial { chosen, rest: [power.mag().max(f64::MIN_POSITIVE); 2] },
        None => of(power),
    };
    let first = if exponent % 2 == 1 { own(odd, powers[0]) } else { Monomial::ONE };
    let second =
        if exponent >= 2 { own(even, powers[exponent / 2 * 2 - 1]) } else { Monomial::ONE };
    first.times(second)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;
    use reachtube_scalar::TaylorTerm;

    use super::super::angles::Angles;
    use super::super::shift::{Shift, ShiftedPolynomial};
    use super::*;

    /// In x, an angle, and y, and the sine and cosine of x.
    fn terms() -> impl Strategy<Value = Vec<TaylorTerm<Interval>>> {
        let term = (prop::collection::vec(0..4_u8, 4), -2.0..2.0_f64)
            .prop_map(|(exponents, c)| TaylorTerm { exponents, coefficient: Interval::point(c) });
        prop::collection::vec(term, 1..8)
    }

    fn powers(polynomial: &ShiftedPolynomial, sides: [Interval; 2]) -> PowerTable {
        let mut highest = [0; 3];
        polynomial.raise_exponents(&mut highest);
        let mut powers = PowerTable::new(&highest);
        sides.iter().enumerate().for_each(|(i, side)| powers.set(i, *side));
        powers.set_angle(2, sides[0], [0.9, 0.1]);
        powers
    }

    /// The range over a box, with and without corners.
    fn ranges(
        polynomial: &ShiftedPolynomial,
        powers: &PowerTable,
        most: usize,
        work: &mut Shift,
    ) -> [Interval; 2] {
        let mut corners = Corners::new(most, powers);
        let whole = polynomial.remainder(powers, &mut corners, work);
        polynomial.choose(powers, &mut corners, work);
        let divided = polynomial.remainder(powers, &mut corners, work);
        work.chosen.clear();
        [whole, divided]
    }

    proptest! {
        #[test]
        fn corners_enclose_every_value_and_only_tighten_about_the_middle(
            terms in terms(), z in [-1.0..1.0_f64, -1.0..1.0], lo in [-1.0..0.5_f64, -1.0..0.5],
            width in [0.0..1.0_f64, 0.0..1.0], at in prop::collection::vec([0.0..=1.0_f64, 0.0..=1.0], 20), most in 0..7_usize, is_centered: bool,
        ) {
            let angles = Angles::new(2, &[0], terms.iter());
            let (mut turns, mut bounds) = (angles.factors(), angles.magnitudes());
            angles.turn(0, z[0], 0.1, &mut turns);
            let mut factors: Vec<f64> = turns.iter().map(|x| x.mid()).collect();
            factors[..2].copy_from_slice(&z);
            bounds[..2].fill(1.0);
            let polynomial = ShiftedPolynomial::new(&angles, &terms);
            let mut work = polynomial.workspace();
            polynomial.shift(&factors, &[0.5; 2], &mut work);
            polynomial.bound_errors(&bounds, &mut work);
            let lo = if is_centered { width.map(|width| -0.5 * width) } else { lo };
            let sides = [0, 1].map(|i| Interval::new(lo[i], lo[i] + width[i]).unwrap());
            let [whole, divided] = ranges(&polynomial, &powers(&polynomial, sides), most, &mut work);
            prop_assert!(!is_centered || (whole + Interval::centered(0.0, 1e-9)).encloses(&divided), "{whole:?} {divided:?}");
            for at in at {
                let d = [0, 1].map(|i| Interval::point((lo[i] + at[i] * width[i]).clamp(sides[i].lo(), sides[i].hi())));
                let [value, _] = ranges(&polynomial, &powers(&polynomial, d), 0, &mut work);
                prop_assert!(value.intersection(divided).is_some() && value.width() < 1e-9, "{value:?} {divided:?}");
            }
        }
    }

    /// xy - yz + zx over [-1, 1]³ is at most 1: its terms are not all large together.
    #[test]
    fn what_is_affine_in_each_variable_is_bounded_exactly() {
        let term = |exponents: [u8; 3], c: f64| TaylorTerm {
            exponents: exponents.to_vec(),
            coefficient: Interval::point(c),
        };
        let terms = [term([1, 1, 0], 1.0), term([0, 1, 1], -1.0), term([1, 0, 1], 1.0)];
        let polynomial = ShiftedPolynomial::new(&Angles::new(3, &[], terms.iter()), &terms);
        let mut work = polynomial.workspace();
        polynomial.shift(&[0.0; 3], &[1.0; 3], &mut work);
        polynomial.bound_errors(&[1.0; 3], &mut work);
        let mut powers = PowerTable::new(&[1; 3]);
        (0..3).for_each(|i| powers.set(i, Interval::new(-1.0, 1.0).unwrap()));
        let [whole, divided] = ranges(&polynomial, &powers, 3, &mut work);
        let is_near = |x: Interval, lo: f64| x.lo() <= lo && x.lo() > lo - 1e-12;
        assert!(is_near(whole, -3.0) && is_near(-whole, -3.0));
        assert!(is_near(divided, -3.0) && is_near(-divided, -1.0), "{divided:?}");
    }
}
