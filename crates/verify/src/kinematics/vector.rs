//! Vectors and matrices of three dimensions over intervals.

use reachtube_scalar::Interval;
use reachtube_scalar::rounding::{add_up, mul_up, sqrt_up};

/// A vector.
pub(crate) type Vector = [Interval; 3];

/// A matrix, by its rows.
pub(crate) type Matrix = [Vector; 3];

pub(crate) fn point(v: [f64; 3]) -> Vector {
    v.map(Interval::point)
}

pub(crate) fn add(a: &Vector, b: &Vector) -> Vector {
    core::array::from_fn(|i| a[i] + b[i])
}

pub(crate) fn sub(a: &Vector, b: &Vector) -> Vector {
    core::array::from_fn(|i| a[i] - b[i])
}

pub(crate) fn scaled(a: &Vector, by: Interval) -> Vector {
    a.map(|x| times(x, by))
}

pub(crate) fn cross(a: &Vector, b: &Vector) -> Vector {
    let minor = |i: usize, j: usize| times(a[i], b[j]) - times(a[j], b[i]);
    [minor(1, 2), minor(2, 0), minor(0, 1)]
}

pub(crate) fn image(m: &Matrix, v: &Vector) -> Vector {
    core::array::from_fn(|i| dot(&m[i], v))
}

pub(crate) fn product(a: &Matrix, b: &Matrix) -> Matrix {
    let column = |j: usize| [b[0][j], b[1][j], b[2][j]];
    let columns = [column(0), column(1), column(2)];
    core::array::from_fn(|i| core::array::from_fn(|j| dot(&a[i], &columns[j])))
}

pub(crate) fn dot(a: &Vector, b: &Vector) -> Interval {
    let mut sum = Interval::ZERO;
    for (x, y) in a.iter().zip(b) {
        sum = plus(sum, times(*x, *y));
    }
    sum
}

/// Returns an upper bound of the Euclidean norm.
pub(crate) fn norm(v: &Vector) -> f64 {
    norm_of_bounds(v.map(Interval::mag))
}

/// Returns an upper bound of the Euclidean norm of a vector whose entries are at most these.
pub(crate) fn norm_of_bounds(v: [f64; 3]) -> f64 {
    sqrt_up(v.into_iter().fold(0.0, |sum, x| add_up(sum, mul_up(x, x))))
}

/// Multiplies two numbers. Most entries of a robot's constant matrices are 0 or 1, for which the
/// product is exact and costs nothing.
pub(crate) fn times(a: Interval, b: Interval) -> Interval {
    if a == Interval::ZERO || b == Interval::ZERO {
        Interval::ZERO
    } else if a == Interval::ONE {
        b
    } else if b == Interval::ONE {
        a
    } else {
        a * b
    }
}

fn plus(a: Interval, b: Interval) -> Interval {
    if b == Interval::ZERO { a } else { a + b }
}
