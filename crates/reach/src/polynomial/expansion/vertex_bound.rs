//! The range of a polynomial over a box, from its values at the vertices of some of the sides.
//!
//! An odd power is x times an even one, and φ₂ₖ₊₁ = σ (κ - m)ᵏ. So x, x², σ and κ - m occur at most
//! once in a monomial whose higher powers are bounded separately: the polynomial is affine in each.
//! Whatever the other factors are, its extrema over the chosen factors are therefore at vertices of
//! their box. At one vertex the terms of Σ_S a_S Π_{i ∈ S} x_i cancel, which a sum of ranges does
//! not show. All 2ⁿ vertices take n 2ⁿ products together.
//!
//! Where both x and x² are chosen, x³ is x times a range, so that the polynomial is affine in the
//! pair. The vertices then belong to a trapezoid around the parabola: (±r, r²) and, on the tangents
//! there, (±r/2, 0). For an angle they are (±sin r, 1 - cos r) and (±tan(r/2), 0).

use reachtube_scalar::Interval;

use crate::polynomial::expansion::power_table::PowerTable;

/// Largest number of chosen factors, since the values at all vertices are stored.
const MOST_FACTORS: usize = 20;

/// Number of roundings of a term per chosen factor in it, roundings of the ends of the factor
/// included.
pub(crate) const VERTEX_ROUNDINGS: usize = 8;

/// A monomial or a part of one over a box: a product of chosen factors, each divided by its largest
/// magnitude, times the range of all other factors.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Monomial {
    /// One bit per chosen factor.
    chosen: u32,
    /// Range of the product of all other factors, up to rounding.
    range: [f64; 2],
}

impl Monomial {
    pub(crate) const ONE: Self = Self { chosen: 0, range: [1.0; 2] };

    #[inline]
    pub(crate) fn times(self, other: Self) -> Self {
        let ([a, b], [c, d]) = (self.range, other.range);
        let products = [a * c, a * d, b * c, b * d];
        let smaller = |x: f64, y: f64| if x < y { x } else { y };
        let larger = |x: f64, y: f64| if x > y { x } else { y };
        let lo = smaller(smaller(products[0], products[1]), smaller(products[2], products[3]));
        let hi = larger(larger(products[0], products[1]), larger(products[2], products[3]));
        Self { chosen: self.chosen | other.chosen, range: [lo, hi] }
    }

    #[inline]
    pub(crate) fn magnitude(self) -> f64 {
        self.range[0].abs().max(self.range[1].abs())
    }
}

/// The ends of a chosen factor, divided by its largest magnitude.
#[derive(Debug)]
struct FactorEnds {
    /// Ends where the square of the factor is smallest, and ends where it is largest.
    ends: [[f64; 2]; 2],
    /// Number of consecutive vertices with the same ends.
    run: usize,
}

/// Bounds of polynomials over the vertices of chosen factors; scratch memory for one polynomial
/// after the other.
#[derive(Debug)]
pub(crate) struct VertexBound {
    /// Largest number of chosen factors.
    most: usize,
    /// The chosen factors, squares last.
    factors: Vec<FactorEnds>,
    /// Each power as a part of a monomial.
    parts: Vec<Monomial>,
    /// Weight of each factor: the sum of the magnitudes of the terms that contain it.
    weights: Vec<f64>,
    /// Middle and radius of each coefficient a_S, later of the value at each vertex.
    values: Vec<[f64; 2]>,
}

impl VertexBound {
    /// Allocates memory for at most `most` factors and the powers of a table like `powers`.
    pub(crate) fn new(most: usize, powers: &PowerTable) -> Self {
        let most = most.min(MOST_FACTORS);
        Self {
            most,
            factors: Vec::with_capacity(most),
            parts: vec![Monomial::ONE; powers.len()],
            weights: vec![0.0; powers.len()],
            values: Vec::with_capacity(1 << most),
        }
    }

    /// Starts a new sum and divides the powers into chosen factors and all others.
    pub(crate) fn divide(&mut self, powers: &PowerTable, chosen: &[usize]) {
        self.factors.clear();
        self.values.clear();
        self.values.resize(1 << chosen.len(), [0.0; 2]);
        for (start, powers) in powers.lists() {
            let bit = |index: usize| chosen.iter().position(|own| *own == index).map(|i| 1 << i);
            let (odd, even) = (bit(start), bit(start + 1).filter(|_| powers.len() > 1));
            for (k, part) in self.parts[start..start + powers.len()].iter_mut().enumerate() {
                *part = divided(powers, k + 1, odd, even);
            }
        }
        for &index in chosen {
            let (side, size) = (powers.at(index), powers.at(index).mag().max(f64::MIN_POSITIVE));
            let trapezoid = powers.trapezoid(index);
            let square =
                trapezoid.and_then(|(square, _)| chosen.iter().position(|own| *own == square));
            let waist = trapezoid.map(|(_, waist)| waist).filter(|_| square.is_some());
            let whole = [side.lo() / size, side.hi() / size];
            let ends = waist.map_or([whole; 2], |waist| [[-waist, waist], [-1.0, 1.0]]);
            self.factors.push(FactorEnds { ends, run: 1 << square.unwrap_or(chosen.len()) });
        }
    }

    /// Returns the power at an index as a part of a monomial.
    #[inline]
    pub(crate) fn part(&self, index: usize) -> Monomial {
        self.parts[index]
    }

    /// Adds c times a monomial to the sum.
    #[inline]
    pub(crate) fn add(&mut self, c: f64, monomial: Monomial) {
        let [lo, hi] = monomial.range;
        let [middle, radius] = &mut self.values[monomial.chosen as usize];
        *middle += c * (0.5 * (lo + hi));
        *radius += c.abs() * (0.5 * (hi - lo));
    }

    /// Returns the range of the sum, up to [`VERTEX_ROUNDINGS`] per factor of each term; `None`
    /// where it is not a number.
    pub(crate) fn range(&mut self) -> Option<Interval> {
        for (i, FactorEnds { ends, run }) in self.factors.iter().enumerate().rev() {
            for (values, ends) in self.values.chunks_exact_mut(*run).zip(ends.iter().cycle()) {
                values.chunks_exact_mut(2 << i).for_each(|pair| evaluate_at_ends(pair, *ends));
            }
        }
        let larger = |[lo, hi]: [f64; 2], [middle, radius]: &[f64; 2]| {
            [lo.min(middle - radius), hi.max(middle + radius)]
        };
        let [lo, hi] = self.values.iter().fold([f64::INFINITY, f64::NEG_INFINITY], larger);
        Interval::new(lo, hi)
    }

    /// Adds to the weights of the factors of a power; `index` belongs to the variable itself.
    pub(crate) fn add_weight(&mut self, index: usize, exponent: u32, weight: f64) {
        if exponent % 2 == 1 {
            self.weights[index] += weight;
        }
        if exponent / 2 == 1 {
            self.weights[index + 1] += weight;
        }
    }

    /// Replaces `chosen` by the factors of largest weight, squares last, and resets the weights.
    pub(crate) fn choose(&mut self, powers: &PowerTable, chosen: &mut Vec<usize>) {
        chosen.clear();
        for _ in 0..self.most {
            let weights = self.weights.iter().enumerate().filter(|(_, weight)| **weight > 0.0);
            let Some((index, _)) = weights.max_by(|x, y| x.1.total_cmp(y.1)) else { break };
            self.weights[index] = 0.0;
            chosen.push(index);
        }
        self.weights.fill(0.0);
        chosen.sort_unstable_by_key(|index| !powers.is_first(*index));
    }
}

/// Replaces coefficients without a factor (first half) and with it (second half) by values at the
/// two ends of the factor.
fn evaluate_at_ends(pair: &mut [[f64; 2]], [lo, hi]: [f64; 2]) {
    let (without, with) = pair.split_at_mut(pair.len() / 2);
    for (x, y) in without.iter_mut().zip(with) {
        let ([a, b], [c, d]) = (*x, *y);
        *x = [a + c * lo, b + d * lo.abs()];
        *y = [a + c * hi, b + d * hi.abs()];
    }
}

/// Divides the power to an exponent >= 1 into chosen factors and a range.
///
/// `odd` and `even` are the bits of the variable and of its square, where they are chosen.
fn divided(powers: &[Interval], exponent: usize, odd: Option<u32>, even: Option<u32>) -> Monomial {
    let of = |power: Interval| Monomial { chosen: 0, range: [power.lo(), power.hi()] };
    let (odd, even) = (odd.filter(|_| exponent % 2 == 1), even.filter(|_| exponent / 2 == 1));
    let even = even.filter(|_| odd.is_none());
    if odd.or(even).is_none() {
        return of(powers[exponent - 1]);
    }
    let own = |bit: Option<u32>, power: Interval| match bit {
        Some(chosen) => Monomial { chosen, range: [power.mag().max(f64::MIN_POSITIVE); 2] },
        None => of(power),
    };
    let first = if exponent % 2 == 1 { own(odd, powers[0]) } else { Monomial::ONE };
    let second =
        if exponent >= 2 { own(even, powers[exponent / 2 * 2 - 1]) } else { Monomial::ONE };
    first.times(second)
}

#[cfg(test)]
mod tests;
