//! A polynomial about a point that changes from step to step: p(z + d) = Σ c_α dᵅ, exact and
//! finite. An angle has its φ_l (see [`angles`](super::angles)) in place of the powers of d.

use std::collections::{BTreeMap, BTreeSet};

use reachtube_scalar::{Interval, TaylorTerm};

use super::angles::{Angles, TURN_ROUNDINGS};
use super::corners::{Corners, Monomial, ROUNDINGS};
use super::powers::PowerTable;
use super::rounded::raised;
use super::univariate::Univariate;

/// Added to the magnitude of each monomial, so that products that underflow are within its
/// rounding.
const SMALLEST: f64 = 1e-290;

/// A polynomial prepared for being shifted and bounded again and again without allocation.
#[derive(Debug, Clone)]
pub(super) struct ShiftedPolynomial {
    /// Coefficients: first those about the point, still zero, of a set of monomials that holds
    /// every divisor of a member, by degree, the constant first; then those of the terms with sines
    /// and cosines, which become the former angle after angle.
    start: Vec<f64>,
    /// What those may be off by.
    start_error: Vec<f64>,
    operations: Vec<Operation>,
    /// How often each term of a coefficient about the point is rounded at most, factors included.
    roundings: Vec<f64>,
    /// Monomials of degree 1: the variable and the place.
    linear: Vec<(usize, usize)>,
    /// Monomials of degree 2 and above, in the order of their places.
    nodes: Vec<Node>,
    /// Place of the first monomial of degree 2.
    first_node: usize,
    /// Variables that are no angles.
    plain: usize,
    univariate: Vec<Univariate>,
}

/// c\[to\] += factors\[factor\] c\[from\]: one step of Horner's shift, or of the turn of an angle.
#[derive(Debug, Clone, Copy)]
struct Operation {
    to: u32,
    from: u32,
    factor: u32,
}

/// A monomial: the one at `parent` times a power of a variable.
#[derive(Debug, Clone, Copy)]
struct Node {
    parent: u32,
    variable: u32,
    exponent: u32,
    /// Whether it is one of those bounded together as [`Univariate`].
    is_power: bool,
}

/// The coefficients about the present point in floating point, and scratch memory.
#[derive(Debug, Clone)]
pub(super) struct Shift {
    coefficients: Vec<f64>,
    /// What those about the point may be off by.
    errors: Vec<f64>,
    /// The monomials over the box, up to rounding.
    monomials: Vec<Monomial>,
    /// Sums over all monomials that one is a part of.
    sums: Vec<f64>,
    /// The factors whose corners are taken, places among the powers.
    pub chosen: Vec<usize>,
    /// What is added to the derivative and taken from the remainder, one a list of powers.
    slopes: Vec<f64>,
}

impl Shift {
    fn coefficient(&self, at: usize) -> Interval {
        Interval::centered(self.coefficients[at], self.errors[at])
    }
}

impl ShiftedPolynomial {
    pub fn new(angles: &Angles, terms: &[TaylorTerm<Interval>]) -> Self {
        let (plain, variables) = (angles.plain, angles.plain + angles.states.len());
        let stages = stages(angles, terms);
        let mut monomials: BTreeSet<(u32, Vec<u8>)> = BTreeSet::from([(0, vec![0; variables])]);
        for monomial in &stages[stages.len() - 1].monomials {
            insert_divisors(&mut monomials, &monomial[..variables]);
        }
        let place: BTreeMap<&[u8], usize> =
            monomials.iter().enumerate().map(|(at, (_, m))| (m.as_slice(), at)).collect();
        let (start, mut operations) = turns(angles, &stages, &place, terms);
        operations.extend(shifts(plain, &monomials, &place));
        let linear = monomials.iter().enumerate().filter(|(_, (degree, _))| *degree == 1);
        let linear: Vec<_> = linear.map(|(at, (_, m))| (first_variable(m), at)).collect();
        let node = |m: &Vec<u8>| {
            let variable = first_variable(m);
            let parent = place[with(m, variable, 0).as_slice()] as u32;
            let exponent = u32::from(m[variable]);
            Node {
                parent,
                variable: variable as u32,
                exponent,
                is_power: parent == 0 && variable < plain,
            }
        };
        let univariate =
            (0..plain).filter_map(|variable| Univariate::of(variable, &place)).collect();
        let nodes =
            monomials.iter().filter(|(degree, _)| *degree >= 2).map(|(_, m)| node(m)).collect();
        let roundings = roundings(plain, &start, &operations, monomials.len());
        let start_error = start.iter().map(|x| x.rad()).collect();
        let start = start.iter().map(|x| x.mid()).collect();
        let first_node = 1 + linear.len();
        Self {
            start,
            start_error,
            operations,
            roundings,
            linear,
            nodes,
            first_node,
            plain,
            univariate,
        }
    }

    /// Scratch memory for this polynomial.
    pub fn workspace(&self) -> Shift {
        let own = self.roundings.len();
        Shift {
            coefficients: self.start.clone(),
            errors: vec![0.0; own],
            monomials: vec![Monomial::ONE; own],
            sums: vec![0.0; own],
            chosen: Vec::new(),
            slopes: vec![0.0; self.univariate.len()],
        }
    }

    /// The highest exponent of each variable, where it is above that in `highest`.
    pub fn raise_exponents(&self, highest: &mut [u32]) {
        for node in &self.nodes {
            let highest = &mut highest[node.variable as usize];
            *highest = (*highest).max(node.exponent);
        }
    }

    /// About the point that the factors are of: its plain variables, and what its angles turn by;
    /// with slopes for offsets of about `radius`.
    ///
    /// # Guarantee
    ///
    /// None for itself: each coefficient is off by [`bound_errors`](Self::bound_errors) at most.
    pub fn shift(&self, factors: &[f64], radius: &[f64], work: &mut Shift) {
        work.coefficients.copy_from_slice(&self.start);
        let c = &mut work.coefficients;
        self.operate(factors, c);
        for (slope, powers) in work.slopes.iter_mut().zip(&self.univariate) {
            *slope = powers.slope(c, radius[powers.variable]);
        }
    }

    fn operate(&self, factors: &[f64], coefficients: &mut [f64]) {
        for op in &self.operations {
            coefficients[op.to as usize] +=
                coefficients[op.from as usize] * factors[op.factor as usize];
        }
    }

    /// Bounds the errors of all shifts whose factors are within `bounds`, those of angles known to
    /// [`TURN_ROUNDINGS`] of them.
    ///
    /// # Guarantee
    ///
    /// Each coefficient is a sum of products of factors and a coefficient to begin with. Each of
    /// these is rounded at most so many times, so that the sum is off by at most γ of that number
    /// times the same sum of magnitudes (Higham, section 3.1); what the first coefficients are off
    /// by is carried through.
    pub fn bound_errors(&self, bounds: &[f64], work: &mut Shift) {
        let mut magnitudes: Vec<f64> = self.start.iter().map(|x| x.abs()).collect();
        let mut carried = self.start_error.clone();
        self.operate(bounds, &mut magnitudes);
        self.operate(bounds, &mut carried);
        for (at, (error, roundings)) in work.errors.iter_mut().zip(&self.roundings).enumerate() {
            let own = roundings * f64::EPSILON * (magnitudes[at] + carried[at]);
            *error = if own + carried[at] == 0.0 {
                0.0
            } else {
                raised(carried[at] + own, 2 * *roundings as usize)
            };
        }
    }

    /// The value at the present point.
    pub fn constant(&self, work: &Shift) -> Interval {
        work.coefficient(0)
    }

    /// The derivatives at the present point and the slopes: variables, φ₁ that of an angle, and
    /// what is to be added up for each.
    pub fn gradient<'a>(&'a self, work: &'a Shift) -> impl Iterator<Item = (usize, Interval)> + 'a {
        let derivatives =
            self.linear.iter().map(|&(variable, at)| (variable, work.coefficient(at)));
        let slopes = self.univariate.iter().zip(&work.slopes);
        derivatives.chain(slopes.map(|(powers, slope)| (powers.variable, Interval::point(*slope))))
    }

    /// The sum of all terms of degree 2 and above, less the slopes, over a box, given by the powers
    /// of its sides; with what sines differ from their lines.
    ///
    /// # Guarantee
    ///
    /// Outer, directed rounding.
    pub fn remainder(
        &self,
        powers: &PowerTable,
        corners: &mut Corners,
        work: &mut Shift,
    ) -> Interval {
        let mut sum = self.mixed(powers, corners, work);
        for &(variable, at) in self.linear.iter().filter(|(variable, _)| *variable >= self.plain) {
            sum += work.coefficient(at) * powers.defect(variable);
        }
        for (univariate, slope) in self.univariate.iter().zip(&work.slopes) {
            let coefficient = |at: usize| work.coefficient(at);
            sum += univariate.range(&coefficient, *slope, powers.get(univariate.variable, 1));
        }
        sum
    }

    /// The sum of all terms but those of one variable that is no angle, in floating point; its
    /// rounding is bounded in the end. A product of intervals is off by one rounding a factor
    /// relative to its magnitude, the sum by one a term, and the corners by [`ROUNDINGS`] a factor.
    fn mixed(&self, powers: &PowerTable, corners: &mut Corners, work: &mut Shift) -> Interval {
        corners.divide(powers, &work.chosen);
        for &(variable, at) in &self.linear {
            work.monomials[at] = corners.part(powers.place(variable, 1));
        }
        let ([mut magnitudes, mut errors], mut terms) = ([0.0; 2], 0);
        for (at, node) in (self.first_node..).zip(&self.nodes) {
            let part = corners.part(powers.place(node.variable as usize, node.exponent));
            let monomial = work.monomials[node.parent as usize].times(part);
            work.monomials[at] = monomial;
            if !node.is_power {
                let (c, magnitude) = (work.coefficients[at], monomial.magnitude() + SMALLEST);
                corners.add(c, monomial);
                magnitudes += c.abs() * magnitude;
                errors += work.errors[at] * magnitude;
                terms += 1;
            }
        }
        if terms == 0 {
            return Interval::ZERO;
        }
        let roundings = (terms + 4 * usize::from(u8::MAX) + ROUNDINGS * work.chosen.len()) as f64;
        let error = raised(errors + magnitudes * (roundings * f64::EPSILON), 2 * terms);
        let range = corners.range().filter(|_| (magnitudes + errors).is_finite());
        range.map_or(Interval::ENTIRE, |range| range + Interval::centered(0.0, error))
    }

    /// Chooses the factors whose corners are taken from now on: those that most of the sum has,
    /// over the box bounded last.
    pub fn choose(&self, powers: &PowerTable, corners: &mut Corners, work: &mut Shift) {
        work.sums.fill(0.0);
        for (i, node) in self.nodes.iter().enumerate().rev() {
            let at = self.first_node + i;
            if !node.is_power {
                work.sums[at] += work.coefficients[at].abs() * work.monomials[at].magnitude();
            }
            let sum = work.sums[at];
            work.sums[node.parent as usize] += sum;
            corners.weigh(powers.place(node.variable as usize, 1), node.exponent, sum);
        }
        for &(variable, at) in &self.linear {
            corners.weigh(powers.place(variable, 1), 1, work.sums[at]);
        }
        corners.choose(powers, &mut work.chosen);
    }
}

/// The largest number of roundings of a term of each of the first coefficients: two an operation,
/// those of its factor, and one of a sum for each that follows.
fn roundings(plain: usize, start: &[Interval], operations: &[Operation], own: usize) -> Vec<f64> {
    let mut counts = vec![0.0_f64; start.len()];
    for op in operations {
        let factor = if op.factor as usize >= plain { TURN_ROUNDINGS } else { 0.0 };
        let added = counts[op.from as usize] + factor + 2.0;
        let to = &mut counts[op.to as usize];
        *to = added.max(*to + 1.0);
    }
    counts.truncate(own);
    counts
}

fn insert_divisors(monomials: &mut BTreeSet<(u32, Vec<u8>)>, monomial: &[u8]) {
    let degree = monomial.iter().map(|e| u32::from(*e)).sum();
    if monomials.insert((degree, monomial.to_vec())) {
        for i in (0..monomial.len()).filter(|i| monomial[*i] > 0) {
            insert_divisors(monomials, &with(monomial, i, monomial[i] - 1));
        }
    }
}

fn with(monomial: &[u8], variable: usize, exponent: u8) -> Vec<u8> {
    let mut other = monomial.to_vec();
    other[variable] = exponent;
    other
}

fn first_variable(monomial: &[u8]) -> usize {
    monomial.iter().position(|e| *e > 0).expect("not a constant")
}

/// The monomials before an angle is turned, each with its place among all coefficients; none is
/// turned after the last.
struct Stage {
    monomials: BTreeSet<Vec<u8>>,
    angle: Option<usize>,
}

/// The monomials of the terms, and what they become as angle after angle is turned: the place of
/// its sine then has the l of φ_l.
fn stages(angles: &Angles, terms: &[TaylorTerm<Interval>]) -> Vec<Stage> {
    let mut stages = Vec::new();
    let mut monomials: BTreeSet<Vec<u8>> =
        terms.iter().map(|term| term.exponents.clone()).collect();
    for i in 0..angles.states.len() {
        if monomials.iter().any(|m| angles.exponents(m, i) != [0; 2]) {
            let turned = monomials.iter().flat_map(|m| turned(angles, i, m)).collect();
            stages.push(Stage { monomials, angle: Some(i) });
            monomials = turned;
        }
    }
    stages.push(Stage { monomials, angle: None });
    stages
}

/// What a monomial becomes when angle i is turned: its terms in φ₀, φ₁, ...
fn turned(angles: &Angles, i: usize, monomial: &[u8]) -> impl Iterator<Item = Vec<u8>> {
    let ([sine, cosine], [a, b]) = (angles.places(i), angles.exponents(monomial, i));
    let monomial = with(monomial, cosine, 0);
    (0..=2 * (a + b)).map(move |l| with(&monomial, sine, l))
}

/// The coefficients to begin with, and the operations that turn one angle after the other, ending
/// at `place`.
fn turns(
    angles: &Angles,
    stages: &[Stage],
    place: &BTreeMap<&[u8], usize>,
    terms: &[TaylorTerm<Interval>],
) -> (Vec<Interval>, Vec<Operation>) {
    let variables = angles.plain + angles.states.len();
    let (mut count, mut operations) = (place.len(), Vec::new());
    let mut places: Vec<BTreeMap<&[u8], usize>> = Vec::new();
    for stage in &stages[..stages.len() - 1] {
        places
            .push(stage.monomials.iter().zip(count..).map(|(m, at)| (m.as_slice(), at)).collect());
        count += stage.monomials.len();
    }
    let at = |stage: usize, m: &[u8]| {
        places.get(stage).map_or_else(|| place[&m[..variables]], |own| own[m])
    };
    for (number, stage) in stages.iter().enumerate() {
        let Some(i) = stage.angle else { break };
        for monomial in &stage.monomials {
            let exponents = angles.exponents(monomial, i);
            for (l, next) in turned(angles, i, monomial).enumerate() {
                let (to, from) = (at(number + 1, &next) as u32, at(number, monomial) as u32);
                operations.push(Operation {
                    to,
                    from,
                    factor: angles.factor(i, exponents, l) as u32,
                });
            }
        }
    }
    let mut start = vec![Interval::ZERO; count];
    for term in terms {
        start[at(0, &term.exponents)] += term.coefficient;
    }
    (start, operations)
}

/// Horner's shift, variable after variable, chain after chain of monomials that differ in that
/// variable alone.
fn shifts(
    plain: usize,
    monomials: &BTreeSet<(u32, Vec<u8>)>,
    place: &BTreeMap<&[u8], usize>,
) -> Vec<Operation> {
    let mut operations = Vec::new();
    for variable in 0..plain {
        let ends = |m: &Vec<u8>| !place.contains_key(with(m, variable, m[variable] + 1).as_slice());
        for (_, m) in monomials.iter().filter(|(_, m)| m[variable] > 0 && ends(m)) {
            let at = |exponent: u8| place[with(m, variable, exponent).as_slice()] as u32;
            for lowest in 0..m[variable] {
                for exponent in (lowest..m[variable]).rev() {
                    let (to, from) = (at(exponent), at(exponent + 1));
                    operations.push(Operation { to, from, factor: variable as u32 });
                }
            }
        }
    }
    operations
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;
    use reachtube_scalar::{TaylorPolynomial, TaylorSpace};

    use super::*;

    fn terms() -> impl Strategy<Value = Vec<TaylorTerm<Interval>>> {
        let term = (prop::collection::vec(0..4_u8, 3), -2.0..2.0_f64)
            .prop_map(|(exponents, c)| TaylorTerm { exponents, coefficient: Interval::point(c) });
        prop::collection::vec(term, 1..8)
    }

    proptest! {
        #[test]
        fn a_shift_is_the_polynomial_about_another_point(
            terms in terms(), z in [-2.0..2.0_f64, -2.0..2.0, -2.0..2.0], d in [-1.0..1.0_f64, -1.0..1.0, -1.0..1.0],
        ) {
            let space = TaylorSpace::new(3, 12).unwrap();
            let shifted = ShiftedPolynomial::new(&Angles::new(3, &[], terms.iter()), &terms);
            let mut work = shifted.workspace();
            shifted.shift(&z, &[0.5; 3], &mut work);
            shifted.bound_errors(&[2.0; 3], &mut work);
            let exact = TaylorPolynomial::from_terms(&space, terms).shifted(&z.map(Interval::point));
            prop_assert!(exact.constant_term().intersection(shifted.constant(&work)).is_some());
            let mut highest = [0; 3];
            shifted.raise_exponents(&mut highest);
            let mut powers = PowerTable::new(&highest);
            d.iter().enumerate().for_each(|(i, d)| powers.set(i, Interval::point(*d)));
            let linear = shifted.gradient(&work).fold(shifted.constant(&work), |sum, (i, slope)| sum + slope * d[i]);
            let sum = linear + shifted.remainder(&powers, &mut Corners::new(0, &powers), &mut work);
            prop_assert!(exact.evaluate(&d.map(Interval::point)).intersection(sum).is_some());
            prop_assert!(sum.width() < 1e-9);
        }

        /// In an angle x, its sine and its cosine.
        #[test]
        fn so_is_one_with_sine_and_cosine(
            terms in terms(), z in -2.0..2.0_f64, d in -1.0..1.0_f64, line in 0.0..=1.0_f64, middle in 0.0..=1.0_f64,
        ) {
            let angles = Angles::new(1, &[0], terms.iter());
            let (mut turns, mut bounds) = (angles.factors(), angles.magnitudes());
            angles.turn(0, z, middle, &mut turns);
            let mut factors: Vec<f64> = turns.iter().map(|x| x.mid()).collect();
            (factors[0], bounds[0]) = (z, 2.0);
            let shifted = ShiftedPolynomial::new(&angles, &terms);
            let mut work = shifted.workspace();
            shifted.shift(&factors, &[0.5], &mut work);
            shifted.bound_errors(&bounds, &mut work);
            let mut highest = [0; 2];
            shifted.raise_exponents(&mut highest);
            let (mut powers, offset) = (PowerTable::new(&highest), Interval::point(d));
            powers.set(0, offset);
            powers.set_angle(1, offset, [line, middle]);
            let linear = shifted.gradient(&work).fold(shifted.constant(&work), |sum, (i, slope)| {
                sum + angles.along_line(i, slope, &[line]).1 * d
            });
            let sum = linear + shifted.remainder(&powers, &mut Corners::new(0, &powers), &mut work);
            let (x, (sine, cosine)) = (offset + z, (offset + z).sin_cos());
            let power = |t: &TaylorTerm<Interval>| {
                let [a, b, c] = [0, 1, 2].map(|i| i32::from(t.exponents[i]));
                t.coefficient * x.powi(a) * sine.powi(b) * cosine.powi(c)
            };
            let exact: Interval = terms.iter().map(power).sum();
            prop_assert!(exact.intersection(sum).is_some() && sum.width() < 1e-9, "{exact:?} {sum:?}");
        }
    }

    #[test]
    fn a_square_is_not_negative() {
        let square = TaylorTerm { exponents: vec![2], coefficient: Interval::ONE };
        let shifted = ShiftedPolynomial::new(&Angles::new(1, &[], [].iter()), &[square]);
        let mut powers = PowerTable::new(&[2]);
        powers.set(0, Interval::new(-1.0, 1.0).unwrap());
        let mut work = shifted.workspace();
        shifted.shift(&[3.0], &[1.0], &mut work);
        shifted.bound_errors(&[3.0], &mut work);
        let range = shifted.remainder(&powers, &mut Corners::new(0, &powers), &mut work);
        assert!(range.lo() == 0.0 && (1.0..1.0 + 1e-12).contains(&range.hi()));
    }
}
