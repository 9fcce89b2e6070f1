//! Which parts of f move the state along one fixed direction.

use std::collections::BTreeMap;

use nalgebra::{DMatrix, DVector};
use reachtube_scalar::{Interval, TaylorTerm};

use super::angles::Angles;
use super::shift::ShiftedPolynomial;

/// How far the coefficients of a monomial may be from a multiple of a direction, relative to the
/// largest of all: rounding of products and of sums that cancel, far below any real difference.
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

/// The directions of the nonlinear terms: those of the inputs, if they span them; or those that
/// they themselves have in several components, if they are at most as many as components. Their
/// terms, and those linear in an input along them, are taken out of `terms`, which keeps what
/// rounding leaves.
///
/// # Guarantee
///
/// Rows and directions together enclose f as it was, for coefficients that may be others of their
/// intervals at each time.
pub(super) fn directions(
    angles: &Angles,
    terms: &mut [Vec<TaylorTerm<Interval>>],
) -> Vec<Direction> {
    let states = terms.len();
    let columns = columns(terms);
    let is_nonlinear = |m: &[u8]| degree(m) >= 2 || degree(&m[angles.plain..]) > 0;
    let is_input = |m: &[u8]| degree(m) == 1 && degree(&m[states..angles.plain]) == 1;
    let mut nonlinear: Vec<&[Interval]> = columns
        .iter()
        .filter(|(m, _)| is_nonlinear(m))
        .map(|(_, column)| column.as_slice())
        .collect();
    // The largest are the least blurred by rounding.
    nonlinear.sort_by(|a, b| largest(b).abs().total_cmp(&largest(a).abs()));
    let inputs =
        columns.iter().filter(|(m, _)| is_input(m)).map(|(_, column)| unit(column)).collect();
    let Some(basis) =
        Basis::of_inputs(inputs, &nonlinear).or_else(|| Basis::of_parallels(&nonlinear))
    else {
        return Vec::new();
    };
    let mut parts: Vec<Vec<TaylorTerm<Interval>>> = vec![Vec::new(); basis.columns.len()];
    let mut rest = Columns::new();
    for (exponents, mut column) in columns {
        if is_nonlinear(&exponents) || is_input(&exponents) {
            for (at, factor) in basis.coordinates(&column).unwrap_or_default() {
                let coefficient = Interval::point(factor);
                parts[at].push(TaylorTerm { exponents: exponents.clone(), coefficient });
                let along = basis.columns[at].iter().map(|x| coefficient * *x);
                column.iter_mut().zip(along).for_each(|(own, along)| *own -= along);
            }
        }
        add_rest(angles, exponents, column, basis.tolerance, &mut rest);
    }
    for (row, terms) in terms.iter_mut().enumerate() {
        let own = rest.iter().filter(|(_, column)| column[row] != Interval::ZERO);
        let term = |(m, c): (&Vec<u8>, &Vec<Interval>)| TaylorTerm {
            exponents: m.clone(),
            coefficient: c[row],
        };
        *terms = own.map(term).collect();
    }
    let direction = |(column, terms): (Vec<f64>, Vec<_>)| Direction {
        column,
        polynomial: ShiftedPolynomial::new(angles, &terms),
        terms,
    };
    basis.columns.into_iter().zip(parts).map(direction).collect()
}

/// Directions, and how a column is written in them.
struct Basis {
    /// The largest entry of each is 1.
    columns: Vec<Vec<f64>>,
    /// From a column to its coordinates, where the directions are taken together.
    inverse: Option<DMatrix<f64>>,
    /// What an entry may be off by.
    tolerance: f64,
}

impl Basis {
    /// The columns of the inputs, if they are independent and span all the others.
    fn of_inputs(columns: Vec<Vec<f64>>, nonlinear: &[&[Interval]]) -> Option<Self> {
        let tolerance = tolerance(nonlinear);
        let states = columns.first()?.len();
        let matrix = DMatrix::from_fn(states, columns.len(), |i, j| columns[j][i]);
        let inverse = Some((matrix.transpose() * &matrix).cholesky()?.solve(&matrix.transpose()));
        let basis = Self { columns, inverse, tolerance };
        nonlinear.iter().all(|column| basis.coordinates(column).is_some()).then_some(basis)
    }

    /// The columns themselves that have several entries and are no multiples of each other, if they
    /// are at most as many as components.
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

    /// The directions that a column is a sum of and the factors, up to the tolerance.
    fn coordinates(&self, column: &[Interval]) -> Option<Vec<(usize, f64)>> {
        let Some(inverse) = &self.inverse else {
            return self.columns.iter().enumerate().find_map(|(at, direction)| {
                let pivot =
                    direction.iter().position(|x| *x == 1.0).expect("the largest entry is 1");
                let factors = vec![(at, column[pivot].mid())];
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

    fn is_sum(&self, column: &[Interval], factors: &[(usize, f64)]) -> bool {
        let sum = |i: usize| {
            factors.iter().map(|(at, factor)| factor * self.columns[*at][i]).sum::<f64>()
        };
        // The factors left out are up to the tolerance each.
        let near = (self.columns.len() + 1) as f64 * self.tolerance;
        column.iter().enumerate().all(|(i, x)| (x.mid() - sum(i)).abs() <= near)
    }
}

/// Of columns of which the first is the largest.
fn tolerance(columns: &[&[Interval]]) -> f64 {
    PARALLEL * columns.first().map_or(0.0, |column| largest(column).abs())
}

/// Adds a monomial to the rest; where it is rounding, its sines and cosines are any numbers within
/// ±1, so that it costs no more than their factor.
fn add_rest(
    angles: &Angles,
    mut exponents: Vec<u8>,
    mut column: Vec<Interval>,
    tolerance: f64,
    rest: &mut Columns,
) {
    let is_rounding = column.iter().all(|x| x.mag() <= tolerance);
    if is_rounding && degree(&exponents[angles.plain..]) > 0 {
        exponents[angles.plain..].fill(0);
        column.iter_mut().for_each(|x| *x = Interval::centered(0.0, x.mag()));
    }
    let own = rest.entry(exponents).or_insert_with(|| vec![Interval::ZERO; column.len()]);
    own.iter_mut().zip(column).for_each(|(own, x)| *own += x);
}

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

fn degree(exponents: &[u8]) -> u32 {
    exponents.iter().map(|e| u32::from(*e)).sum()
}

fn largest(column: &[Interval]) -> f64 {
    let middle = column.iter().map(|x| x.mid());
    middle.fold(0.0, |largest: f64, x| if x.abs() > largest.abs() { x } else { largest })
}

fn unit(column: &[Interval]) -> Vec<f64> {
    let largest = largest(column);
    column.iter().map(|x| x.mid() / largest).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const COLUMNS: [[f64; 2]; 2] = [[0.7, 0.1], [0.1, 0.3]];

    /// Terms of two components in two states, two inputs and the sine and cosine of one, which two
    /// loads drive along two columns; each coefficient is rounded.
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
    fn what_drives_along_the_inputs_is_found_where_monomials_are_shared() {
        let (before, mut rest) = (terms(), terms());
        let angles = Angles::new(4, &[0], before.iter().flatten());
        let found = directions(&angles, &mut rest);
        assert_eq!(found.len(), 2);
        // What is left is rounding, without sines and cosines.
        for term in rest.iter().flatten() {
            assert!(term.coefficient.mag() < 1e-15 && term.exponents[4..] == [0, 0], "{term:?}");
        }
        let at = [0.4, -0.7, 1.3, 0.2, 0.4f64.sin(), 0.4f64.cos()];
        for i in 0..2 {
            let along: Interval = found.iter().map(|d| value(&d.terms, &at) * d.column[i]).sum();
            let (own, after) = (value(&before[i], &at), value(&rest[i], &at) + along);
            assert!(
                after.encloses(&Interval::point(own.mid())) && after.width() < 1e-14,
                "{own:?} {after:?}"
            );
        }
    }

    #[test]
    fn many_unlike_columns_stay_components() {
        let term =
            |a: u8, c: f64| TaylorTerm { exponents: vec![a, 2], coefficient: Interval::point(c) };
        let before = vec![
            vec![term(0, 1.0), term(1, 1.0), term(2, 1.0)],
            vec![term(0, 1.0), term(1, 2.0), term(2, 3.0)],
        ];
        let mut rest = before.clone();
        assert!(directions(&Angles::new(2, &[], [].iter()), &mut rest).is_empty());
        assert_eq!(rest, before);
    }
}
