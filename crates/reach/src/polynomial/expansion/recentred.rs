//! A polynomial about a centre that changes from step to step: p(z + d) = Σ c_α dᵅ, exact and
//! finite.
//!
//! An angle has its φ_l (see [`angles`](crate::polynomial::expansion::angles)) in place of the
//! powers of d.

use std::collections::{BTreeMap, BTreeSet};

use reachtube_scalar::{Interval, TaylorTerm};

use crate::polynomial::expansion::angles::Angles;
use crate::polynomial::expansion::monomials::{first_variable, insert_divisors, with_exponent};
use crate::polynomial::expansion::operations::{
    Operation, angle_operations, horner_operations, roundings, stages,
};
use crate::polynomial::expansion::power_table::PowerTable;
use crate::polynomial::expansion::univariate::Univariate;
use crate::polynomial::expansion::vertex_bound::{Monomial, VERTEX_ROUNDINGS, VertexBound};
use crate::upward::round_up_sum;

/// Added to the magnitude of each monomial, so that the rounding bound covers products that
/// underflow.
const SMALLEST: f64 = 1e-290;

/// The plan for recentring and bounding one polynomial repeatedly without allocation.
#[derive(Debug, Clone)]
pub(crate) struct Recentring {
    /// Initial coefficients.
    ///
    /// The first belong to the result: a set of monomials that contains every divisor of a member,
    /// by degree, the constant first. The others belong to the terms with sines and cosines, which
    /// the operations turn into the former angle after angle.
    start: Vec<f64>,
    /// Errors of the initial coefficients.
    start_error: Vec<f64>,
    operations: Vec<Operation>,
    /// Largest number of roundings in a term of each recentred coefficient.
    roundings: Vec<f64>,
    /// Monomials of degree 1: the variable and the index.
    linear: Vec<(usize, usize)>,
    /// Monomials of degree 2 and above, in the order of their indices.
    nodes: Vec<MonomialNode>,
    /// Index of the first monomial of degree 2.
    first_node: usize,
    /// Number of variables that are not angles.
    plain: usize,
    univariate: Vec<Univariate>,
}

/// A monomial, as the one at index `parent` times a power of a variable.
#[derive(Debug, Clone, Copy)]
struct MonomialNode {
    parent: u32,
    variable: u32,
    exponent: u32,
    /// Whether [`Univariate`] bounds this monomial together with other powers of its variable.
    is_power: bool,
}

/// The coefficients of a polynomial about the present centre, with scratch memory for its range.
#[derive(Debug, Clone)]
pub(crate) struct RecentredPolynomial {
    /// Recentred coefficients, then coefficients of intermediate terms.
    coefficients: Vec<f64>,
    /// Error bounds of the recentred coefficients.
    errors: Vec<f64>,
    /// Slope added to the derivative and subtracted from the remainder, one per list of powers.
    slopes: Vec<f64>,
    /// Indices, among the powers, of the factors whose vertices are enumerated.
    pub vertex_factors: Vec<usize>,
    /// Scratch memory: the monomials over the box, up to rounding.
    monomials: Vec<Monomial>,
    /// Scratch memory: for each monomial, the sum of the terms that it divides.
    sums: Vec<f64>,
}

impl RecentredPolynomial {
    fn coefficient(&self, index: usize) -> Interval {
        Interval::centred(self.coefficients[index], self.errors[index])
    }
}

impl Recentring {
    pub(crate) fn new(angles: &Angles, terms: &[TaylorTerm<Interval>]) -> Self {
        let (plain, variables) = (angles.plain, angles.plain + angles.states.len());
        // Monomials of the result and their indices.
        let stages = stages(angles, terms);
        let mut monomials: BTreeSet<(u32, Vec<u8>)> = BTreeSet::from([(0, vec![0; variables])]);
        for monomial in &stages[stages.len() - 1].monomials {
            insert_divisors(&mut monomials, &monomial[..variables]);
        }
        let index: BTreeMap<&[u8], usize> =
            monomials.iter().enumerate().map(|(number, (_, m))| (m.as_slice(), number)).collect();
        // Operations on the coefficients: first the angles, then Horner's scheme.
        let (start, mut operations) = angle_operations(angles, &stages, &index, terms);
        operations.extend(horner_operations(plain, &monomials, &index));
        let roundings = roundings(plain, &start, &operations, monomials.len());
        // Products that build each monomial from one of a lower degree.
        let linear = monomials.iter().enumerate().filter(|(_, (degree, _))| *degree == 1);
        let linear: Vec<_> = linear.map(|(number, (_, m))| (first_variable(m), number)).collect();
        let nodes = monomials.iter().filter(|(degree, _)| *degree >= 2);
        let nodes = nodes.map(|(_, m)| MonomialNode::new(plain, m, &index)).collect();
        let univariate =
            (0..plain).filter_map(|variable| Univariate::find(variable, &index)).collect();
        Self {
            start_error: start.iter().map(|x| x.rad()).collect(),
            start: start.iter().map(|x| x.mid()).collect(),
            operations,
            roundings,
            first_node: 1 + linear.len(),
            linear,
            nodes,
            plain,
            univariate,
        }
    }

    /// Allocates the recentred coefficients and scratch memory of this polynomial.
    pub(crate) fn workspace(&self) -> RecentredPolynomial {
        let own = self.roundings.len();
        RecentredPolynomial {
            coefficients: self.start.clone(),
            errors: vec![0.0; own],
            slopes: vec![0.0; self.univariate.len()],
            vertex_factors: Vec::new(),
            monomials: vec![Monomial::ONE; own],
            sums: vec![0.0; own],
        }
    }

    /// Raises `highest` to the highest exponent of each variable in this polynomial.
    pub(crate) fn raise_exponents(&self, highest: &mut [u32]) {
        for node in &self.nodes {
            let highest = &mut highest[node.variable as usize];
            *highest = (*highest).max(node.exponent);
        }
    }

    /// Recentres the polynomial, with slopes for offsets of about `radius`.
    ///
    /// `factors` are the coordinates of the centre and the factors of its angles.
    ///
    /// # Guarantee
    ///
    /// None by itself: [`bound_errors`](Self::bound_errors) bounds the error of each coefficient.
    pub(crate) fn recentre(&self, factors: &[f64], radius: &[f64], work: &mut RecentredPolynomial) {
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

    /// Bounds the errors of all recentrings whose factors are within `bounds`.
    ///
    /// The factors of angles must be known to
    /// [`FACTOR_ROUNDINGS`](crate::polynomial::expansion::angles::FACTOR_ROUNDINGS) roundings of
    /// their bounds.
    ///
    /// # Guarantee
    ///
    /// Each coefficient is a sum of products of factors and one initial coefficient. With N
    /// roundings per product at most, the error of the sum is at most γ_N times the same sum of
    /// magnitudes (Higham, section 3.1). The same operations propagate the initial errors.
    pub(crate) fn bound_errors(&self, bounds: &[f64], work: &mut RecentredPolynomial) {
        let mut magnitudes: Vec<f64> = self.start.iter().map(|x| x.abs()).collect();
        let mut carried = self.start_error.clone();
        self.operate(bounds, &mut magnitudes);
        self.operate(bounds, &mut carried);
        for (i, (error, roundings)) in work.errors.iter_mut().zip(&self.roundings).enumerate() {
            let own = roundings * f64::EPSILON * (magnitudes[i] + carried[i]);
            *error = if own + carried[i] == 0.0 {
                0.0
            } else {
                round_up_sum(carried[i] + own, 2 * *roundings as usize)
            };
        }
    }

    /// Encloses the value at the present centre.
    pub(crate) fn constant(&self, work: &RecentredPolynomial) -> Interval {
        work.coefficient(0)
    }

    /// Iterates over contributions to the gradient at the present centre: a variable and a slope.
    ///
    /// The slopes of one variable must be added up: its derivative, and the slope of its line. The
    /// slope of an angle is the slope of φ₁.
    pub(crate) fn gradient<'a>(
        &'a self,
        work: &'a RecentredPolynomial,
    ) -> impl Iterator<Item = (usize, Interval)> + 'a {
        let derivatives =
            self.linear.iter().map(|&(variable, index)| (variable, work.coefficient(index)));
        let slopes = self.univariate.iter().zip(&work.slopes);
        derivatives.chain(slopes.map(|(powers, slope)| (powers.variable, Interval::point(*slope))))
    }

    /// Encloses the difference between the polynomial and its linear part over a box, given by the
    /// powers of its sides.
    ///
    /// The difference consists of all terms of degree 2 and above, minus the slopes of their lines,
    /// plus the differences between sines and their lines.
    ///
    /// # Guarantee
    ///
    /// Outer, directed rounding.
    pub(crate) fn remainder(
        &self,
        powers: &PowerTable,
        vertices: &mut VertexBound,
        work: &mut RecentredPolynomial,
    ) -> Interval {
        let mut sum = self.mixed_terms(powers, vertices, work);
        let angles = self.linear.iter().filter(|(variable, _)| *variable >= self.plain);
        for &(variable, index) in angles {
            sum += work.coefficient(index) * powers.defect(variable);
        }
        for (univariate, slope) in self.univariate.iter().zip(&work.slopes) {
            let coefficient = |index: usize| work.coefficient(index);
            sum += univariate.range(&coefficient, *slope, powers.get(univariate.variable, 1));
        }
        sum
    }

    /// Encloses the sum of all terms that are not powers of one state or input.
    ///
    /// The sum is evaluated in floating point and its rounding is bounded at the end. A product of
    /// intervals has one rounding per factor relative to its magnitude, the sum one per term, and
    /// the vertices have [`VERTEX_ROUNDINGS`] per factor.
    fn mixed_terms(
        &self,
        powers: &PowerTable,
        vertices: &mut VertexBound,
        work: &mut RecentredPolynomial,
    ) -> Interval {
        // Monomials, each from its parent, and the terms of the sum.
        vertices.divide(powers, &work.vertex_factors);
        for &(variable, index) in &self.linear {
            work.monomials[index] = vertices.part(powers.index(variable, 1));
        }
        let ([mut magnitudes, mut errors], mut terms) = ([0.0; 2], 0);
        for (index, node) in (self.first_node..).zip(&self.nodes) {
            let part = vertices.part(powers.index(node.variable as usize, node.exponent));
            let monomial = work.monomials[node.parent as usize].times(part);
            work.monomials[index] = monomial;
            if !node.is_power {
                let (c, magnitude) = (work.coefficients[index], monomial.magnitude() + SMALLEST);
                vertices.add(c, monomial);
                magnitudes += c.abs() * magnitude;
                errors += work.errors[index] * magnitude;
                terms += 1;
            }
        }
        if terms == 0 {
            return Interval::ZERO;
        }
        // Range over the vertices, widened by rounding and by the errors of the coefficients.
        let roundings = (terms
            + 4 * usize::from(u8::MAX)
            + VERTEX_ROUNDINGS * work.vertex_factors.len()) as f64;
        let error = round_up_sum(errors + magnitudes * (roundings * f64::EPSILON), 2 * terms);
        let range = vertices.range().filter(|_| (magnitudes + errors).is_finite());
        range.map_or(Interval::ENTIRE, |range| range + Interval::centred(0.0, error))
    }

    /// Chooses the factors whose vertices are enumerated from now on: the factors in the largest
    /// part of the sum over the last box.
    pub(crate) fn choose_vertex_factors(
        &self,
        powers: &PowerTable,
        vertices: &mut VertexBound,
        work: &mut RecentredPolynomial,
    ) {
        work.sums.fill(0.0);
        for (i, node) in self.nodes.iter().enumerate().rev() {
            let index = self.first_node + i;
            if !node.is_power {
                work.sums[index] +=
                    work.coefficients[index].abs() * work.monomials[index].magnitude();
            }
            let sum = work.sums[index];
            work.sums[node.parent as usize] += sum;
            vertices.add_weight(powers.index(node.variable as usize, 1), node.exponent, sum);
        }
        for &(variable, index) in &self.linear {
            vertices.add_weight(powers.index(variable, 1), 1, work.sums[index]);
        }
        vertices.choose(powers, &mut work.vertex_factors);
    }
}

impl MonomialNode {
    fn new(plain: usize, monomial: &[u8], index: &BTreeMap<&[u8], usize>) -> Self {
        let variable = first_variable(monomial);
        let parent = index[with_exponent(monomial, variable, 0).as_slice()] as u32;
        Self {
            parent,
            variable: variable as u32,
            exponent: u32::from(monomial[variable]),
            is_power: parent == 0 && variable < plain,
        }
    }
}

#[cfg(test)]
mod tests;
