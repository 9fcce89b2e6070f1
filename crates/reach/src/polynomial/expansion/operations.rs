//! The list of operations that recentres a polynomial: expansion of its angles one after the other,
//! then Horner's scheme variable after variable.

use std::collections::{BTreeMap, BTreeSet};

use reachtube_scalar::{Interval, TaylorTerm};

use crate::polynomial::expansion::angles::{Angles, FACTOR_ROUNDINGS};
use crate::polynomial::expansion::monomials::with_exponent;

/// One multiply-add c\[to\] += factors\[factor\] c\[from\] on the coefficients.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Operation {
    pub to: u32,
    pub from: u32,
    pub factor: u32,
}

/// Counts the largest number of roundings in a term of each of the first `own` coefficients.
///
/// Each operation has two roundings and the roundings of its factor; each later operation on the
/// same coefficient adds one rounding of the sum.
pub(crate) fn roundings(
    plain: usize,
    start: &[Interval],
    operations: &[Operation],
    own: usize,
) -> Vec<f64> {
    let mut counts = vec![0.0_f64; start.len()];
    for op in operations {
        let factor = if op.factor as usize >= plain { FACTOR_ROUNDINGS } else { 0.0 };
        let added = counts[op.from as usize] + factor + 2.0;
        let to = &mut counts[op.to as usize];
        *to = added.max(*to + 1.0);
    }
    counts.truncate(own);
    counts
}

/// The monomials before one angle is expanded; the last stage has no angle left.
pub(crate) struct Stage {
    pub monomials: BTreeSet<Vec<u8>>,
    angle: Option<usize>,
}

/// Returns the monomials of the terms before and after the expansion of each angle.
///
/// After the expansion of an angle, the exponent of its sine is the index l of φ_l.
pub(crate) fn stages(angles: &Angles, terms: &[TaylorTerm<Interval>]) -> Vec<Stage> {
    let mut stages = Vec::new();
    let mut monomials: BTreeSet<Vec<u8>> =
        terms.iter().map(|term| term.exponents.clone()).collect();
    for i in 0..angles.states.len() {
        if monomials.iter().any(|m| angles.exponents(m, i) != [0; 2]) {
            let expanded = monomials.iter().flat_map(|m| expanded(angles, i, m)).collect();
            stages.push(Stage { monomials, angle: Some(i) });
            monomials = expanded;
        }
    }
    stages.push(Stage { monomials, angle: None });
    stages
}

/// Returns the terms in φ₀, φ₁, ... that a monomial becomes when angle i is expanded.
fn expanded(angles: &Angles, i: usize, monomial: &[u8]) -> impl Iterator<Item = Vec<u8>> {
    let ([sine, cosine], [a, b]) = (angles.variables(i), angles.exponents(monomial, i));
    let monomial = with_exponent(monomial, cosine, 0);
    (0..=2 * (a + b)).map(move |l| with_exponent(&monomial, sine, l))
}

/// Returns the initial coefficients and the operations that expand all angles.
///
/// `index` holds the index of each monomial of the result; the coefficients of earlier stages
/// come after them.
pub(crate) fn angle_operations(
    angles: &Angles,
    stages: &[Stage],
    index: &BTreeMap<&[u8], usize>,
    terms: &[TaylorTerm<Interval>],
) -> (Vec<Interval>, Vec<Operation>) {
    let variables = angles.plain + angles.states.len();
    let (mut count, mut operations) = (index.len(), Vec::new());
    // Indices of the monomials of each stage.
    let mut indices: Vec<BTreeMap<&[u8], usize>> = Vec::new();
    for stage in &stages[..stages.len() - 1] {
        let numbered = stage.monomials.iter().zip(count..);
        indices.push(numbered.map(|(m, number)| (m.as_slice(), number)).collect());
        count += stage.monomials.len();
    }
    let at = |stage: usize, m: &[u8]| {
        indices.get(stage).map_or_else(|| index[&m[..variables]], |own| own[m])
    };
    // Each monomial of a stage contributes to its terms in the next stage.
    for (number, stage) in stages.iter().enumerate() {
        let Some(i) = stage.angle else { break };
        for monomial in &stage.monomials {
            let exponents = angles.exponents(monomial, i);
            for (l, next) in expanded(angles, i, monomial).enumerate() {
                let (to, from) = (at(number + 1, &next) as u32, at(number, monomial) as u32);
                let factor = angles.factor(i, exponents, l) as u32;
                operations.push(Operation { to, from, factor });
            }
        }
    }
    let mut start = vec![Interval::ZERO; count];
    for term in terms {
        start[at(0, &term.exponents)] += term.coefficient;
    }
    (start, operations)
}

/// Returns the operations of Horner's scheme, variable after variable, on each chain of monomials
/// that differ in that variable alone.
pub(crate) fn horner_operations(
    plain: usize,
    monomials: &BTreeSet<(u32, Vec<u8>)>,
    index: &BTreeMap<&[u8], usize>,
) -> Vec<Operation> {
    let mut operations = Vec::new();
    for variable in 0..plain {
        let next = |m: &Vec<u8>| with_exponent(m, variable, m[variable] + 1);
        let is_end = |m: &Vec<u8>| !index.contains_key(next(m).as_slice());
        for (_, m) in monomials.iter().filter(|(_, m)| m[variable] > 0 && is_end(m)) {
            let at = |exponent: u8| index[with_exponent(m, variable, exponent).as_slice()] as u32;
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
