//! The range of a polynomial over a box, from its values at the vertices of some of the sides.
//!
//! An odd power is x times an even one, and φ₂ₖ₊₁ = σ (κ - m)ᵏ. So x, x², σ and κ - m occur at most
//! once in a monomial whose higher powers are bounded separately: the polynomial is affine in each.
//! Whatever the other factors are, its extrema over the chosen factors are therefore at vertices of
//! their box. At one vertex the terms of Σ_S a_S Π_{i ∈ S} x_i cancel, which a sum of ranges does
//! not show. All 2ⁿ vertices take n 2ⁿ products together. The vertices of the last two factors are
//! the lanes of a vector, over which each term is spread when it is added.
//!
//! Where both x and x² are chosen, x³ is x times a range, so that the polynomial is affine in the
//! pair. The vertices then belong to a trapezoid around the parabola: (±r, r²) and, on the tangents
//! there, (±r/2, 0). For an angle they are (±sin r, 1 - cos r) and (±tan(r/2), 0).

use reachtube_scalar::{Dispatch, Interval, Kernel, Lanes, Lanewise};

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

/// Largest number of factors whose vertices are the lanes of a vector.
const LANE_FACTORS: usize = 2;

/// Number of factors whose values at all vertices stay in the nearest cache.
const BLOCK: usize = 8;

/// Number of vertices of the last factors.
const LANES: usize = 1 << LANE_FACTORS;

/// One number for each vertex of the last factors.
type Vector = Lanes<LANES>;

/// The ends of a chosen factor, divided by its largest magnitude.
#[derive(Debug)]
struct FactorEnds {
    /// Ends where the square of the factor is smallest, and ends where it is largest.
    ends: [[f64; 2]; 2],
    /// The factor that is the square of this one, if it is chosen; it comes later.
    square: Option<usize>,
}

impl FactorEnds {
    /// Returns both ends at a vertex, which has one bit per factor.
    #[inline(always)]
    fn at(&self, vertex: usize) -> [f64; 2] {
        self.ends[self.square.map_or(0, |square| vertex >> square & 1)]
    }
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
    /// Number of factors whose vertices are not lanes: the first ones.
    outer: usize,
    /// Products of the ends of the last factors, and of their magnitudes, for each set of these.
    spread: [[Vector; 2]; LANES],
    /// Middle and radius of each coefficient a_S, later of the value at each vertex, where S has
    /// the first factors.
    values: Vec<[Vector; 2]>,
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
            outer: 0,
            spread: [[Vector::from(1.0); 2]; LANES],
            values: Vec::with_capacity(1 << most.saturating_sub(LANE_FACTORS)),
        }
    }

    /// Starts a new sum and divides the powers into chosen factors and all others.
    pub(crate) fn divide(&mut self, powers: &PowerTable, chosen: &[usize]) {
        self.factors.clear();
        self.outer = chosen.len().saturating_sub(LANE_FACTORS);
        self.values.clear();
        self.values.resize(1 << self.outer, [Vector::from(0.0); 2]);
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
            self.factors.push(FactorEnds { ends, square: square.filter(|_| waist.is_some()) });
        }
        for (set, spread) in self.spread.iter_mut().enumerate() {
            let lanes = self.factors[self.outer..].iter().enumerate();
            let lanes = lanes.filter(|(i, _)| set >> i & 1 == 1);
            *spread = lanes.fold([Vector::from(1.0); 2], |[product, magnitude], (i, factor)| {
                let end = |lane: usize| factor.at(lane << self.outer)[lane >> i & 1];
                let ends = Vector::from_lanes(end);
                [product * ends, magnitude * ends.map(f64::abs)]
            });
        }
    }

    #[inline]
    pub(crate) fn part(&self, index: usize) -> Monomial {
        self.parts[index]
    }

    /// Adds c times a monomial to the sum.
    #[inline]
    pub(crate) fn add(&mut self, c: f64, monomial: Monomial) {
        let [lo, hi] = monomial.range;
        let set = monomial.chosen as usize;
        let [product, magnitude] = self.spread[set >> self.outer];
        let [middle, radius] = &mut self.values[set & ((1 << self.outer) - 1)];
        *middle += product * Vector::from(c * (0.5 * (lo + hi)));
        *radius += magnitude * Vector::from(c.abs() * (0.5 * (hi - lo)));
    }

    /// Returns the range of the sum, up to [`VERTEX_ROUNDINGS`] per factor of each term; `None` if
    /// it is not a number.
    pub(crate) fn range(&mut self) -> Option<Interval> {
        let factors = &self.factors[..self.outer];
        let [lo, hi] = Vector::dispatch(Extrema { factors, values: &mut self.values });
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

/// Evaluates the sum at all vertices, and finds the least and the largest value.
struct Extrema<'a> {
    /// The factors whose vertices are not lanes.
    factors: &'a [FactorEnds],
    /// Middle and radius of the coefficients, one pair for each set of factors.
    values: &'a mut [[Vector; 2]],
}

impl Kernel for Extrema<'_> {
    type Output = [f64; 2];

    #[inline(always)]
    fn run(self) -> [f64; 2] {
        let Self { factors, values } = self;
        let block = factors.len().min(BLOCK);
        for i in (block..factors.len()).rev() {
            evaluate(values, factors, i, 0);
        }
        let (mut least, mut largest) = ([f64::INFINITY; LANES], [f64::NEG_INFINITY; LANES]);
        for (b, values) in values.chunks_exact_mut(1 << block).enumerate() {
            for i in (0..block).rev() {
                evaluate(values, factors, i, b << block);
            }
            for [middle, radius] in values.iter() {
                let (lo, hi) = ((*middle - *radius).to_array(), (*middle + *radius).to_array());
                for lane in 0..LANES {
                    least[lane] = if lo[lane] < least[lane] { lo[lane] } else { least[lane] };
                    largest[lane] = if hi[lane] > largest[lane] { hi[lane] } else { largest[lane] };
                }
            }
        }
        [least.into_iter().fold(least[0], f64::min), largest.into_iter().fold(largest[0], f64::max)]
    }
}

/// Evaluates the values from vertex `first` on at the ends of factor `i`.
#[inline(always)]
fn evaluate(values: &mut [[Vector; 2]], factors: &[FactorEnds], i: usize, first: usize) {
    let square = factors[i].square.filter(|square| *square < factors.len());
    let ends = [0, square.map_or(0, |square| 1 << square)].map(|vertex| {
        let of = |end| move |lane: usize| factors[i].at(vertex | lane << factors.len())[end];
        [Vector::from_lanes(of(0)), Vector::from_lanes(of(1))]
    });
    for (p, pair) in values.chunks_exact_mut(2 << i).enumerate() {
        let side = square.map_or(0, |square| (first + (p << (i + 1))) >> square & 1);
        evaluate_at_ends(pair, ends[side]);
    }
}

/// Replaces coefficients without a factor (first half) and with it (second half) by values at the
/// two ends of the factor.
#[inline(always)]
fn evaluate_at_ends(pair: &mut [[Vector; 2]], [lo, hi]: [Vector; 2]) {
    let magnitudes = [lo, hi].map(|end| end.map(f64::abs));
    let (without, with) = pair.split_at_mut(pair.len() / 2);
    for (x, y) in without.iter_mut().zip(with) {
        let ([a, b], [c, d]) = (*x, *y);
        *x = [a + c * lo, b + d * magnitudes[0]];
        *y = [a + c * hi, b + d * magnitudes[1]];
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
