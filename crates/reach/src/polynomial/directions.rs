//! Which parts of f move the state along one fixed direction.

use std::collections::BTreeMap;

use reachtube_scalar::{Interval, TaylorTerm};

use super::angles::Angles;
use super::shift::ShiftedPolynomial;

/// How far the coefficients of a monomial may be from a multiple of a direction, relative to the largest: rounding of products of a few factors,
/// far below any real difference.
const PARALLEL: f64 = 1e-12;

/// A part of f that is a fixed vector times a polynomial in (x, u, sin, cos).
#[derive(Debug, Clone)]
pub(super) struct Direction {
    /// N entries, the largest 1.
    pub column: Vec<f64>,
    pub polynomial: ShiftedPolynomial,
    pub terms: Vec<TaylorTerm<Interval>>,
}

/// The monomials of f with the column of their coefficients.
type Columns = BTreeMap<Vec<u8>, Vec<Interval>>;

/// The directions of the nonlinear terms that are in several components, if they are at most as many as components; their terms, and those
/// linear in an input along them, are taken out of `terms`, which keeps what rounding leaves.
///
/// # Guarantee
///
/// Rows and directions together enclose f as it was.
pub(super) fn directions(angles: &Angles, terms: &mut [Vec<TaylorTerm<Interval>>]) -> Vec<Direction> {
    let states = terms.len();
    let columns = columns(terms);
    let is_nonlinear = |m: &[u8]| degree(m) >= 2 || degree(&m[angles.plain..]) > 0;
    let nonlinear = columns.iter().filter(|(m, c)| is_nonlinear(m) && entries(c) >= 2);
    let mut found: Vec<Vec<f64>> = Vec::new();
    for (_, column) in nonlinear {
        let unit = unit(column);
        if factor(column, &found).is_none() {
            found.push(unit);
        }
        if found.len() > states {
            return Vec::new();
        }
    }
    let mut parts: Vec<Vec<TaylorTerm<Interval>>> = vec![Vec::new(); found.len()];
    let mut rest = vec![Vec::new(); states];
    for (exponents, column) in columns {
        let is_input = degree(&exponents) == 1 && exponents[states..angles.plain].iter().any(|e| *e > 0);
        let along = if is_nonlinear(&exponents) || is_input { factor(&column, &found) } else { None };
        if let Some((at, factor)) = along {
            parts[at].push(TaylorTerm { exponents: exponents.clone(), coefficient: Interval::point(factor) });
        }
        for (i, mut coefficient) in column.into_iter().enumerate() {
            if let Some((at, factor)) = along {
                coefficient -= Interval::point(factor) * found[at][i];
            }
            if coefficient != Interval::ZERO {
                rest[i].push(TaylorTerm { exponents: exponents.clone(), coefficient });
            }
        }
    }
    terms.iter_mut().zip(rest).for_each(|(terms, rest)| *terms = rest);
    let direction = |(column, terms): (Vec<f64>, Vec<_>)| Direction {
        column,
        polynomial: ShiftedPolynomial::new(angles, &terms),
        terms,
    };
    found.into_iter().zip(parts).map(direction).collect()
}

fn columns(terms: &[Vec<TaylorTerm<Interval>>]) -> Columns {
    let (states, mut columns) = (terms.len(), Columns::new());
    for (row, terms) in terms.iter().enumerate() {
        for term in terms {
            let column =
                columns.entry(term.exponents.clone()).or_insert_with(|| vec![Interval::ZERO; states]);
            column[row] += term.coefficient;
        }
    }
    columns
}

fn degree(exponents: &[u8]) -> u32 {
    exponents.iter().map(|e| u32::from(*e)).sum()
}

fn entries(column: &[Interval]) -> usize {
    column.iter().filter(|x| x.mid() != 0.0).count()
}

fn largest(column: &[Interval]) -> f64 {
    let middle = column.iter().map(|x| x.mid());
    middle.fold(0.0, |largest: f64, x| if x.abs() > largest.abs() { x } else { largest })
}

fn unit(column: &[Interval]) -> Vec<f64> {
    let largest = largest(column);
    column.iter().map(|x| x.mid() / largest).collect()
}

/// The direction that the column is a multiple of, and the multiple.
fn factor(column: &[Interval], found: &[Vec<f64>]) -> Option<(usize, f64)> {
    let largest = largest(column);
    let is_parallel = |direction: &Vec<f64>| {
        let pivot = direction.iter().position(|x| *x == 1.0).expect("the largest entry is 1");
        let multiple = column[pivot].mid();
        let near = |(x, d): (&Interval, &f64)| (x.mid() - multiple * d).abs() <= PARALLEL * largest.abs();
        column.iter().zip(direction).all(near).then_some(multiple)
    };
    found.iter().enumerate().find_map(|(at, direction)| Some((at, is_parallel(direction)?)))
}
