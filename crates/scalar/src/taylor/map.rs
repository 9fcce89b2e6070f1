//! Fast evaluation of several polynomials in the same variables.

use std::collections::BTreeMap;

use super::monomial::Packing;
use super::polynomial::TaylorPolynomial;
use crate::dispatch::{Dispatch, Kernel};
use crate::powers::Powers;
use crate::scalar::Scalar;

/// A map from k variables to m values whose components are polynomials.
///
/// The components share their monomials. Each monomial costs one product: its parent, which is the
/// monomial without its first variable, times a power of that variable.
///
/// # Examples
///
/// ```
/// use reachtube_scalar::{Interval, PolynomialMap, TaylorPolynomial, TaylorSpace};
///
/// let space = TaylorSpace::new(2, 2).unwrap();
/// let [x, y] = [0, 1].map(|i| TaylorPolynomial::<f64>::variable(&space, i));
/// let map = PolynomialMap::new(2, &[&x * &y, &x * &x]);
/// assert_eq!(map.evaluate(&[2.0, 3.0]), [6.0, 4.0]);
/// let wide = Interval::new(-1.0, 2.0).unwrap();
/// assert!(map.evaluate(&[wide, wide])[1].encloses(&Interval::new(0.0, 4.0).unwrap()));
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct PolynomialMap<C = f64> {
    variables: usize,
    /// Highest exponent of each variable (k entries).
    highest_exponents: Vec<u32>,
    constants: Vec<C>,
    nodes: Vec<Node>,
    /// One group for each [`GROUP`] consecutive components.
    groups: Vec<MonomialGroup<C>>,
}

/// Number of components that are summed together. Neighbouring components mostly have the same
/// monomials.
const GROUP: usize = 2;

/// Number of partial sums computed side by side, so that no addition waits for the one before it.
const SUMS: usize = 2;

/// The non-constant terms of [`GROUP`] components.
#[derive(Debug, Clone, PartialEq)]
struct MonomialGroup<C> {
    /// Increasing numbers of the monomials that occur in one of the components.
    monomials: Vec<u32>,
    /// Coefficients of each monomial, one per component; 0 if it does not occur.
    coefficients: Vec<[C; GROUP]>,
}

/// A monomial: its parent times a power of one variable.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Node {
    /// Number of the parent: 0 for the monomial 1, else the index of its node plus 1.
    parent: u32,
    /// Index into the list of powers.
    power: u32,
}

/// Scratch memory for an evaluation.
#[derive(Debug, Clone)]
pub struct MapWorkspace<T> {
    powers: Vec<T>,
    values: Vec<T>,
}

impl<C: Scalar> PolynomialMap<C> {
    /// Returns the map with the given components. Each is a constant or a polynomial of the same
    /// space, which has `variables` variables.
    ///
    /// # Panics
    ///
    /// Panics if a component belongs to a space with another number of variables.
    pub fn new(variables: usize, components: &[TaylorPolynomial<C>]) -> Self {
        let mut packing = Packing::new(variables).expect("1 to 120 variables");
        let mut constants = vec![C::zero(); components.len()];
        let mut monomials: BTreeMap<u128, Vec<(u32, C)>> = BTreeMap::new();
        for (at, component) in components.iter().enumerate() {
            if let Some(space) = component.space() {
                assert_eq!(
                    space.variables(),
                    variables,
                    "component {at} has another number of variables"
                );
                packing = space.packing;
            }
            component.for_each_term(|m, c| match m {
                0 => constants[at] = c.clone(),
                _ => monomials.entry(m).or_default().push((at as u32, c.clone())),
            });
        }
        close_under_parents(packing, &mut monomials);
        let group = MonomialGroup { monomials: vec![], coefficients: vec![] };
        let groups = vec![group; components.len().div_ceil(GROUP)];
        let mut map = Self {
            variables,
            highest_exponents: vec![0; variables],
            constants,
            nodes: vec![],
            groups,
        };
        map.fill(packing, monomials);
        map
    }

    /// Numbers the monomials and fills nodes and groups.
    fn fill(&mut self, packing: Packing, monomials: BTreeMap<u128, Vec<(u32, C)>>) {
        for m in monomials.keys() {
            for i in 0..self.variables {
                self.highest_exponents[i] = self.highest_exponents[i].max(packing.exponent(*m, i));
            }
        }
        let starts: Vec<u32> =
            (0..self.variables).map(|i| self.highest_exponents[..i].iter().sum()).collect();
        let mut numbers = std::collections::HashMap::with_capacity(monomials.len());
        for (m, terms) in monomials {
            let i = packing.first_variable(m).expect("1 is a constant");
            let parent = numbers.get(&packing.without(m, i)).copied().unwrap_or(0);
            let power = starts[i] + packing.exponent(m, i) - 1;
            self.nodes.push(Node { parent, power });
            let number = self.nodes.len() as u32;
            for (component, c) in terms {
                self.groups[component as usize / GROUP].push(number, component as usize % GROUP, c);
            }
            numbers.insert(m, number);
        }
    }

    /// Returns the number of components m.
    pub fn components(&self) -> usize {
        self.constants.len()
    }

    /// Returns scratch memory for evaluation over T.
    pub fn workspace<T: Scalar>(&self) -> MapWorkspace<T> {
        let powers = self.highest_exponents.iter().sum::<u32>() as usize;
        MapWorkspace {
            powers: vec![T::zero(); powers],
            values: vec![T::zero(); self.nodes.len() + 1],
        }
    }

    /// Evaluates the components at `at` (k values) into `out` (m values), without allocation.
    ///
    /// # Guarantee
    ///
    /// Over `Interval`: outer enclosures of the ranges of the components over the box `at`.
    ///
    /// # Panics
    ///
    /// Panics if `at` or `out` has another length, or the workspace belongs to another map.
    pub fn evaluate_into<T: Scalar + From<C> + Powers>(
        &self,
        at: &[T],
        ws: &mut MapWorkspace<T>,
        out: &mut [T],
    ) {
        assert_eq!(
            (at.len(), out.len()),
            (self.variables, self.constants.len()),
            "a map needs one argument per variable and one value per component"
        );
        T::dispatch(Evaluation { map: self, at, ws, out });
    }

    /// Evaluates the components at `at` (k values), like [`evaluate_into`](Self::evaluate_into).
    pub fn evaluate<T: Scalar + From<C> + Powers>(&self, at: &[T]) -> Vec<T> {
        let mut out = vec![T::zero(); self.constants.len()];
        self.evaluate_into(at, &mut self.workspace(), &mut out);
        out
    }
}

/// The arguments of [`PolynomialMap::evaluate_into`].
struct Evaluation<'a, C, T> {
    map: &'a PolynomialMap<C>,
    at: &'a [T],
    ws: &'a mut MapWorkspace<T>,
    out: &'a mut [T],
}

impl<C: Scalar, T: Scalar + From<C> + Powers> Kernel for Evaluation<'_, C, T> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Self { map, at, ws, out } = self;
        // Powers of each variable, up to its highest exponent.
        let mut next = 0;
        for (x, highest) in at.iter().zip(&map.highest_exponents) {
            for e in 1..=*highest {
                ws.powers[next] = x.power(e, ws.powers.get(next.wrapping_sub(1)));
                next += 1;
            }
        }
        // Monomials, each after its parent.
        ws.values[0] = T::one();
        for (number, node) in map.nodes.iter().enumerate() {
            let power = &ws.powers[node.power as usize];
            ws.values[number + 1] = match node.parent {
                0 => power.clone(),
                parent => ws.values[parent as usize].clone() * power.clone(),
            };
        }
        // Sums of coefficients times monomials.
        let constants = map.constants.chunks(GROUP);
        for ((out, constants), group) in out.chunks_mut(GROUP).zip(constants).zip(&map.groups) {
            let sums = group.sums(&ws.values);
            for ((out, constant), sum) in out.iter_mut().zip(constants).zip(sums) {
                *out = T::from(constant.clone()) + sum;
            }
        }
    }
}

impl<C: Scalar> MonomialGroup<C> {
    /// Stores the coefficient of a monomial in one component; monomials arrive in order.
    fn push(&mut self, monomial: u32, component: usize, c: C) {
        if self.monomials.last() != Some(&monomial) {
            self.monomials.push(monomial);
            self.coefficients.push(core::array::from_fn(|_| C::zero()));
        }
        if let Some(coefficients) = self.coefficients.last_mut() {
            coefficients[component] = c;
        }
    }

    /// Returns Σ coefficient · monomial of each component.
    #[inline(always)]
    fn sums<T: Scalar + From<C>>(&self, values: &[T]) -> [T; GROUP] {
        let add = |sums: &mut [T; GROUP], c: &[C; GROUP], monomial: u32| {
            let value = &values[monomial as usize];
            for (sum, c) in sums.iter_mut().zip(c) {
                *sum += T::from(c.clone()) * value.clone();
            }
        };
        let (coefficients, monomials) =
            (self.coefficients.chunks_exact(SUMS), self.monomials.chunks_exact(SUMS));
        let rest = coefficients.remainder().iter().zip(monomials.remainder());
        let mut sums: [[T; GROUP]; SUMS] =
            core::array::from_fn(|_| core::array::from_fn(|_| T::zero()));
        for (c, monomials) in coefficients.zip(monomials) {
            for i in 0..SUMS {
                add(&mut sums[i], &c[i], monomials[i]);
            }
        }
        rest.for_each(|(c, monomial)| add(&mut sums[0], c, *monomial));
        let [mut total, other] = sums;
        total.iter_mut().zip(other).for_each(|(a, b)| *a += b);
        total
    }
}

impl<C: Scalar> Powers for TaylorPolynomial<C> {}

impl<C: Scalar> Dispatch for TaylorPolynomial<C> {}

/// Adds the missing parents of monomials, without coefficients.
fn close_under_parents<C>(packing: Packing, monomials: &mut BTreeMap<u128, Vec<(u32, C)>>) {
    let mut missing: Vec<u128> = monomials.keys().copied().collect();
    while let Some(m) = missing.pop() {
        let i = packing.first_variable(m).expect("1 is a constant");
        let parent = packing.without(m, i);
        if parent != 0 && !monomials.contains_key(&parent) {
            monomials.insert(parent, Vec::new());
            missing.push(parent);
        }
    }
}
