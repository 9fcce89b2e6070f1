//! The parts of f that move the state along one fixed direction.

use std::collections::BTreeMap;

use nalgebra::{DMatrix, DVector};
use reachtube_scalar::{Interval, TaylorTerm};

use crate::polynomial::expansion::angles::Angles;
use crate::polynomial::expansion::monomials::degree;
use crate::polynomial::expansion::recentred::Recentring;

/// Largest distance between the coefficients of a monomial and a multiple of a direction, relative
/// to the largest coefficient.
///
/// It covers the rounding of products and of sums that cancel, and is far below any real
/// difference.
const PARALLEL: f64 = 1e-12;

/// A part of f that is a fixed vector times a polynomial in (x, u, sin, cos).
#[derive(Debug, Clone)]
pub(crate) struct FixedDirection {
    /// The fixed vector, N entries of which the largest is 1.
    pub column: Vec<f64>,
    /// The polynomial, prepared for recentring.
    pub polynomial: Recentring,
    /// The terms of the polynomial.
    pub terms: Vec<TaylorTerm<Interval>>,
}

/// The monomials of f, each with the column of its coefficients.
type Columns = BTreeMap<Vec<u8>, Vec<Interval>>;

/// Finds the directions of the nonlinear terms and removes their terms from `terms`.
///
/// The directions are the columns of the inputs, if they span all nonlinear terms. Otherwise they
/// are the distinct columns of the nonlinear terms with several entries, if these are at most as
/// many as components. Terms linear in an input along a direction are removed too. `terms` keeps
/// the rounding errors.
///
/// # Guarantee
///
/// Remaining terms and directions together enclose the original f, also where coefficients vary
/// within their intervals over time.
pub(crate) fn directions(
    angles: &Angles,
    terms: &mut [Vec<TaylorTerm<Interval>>],
) -> Vec<FixedDirection> {
    let states = terms.len();
    let columns = columns(terms);
    let is_nonlinear = |m: &[u8]| degree(m) >= 2 || degree(&m[angles.plain..]) > 0;
    let is_input = |m: &[u8]| degree(m) == 1 && degree(&m[states..angles.plain]) == 1;
    let mut nonlinear: Vec<&[Interval]> = columns
        .iter()
        .filter(|(m, _)| is_nonlinear(m))
        .map(|(_, column)| column.as_slice())
        .collect();
    // The largest columns have the smallest relative rounding errors.
    nonlinear.sort_by(|a, b| largest(b).abs().total_cmp(&largest(a).abs()));
    let inputs =
        columns.iter().filter(|(m, _)| is_input(m)).map(|(_, column)| unit(column)).collect();
    let Some(basis) = DirectionBasis::of_inputs(inputs, &nonlinear)
        .or_else(|| DirectionBasis::of_parallels(&nonlinear))
    else {
        return Vec::new();
    };
    let mut parts: Vec<Vec<TaylorTerm<Interval>>> = vec![Vec::new(); basis.columns.len()];
    let mut remaining = Columns::new();
    for (exponents, mut column) in columns {
        if is_nonlinear(&exponents) || is_input(&exponents) {
            for (g, factor) in basis.coordinates(&column).unwrap_or_default() {
                let coefficient = Interval::point(factor);
                parts[g].push(TaylorTerm { exponents: exponents.clone(), coefficient });
                let along = basis.columns[g].iter().map(|x| coefficient * *x);
                column.iter_mut().zip(along).for_each(|(own, along)| *own -= along);
            }
        }
        add_remaining(angles, exponents, column, basis.tolerance, &mut remaining);
    }
    for (row, terms) in terms.iter_mut().enumerate() {
        let own = remaining.iter().filter(|(_, column)| column[row] != Interval::ZERO);
        let term = |(m, c): (&Vec<u8>, &Vec<Interval>)| TaylorTerm {
            exponents: m.clone(),
            coefficient: c[row],
        };
        *terms = own.map(term).collect();
    }
    let direction = |(column, terms): (Vec<f64>, Vec<_>)| FixedDirection {
        column,
        polynomial: Recentring::new(angles, &terms),
        terms,
    };
    basis.columns.into_iter().zip(parts).map(direction).collect()
}

/// Directions, with the coordinates of columns in them.
struct DirectionBasis {
    /// The directions; the largest entry of each is 1.
    columns: Vec<Vec<f64>>,
    /// Matrix from a column to its coordinates, if a column may combine several directions.
    inverse: Option<DMatrix<f64>>,
    /// Largest error of an entry.
    tolerance: f64,
}

impl DirectionBasis {
    /// Builds the basis from the columns of the inputs, if they are linearly independent and span
    /// all nonlinear columns.
    fn of_inputs(columns: Vec<Vec<f64>>, nonlinear: &[&[Interval]]) -> Option<Self> {
        let tolerance = tolerance(nonlinear);
        let states = columns.first()?.len();
        let matrix = DMatrix::from_fn(states, columns.len(), |i, j| columns[j][i]);
        let inverse = Some((matrix.transpose() * &matrix).cholesky()?.solve(&matrix.transpose()));
        let basis = Self { columns, inverse, tolerance };
        nonlinear.iter().all(|column| basis.coordinates(column).is_some()).then_some(basis)
    }

    /// Builds the basis from the nonlinear columns that have several entries and are not multiples
    /// of each other, if they are at most as many as components.
    fn of_parallels(nonlinear: &[&[Interval]]) -> Option<Self> {
        let mut basis =
            Self { columns: Vec::new(), inverse: None, tolerance: tolerance(nonlinear) };
        for column in nonlinear {
            let entries = column.iter().filter(|x| x.mid().abs() > basis.tolerance).count();
            if entries >= 2 && basis.coordinates(column).is_none() {
                basis.columns.push(unit(column));
            }
            if basis.columns.len() > column.len() {
                return None;
            }
        }
        Some(basis)
    }

    /// Returns the indices and factors of the directions whose sum is the column, up to the
    /// tolerance.
    fn coordinates(&self, column: &[Interval]) -> Option<Vec<(usize, f64)>> {
        let Some(inverse) = &self.inverse else {
            return self.columns.iter().enumerate().find_map(|(g, direction)| {
                let pivot =
                    direction.iter().position(|x| *x == 1.0).expect("the largest entry is 1");
                let factors = vec![(g, column[pivot].mid())];
                self.is_sum(column, &factors).then_some(factors)
            });
        };
        let factors =
            inverse * DVector::from_iterator(column.len(), column.iter().map(|x| x.mid()));
        let factors: Vec<_> = factors
            .iter()
            .copied()
            .enumerate()
            .filter(|(_, factor)| factor.abs() > self.tolerance)
            .collect();
        self.is_sum(column, &factors).then_some(factors)
    }

    /// Returns whether the column is the sum of factors times directions, up to the tolerance.
    fn is_sum(&self, column: &[Interval], factors: &[(usize, f64)]) -> bool {
        let sum =
            |i: usize| factors.iter().map(|(g, factor)| factor * self.columns[*g][i]).sum::<f64>();
        // Each neglected factor is at most the tolerance.
        let near = (self.columns.len() + 1) as f64 * self.tolerance;
        column.iter().enumerate().all(|(i, x)| (x.mid() - sum(i)).abs() <= near)
    }
}

/// Returns the tolerance for columns of which the first is the largest.
fn tolerance(columns: &[&[Interval]]) -> f64 {
    PARALLEL * columns.first().map_or(0.0, |column| largest(column).abs())
}

/// Adds a monomial to the remaining terms.
///
/// Where only rounding errors remain, sines and cosines are replaced by the interval [-1, 1], which
/// makes the monomial cheaper.
fn add_remaining(
    angles: &Angles,
    mut exponents: Vec<u8>,
    mut column: Vec<Interval>,
    tolerance: f64,
    remaining: &mut Columns,
) {
    let is_rounding = column.iter().all(|x| x.mag() <= tolerance);
    if is_rounding && degree(&exponents[angles.plain..]) > 0 {
        exponents[angles.plain..].fill(0);
        column.iter_mut().for_each(|x| *x = Interval::centred(0.0, x.mag()));
    }
    let own = remaining.entry(exponents).or_insert_with(|| vec![Interval::ZERO; column.len()]);
    own.iter_mut().zip(column).for_each(|(own, x)| *own += x);
}

/// Collects the coefficients of each monomial over all components.
fn columns(terms: &[Vec<TaylorTerm<Interval>>]) -> Columns {
    let (states, mut columns) = (terms.len(), Columns::new());
    for (row, terms) in terms.iter().enumerate() {
        for term in terms {
            let column = columns
                .entry(term.exponents.clone())
                .or_insert_with(|| vec![Interval::ZERO; states]);
            column[row] += term.coefficient;
        }
    }
    columns
}

/// Returns the midpoint of largest magnitude.
fn largest(column: &[Interval]) -> f64 {
    let middle = column.iter().map(|x| x.mid());
    middle.fold(0.0, |largest: f64, x| if x.abs() > largest.abs() { x } else { largest })
}

/// Divides the midpoints by the one of largest magnitude.
fn unit(column: &[Interval]) -> Vec<f64> {
    let largest = largest(column);
    column.iter().map(|x| x.mid() / largest).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const COLUMNS: [[f64; 2]; 2] = [[0.7, 0.1], [0.1, 0.3]];

    /// Returns the terms of two components in two states, two inputs and the sine and cosine of one
    /// state, with rounded coefficients; two loads act along two columns.
    fn terms() -> Vec<Vec<TaylorTerm<Interval>>> {
        let loads = [
            (vec![0, 0, 1, 0, 0, 0], [1.0, 0.0]),
            (vec![0, 0, 0, 1, 0, 0], [0.0, 1.0]),
            (vec![1, 1, 0, 0, 1, 0], [0.3, -0.9]),
            (vec![2, 0, 0, 0, 0, 1], [1.1, 1e-17]),
            (vec![0, 0, 0, 0, 0, 2], [-0.2, 0.6]),
        ];
        let component = |i: usize| {
            let term = |(exponents, load): &(Vec<u8>, [f64; 2])| TaylorTerm {
                exponents: exponents.clone(),
                coefficient: Interval::point(COLUMNS[0][i] * load[0] + COLUMNS[1][i] * load[1]),
            };
            loads.iter().map(term).collect()
        };
        vec![component(0), component(1)]
    }

    fn value(terms: &[TaylorTerm<Interval>], at: &[f64; 6]) -> Interval {
        let power = |(x, e): (&f64, &u8)| Interval::point(*x).powi((*e).into());
        terms
            .iter()
            .map(|t| at.iter().zip(&t.exponents).map(power).fold(t.coefficient, |p, x| p * x))
            .sum()
    }

    #[test]
    fn directions_of_the_inputs_are_found_where_monomials_are_shared() {
        let (before, mut remaining) = (terms(), terms());
        let angles = Angles::new(4, &[0], before.iter().flatten());
        let found = directions(&angles, &mut remaining);
        assert_eq!(found.len(), 2);
        // Only rounding errors remain, without sines and cosines.
        for term in remaining.iter().flatten() {
            assert!(term.coefficient.mag() < 1e-15 && term.exponents[4..] == [0, 0], "{term:?}");
        }
        let at = [0.4, -0.7, 1.3, 0.2, 0.4f64.sin(), 0.4f64.cos()];
        for i in 0..2 {
            let along: Interval = found.iter().map(|d| value(&d.terms, &at) * d.column[i]).sum();
            let (own, after) = (value(&before[i], &at), value(&remaining[i], &at) + along);
            assert!(
                after.encloses(&Interval::point(own.mid())) && after.width() < 1e-14,
                "{own:?} {after:?}"
            );
        }
    }

    #[test]
    fn too_many_distinct_columns_stay_components() {
        let term =
            |a: u8, c: f64| TaylorTerm { exponents: vec![a, 2], coefficient: Interval::point(c) };
        let before = vec![
            vec![term(0, 1.0), term(1, 1.0), term(2, 1.0)],
            vec![term(0, 1.0), term(1, 2.0), term(2, 3.0)],
        ];
        let mut remaining = before.clone();
        assert!(directions(&Angles::new(2, &[], [].iter()), &mut remaining).is_empty());
        assert_eq!(remaining, before);
    }
}
