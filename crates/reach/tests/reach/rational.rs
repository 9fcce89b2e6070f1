//! The matrices e^{Ah} and Γ(h) in rational numbers: partial sums of the Taylor series, with a
//! bound of the truncation error.

use nalgebra::DMatrix;
use num_rational::BigRational;
use num_traits::{FromPrimitive, One, Signed, ToPrimitive, Zero};
use reachtube_reach::{IntervalMatrix, LinearSystem};
use reachtube_scalar::Interval;

pub(crate) type Rational = BigRational;
pub(crate) type RationalMatrix = Vec<Vec<Rational>>;

pub(crate) fn exact(x: f64) -> Rational {
    Rational::from_float(x).expect("a finite number")
}

fn integer(n: usize) -> Rational {
    Rational::from_usize(n).unwrap()
}

/// Returns the tolerance for equal rational numbers, far below any rounding of an `f64` near 1.
fn tiny() -> Rational {
    num_traits::pow(integer(10), 30).recip()
}

/// Returns the largest multiple of 2⁻³²⁰ up to x, so that numerators do not grow with every step.
pub(crate) fn rounded(x: &Rational) -> Rational {
    let scale = num_traits::pow(integer(2), 320);
    (x * &scale).floor() / scale
}

pub(crate) fn multiply(left: &RationalMatrix, right: &RationalMatrix) -> RationalMatrix {
    let entry = |row: &Vec<Rational>, j: usize| {
        let terms = row.iter().zip(right).filter(|(x, _)| !x.is_zero());
        terms.fold(Rational::zero(), |sum, (x, other)| sum + x * &other[j])
    };
    left.iter().map(|row| (0..right[0].len()).map(|j| entry(row, j)).collect()).collect()
}

fn each(matrix: &RationalMatrix, change: impl Fn(&Rational) -> Rational) -> RationalMatrix {
    matrix.iter().map(|row| row.iter().map(&change).collect()).collect()
}

fn added(left: RationalMatrix, right: &RationalMatrix) -> RationalMatrix {
    left.into_iter()
        .zip(right)
        .map(|(l, r)| l.into_iter().zip(r).map(|(x, y)| x + y).collect())
        .collect()
}

fn largest_row_sum(matrix: &RationalMatrix) -> Rational {
    let sum = |row: &Vec<Rational>| row.iter().fold(Rational::zero(), |sum, x| sum + x.abs());
    matrix.iter().map(sum).max().unwrap()
}

/// Computes e^{Xh} within 1e-30 in every entry, for a norm of Xh up to 100.
///
/// h is halved until the norm of Xh is at most 1, and the result is squared as often. The
/// truncation error of 70 terms and their rounding is below 2⁻³¹⁰. Each squaring multiplies an
/// error by at most twice the norm of the root, and all squarings together by at most 2⁷ e¹⁰⁰ <
/// 2¹⁵².
fn exponential(matrix: &RationalMatrix, h: &Rational) -> RationalMatrix {
    let x = each(matrix, |x| x * h);
    if largest_row_sum(&x) > Rational::one() {
        let root = exponential(matrix, &(h / integer(2)));
        return each(&multiply(&root, &root), rounded);
    }
    let n = matrix.len();
    let one = |i: usize, j: usize| if i == j { Rational::one() } else { Rational::zero() };
    let mut term: RationalMatrix = (0..n).map(|i| (0..n).map(|j| one(i, j)).collect()).collect();
    let mut sum = term.clone();
    for degree in 1..70 {
        term = each(&multiply(&term, &x), |x| rounded(&(x / integer(degree))));
        sum = added(sum, &term);
    }
    sum
}

/// Computes Φ = e^{Ah}, Γ(h) and γ(h) of the system as the rows [Φ Γ γ] of the exponential of
/// [A B d; 0 0 0].
pub(crate) fn exact_step(system: &LinearSystem, h: &Rational) -> RationalMatrix {
    let (n, m) = (system.states(), system.inputs());
    let entry = |i: usize, j: usize| match (i < n, j) {
        (false, _) => 0.0,
        (true, j) if j < n => system.a()[(i, j)],
        (true, j) if j < n + m => system.b()[(i, j - n)],
        (true, _) => system.drift()[i],
    };
    let size = n + m + 1;
    let augmented = (0..size).map(|i| (0..size).map(|j| exact(entry(i, j))).collect()).collect();
    exponential(&augmented, h).into_iter().take(n).collect()
}

/// Fails unless the interval contains the number, up to the precision of the reference.
pub(crate) fn assert_holds(x: Interval, value: &Rational, what: &str) {
    assert!(exact(x.lo()) <= value + tiny(), "{what}: {x:?} lies above {:?}", value.to_f64());
    assert!(exact(x.hi()) >= value - tiny(), "{what}: {x:?} lies below {:?}", value.to_f64());
}

/// Fails unless the matrix encloses columns `from..` of `rows`; returns its largest width.
pub(crate) fn assert_encloses(
    matrix: &IntervalMatrix,
    rows: &RationalMatrix,
    from: usize,
    what: &str,
) -> f64 {
    for i in 0..matrix.nrows() {
        for j in 0..matrix.ncols() {
            assert_holds(matrix[(i, j)], &rows[i][from + j], &format!("{what}[{i}, {j}]"));
        }
    }
    matrix.iter().map(|x| x.width()).fold(0.0, f64::max)
}

/// Returns the largest absolute entry.
pub(crate) fn largest(matrix: &IntervalMatrix) -> f64 {
    matrix.iter().map(|x| x.mag()).fold(0.0, f64::max)
}

/// Builds a system from the rows of its matrices.
pub(crate) fn system(a: &[&[f64]], b: &[&[f64]], drift: &[f64]) -> LinearSystem {
    let matrix = |rows: &[&[f64]]| DMatrix::from_fn(rows.len(), rows[0].len(), |i, j| rows[i][j]);
    LinearSystem::new(matrix(a), matrix(b), nalgebra::DVector::from_column_slice(drift))
        .expect("finite")
}
