//! Sums and products of lists of terms.

use super::addition::{Addition, PlainAddition, negated_if};
use super::monomial::Packing;
use super::space::TaylorSpace;
use crate::scalar::Scalar;

/// A packed monomial and its coefficient.
///
/// A list of terms is sorted by monomial. Each monomial occurs once, with a non-zero coefficient.
pub(crate) type Term<C> = (u128, C);

/// Largest number of terms of the shorter factor for which the rows of a product are merged one
/// by one. For longer factors, all products are collected and sorted.
const MERGED_ROWS: usize = 4;

/// Number of products collected before they are sorted. It keeps the memory near the size of the
/// result.
const BATCH: usize = 1 << 20;

/// Returns a + b, or a - b where `minus`.
fn sum<C: Scalar>(a: &[Term<C>], b: &[Term<C>], minus: bool) -> Vec<Term<C>> {
    sum_with(a, b, minus, &mut PlainAddition)
}

/// Returns a + b, or a - b where `minus`, by the given addition of coefficients.
pub(super) fn sum_with<C: Scalar>(
    a: &[Term<C>],
    b: &[Term<C>],
    minus: bool,
    addition: &mut impl Addition<C>,
) -> Vec<Term<C>> {
    let mut out = Vec::with_capacity(a.len() + b.len());
    let (mut a, mut b) = (a.iter().peekable(), b.iter().peekable());
    loop {
        match (a.peek(), b.peek()) {
            (Some(x), Some(y)) if x.0 == y.0 => {
                let c = addition.sum(&x.1, negated_if(minus, &y.1));
                if !c.is_zero() {
                    out.push((x.0, c));
                }
                a.next();
                b.next();
            }
            (Some(x), Some(y)) if x.0 > y.0 => {
                out.push((y.0, negated_if(minus, &y.1)));
                b.next();
            }
            (None, Some(y)) => {
                out.push((y.0, negated_if(minus, &y.1)));
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

/// Returns a b, truncated at the order of the space.
pub(super) fn product<C: Scalar>(
    space: &TaylorSpace,
    a: &[Term<C>],
    b: &[Term<C>],
) -> Vec<Term<C>> {
    let (short, long) = if a.len() <= b.len() { (a, b) } else { (b, a) };
    if short.len() <= MERGED_ROWS {
        let rows = short.iter().map(|x| product_with_term(space, x, long));
        return rows.reduce(|p, q| sum(&p, &q, false)).unwrap_or_default();
    }
    let (mut merged, mut pending) =
        (Vec::new(), Vec::with_capacity(a.len().saturating_mul(b.len()).min(BATCH)));
    for x in short {
        pending.extend(products_with_term(space, x, long));
        if pending.len() >= BATCH {
            let batch = collect_like_terms(core::mem::take(&mut pending));
            merged = sum(&merged, &batch, false);
        }
    }
    let last = collect_like_terms(pending);
    if merged.is_empty() { last } else { sum(&merged, &last, false) }
}

/// Returns the number of pairs of terms whose product is not truncated.
pub(super) fn count_kept_products<C>(space: &TaylorSpace, a: &[Term<C>], b: &[Term<C>]) -> usize {
    let (packing, order) = (space.packing, space.order());
    let up_to = |degree: u32| b.partition_point(|term| packing.degree(term.0) <= degree);
    let of_group = |group: &[Term<C>]| group.len() * up_to(order - packing.degree(group[0].0));
    a.chunk_by(|x, y| packing.degree(x.0) == packing.degree(y.0)).map(of_group).sum()
}

/// Returns the product with one term as a list of terms; such a product keeps the order of terms.
fn product_with_term<C: Scalar>(
    space: &TaylorSpace,
    x: &Term<C>,
    terms: &[Term<C>],
) -> Vec<Term<C>> {
    products_with_term(space, x, terms).filter(|(_, c)| !c.is_zero()).collect()
}

/// Iterates over the products with one term that are not truncated.
fn products_with_term<'a, C: Scalar>(
    space: &TaylorSpace,
    x: &'a Term<C>,
    terms: &'a [Term<C>],
) -> impl Iterator<Item = Term<C>> + 'a {
    let (packing, order) = (space.packing, space.order());
    let room = (order + 1).saturating_sub(packing.degree(x.0));
    let fit = terms.partition_point(|y| packing.degree(y.0) < room);
    terms[..fit].iter().map(|y| (x.0 + y.0, x.1.clone() * y.1.clone()))
}

/// Sorts terms and adds the coefficients of equal monomials in their given order.
pub(crate) fn collect_like_terms<C: Scalar>(mut terms: Vec<Term<C>>) -> Vec<Term<C>> {
    terms.sort_by_key(|term| term.0);
    terms.dedup_by(|next, kept| {
        let same = next.0 == kept.0;
        if same {
            kept.1 += next.1.clone();
        }
        same
    });
    terms.retain(|(_, c)| !c.is_zero());
    terms
}

pub(super) fn scaled<C: Scalar>(terms: &[Term<C>], k: &C) -> Vec<Term<C>> {
    let products = terms.iter().map(|(m, c)| (*m, c.clone() * k.clone()));
    products.filter(|(_, c)| !c.is_zero()).collect()
}

pub(super) fn constant<C: Scalar>(c: &C) -> Vec<Term<C>> {
    if c.is_zero() { Vec::new() } else { vec![(0, c.clone())] }
}

pub(super) fn derivative<C: Scalar>(packing: Packing, terms: &[Term<C>], i: usize) -> Vec<Term<C>> {
    let lower = |(m, c): &Term<C>| match packing.exponent(*m, i) {
        0 => None,
        e => Some((m - packing.variable(i), c.clone() * C::from(f64::from(e)))),
    };
    terms.iter().filter_map(lower).collect()
}
