//! Sums and products of lists of terms.

use super::arithmetic::{Addition, Plain, signed};
use super::monomial::Packing;
use super::space::TaylorSpace;
use crate::Scalar;

/// A packed monomial and its coefficient. Lists of terms are sorted by monomial, each at most once,
/// none with coefficient zero.
pub(super) type Term<C> = (u128, C);

/// A product by as few terms as this is merged term by term, one by more is collected and sorted.
const FEW: usize = 4;

/// Products of terms that are collected before they are sorted, so that memory stays near that of
/// the result.
const CHUNK: usize = 1 << 20;

/// a + b, or a - b where `minus`.
pub(super) fn sum<C: Scalar>(a: &[Term<C>], b: &[Term<C>], minus: bool) -> Vec<Term<C>> {
    sum_by(a, b, minus, &mut Plain)
}

/// [`sum`], by the given addition of coefficients.
pub(super) fn sum_by<C: Scalar>(
    a: &[Term<C>],
    b: &[Term<C>],
    minus: bool,
    add: &mut impl Addition<C>,
) -> Vec<Term<C>> {
    let mut out = Vec::with_capacity(a.len() + b.len());
    let (mut a, mut b) = (a.iter().peekable(), b.iter().peekable());
    loop {
        match (a.peek(), b.peek()) {
            (Some(x), Some(y)) if x.0 == y.0 => {
                let c = add.sum(&x.1, signed(&y.1, minus));
                if !c.is_zero() {
                    out.push((x.0, c));
                }
                a.next();
                b.next();
            }
            (Some(x), Some(y)) if x.0 > y.0 => {
                out.push((y.0, signed(&y.1, minus)));
                b.next();
            }
            (None, Some(y)) => {
                out.push((y.0, signed(&y.1, minus)));
                b.next();
            }
            (Some(x), _) => {
                out.push((x.0, x.1.clone()));
                a.next();
            }
            (None, None) => return out,
        }
    }
}

/// a b, truncated at the space's order.
pub(super) fn product<C: Scalar>(
    space: &TaylorSpace,
    a: &[Term<C>],
    b: &[Term<C>],
) -> Vec<Term<C>> {
    let (few, many) = if a.len() <= b.len() { (a, b) } else { (b, a) };
    if few.len() <= FEW {
        let rows = few.iter().map(|x| times_term(space, x, many));
        return rows.reduce(|p, q| sum(&p, &q, false)).unwrap_or_default();
    }
    let (mut done, mut open) =
        (Vec::new(), Vec::with_capacity(a.len().saturating_mul(b.len()).min(CHUNK)));
    for x in few {
        open.extend(times_term_lazily(space, x, many));
        if open.len() >= CHUNK {
            done = sum(&done, &collected(core::mem::take(&mut open)), false);
        }
    }
    let last = collected(open);
    if done.is_empty() { last } else { sum(&done, &last, false) }
}

/// Number of pairs of terms whose product is not cut off.
pub(super) fn pairs<C>(space: &TaylorSpace, a: &[Term<C>], b: &[Term<C>]) -> usize {
    let (packing, order) = (space.packing, space.order());
    let up_to = |degree: u32| b.partition_point(|term| packing.degree(term.0) <= degree);
    let of_degree = |group: &[Term<C>]| group.len() * up_to(order - packing.degree(group[0].0));
    a.chunk_by(|x, y| packing.degree(x.0) == packing.degree(y.0)).map(of_degree).sum()
}

/// The product by one term keeps the order.
fn times_term<C: Scalar>(space: &TaylorSpace, x: &Term<C>, many: &[Term<C>]) -> Vec<Term<C>> {
    times_term_lazily(space, x, many).filter(|(_, c)| !c.is_zero()).collect()
}

fn times_term_lazily<'a, C: Scalar>(
    space: &TaylorSpace,
    x: &'a Term<C>,
    many: &'a [Term<C>],
) -> impl Iterator<Item = Term<C>> + 'a {
    let (packing, order) = (space.packing, space.order());
    let room = (order + 1).saturating_sub(packing.degree(x.0));
    let fit = many.partition_point(|y| packing.degree(y.0) < room);
    many[..fit].iter().map(|y| (x.0 + y.0, x.1.clone() * y.1.clone()))
}

/// Terms in any order, with repetitions, as a list.
pub(crate) fn collected<C: Scalar>(mut all: Vec<Term<C>>) -> Vec<Term<C>> {
    all.sort_by_key(|term| term.0);
    all.dedup_by(|next, kept| {
        let same = next.0 == kept.0;
        if same {
            kept.1 += next.1.clone();
        }
        same
    });
    all.retain(|(_, c)| !c.is_zero());
    all
}

/// The terms times k.
pub(super) fn scaled<C: Scalar>(terms: &[Term<C>], k: &C) -> Vec<Term<C>> {
    let times = terms.iter().map(|(m, c)| (*m, c.clone() * k.clone()));
    times.filter(|(_, c)| !c.is_zero()).collect()
}

/// The derivative in variable i.
pub(super) fn derivative<C: Scalar>(packing: Packing, terms: &[Term<C>], i: usize) -> Vec<Term<C>> {
    let lower = |(m, c): &Term<C>| match packing.exponent(*m, i) {
        0 => None,
        e => Some((m - packing.variable(i), c.clone() * C::from(f64::from(e)))),
    };
    terms.iter().filter_map(lower).collect()
}
