//! A product of two homogeneous parts is a difference of squares.

use super::bounds::inflated;
use crate::taylor::Form;
use crate::{Interval, TaylorPolynomial};

/// The values over [-1, 1]^k of the product x y of the terms of one degree of two polynomials of a
/// space, of which the norms Σ |x_α|, Σ |y_α| are known.
///
/// x y = ((x + ν y)² - (x - ν y)²) / 4ν for any ν > 0. With ν = N(x) / N(y) that lies in the ±N(x)
/// N(y) which the norms alone tell, is nearly free of negative numbers where x and y are nearly
/// multiples of each other, as in a square, and costs no more than the norms.
///
/// # Guarantee
///
/// Outer. N(x ± ν y) is computed with two roundings a term, which is less than 2ε (N(x) + ν N(y))
/// in all.
pub(super) fn product_of_parts(
    x: &TaylorPolynomial,
    y: &TaylorPolynomial,
    degree: u32,
    [of_x, of_y]: [f64; 2],
) -> Interval {
    let by_norms = Interval::centered(0.0, of_x) * Interval::centered(0.0, of_y);
    let is_moderate = |norm: f64| (1e-120..1e120).contains(&norm);
    if !is_moderate(of_x) || !is_moderate(of_y) {
        return by_norms;
    }
    let ratio = of_x / of_y;
    let Some(norms) = norms_of_sum_and_difference(x, y, degree, ratio) else { return by_norms };
    let slack = 8.0 * f64::EPSILON * of_x;
    let [above, below] =
        norms.map(|norm| (Interval::point(norm) + slack).sqr() / Interval::point(4.0 * ratio));
    Interval::new(-below.hi(), above.hi())
        .and_then(|values| values.intersection(by_norms))
        .unwrap_or(by_norms)
}

/// N(x + ν y) and N(x - ν y) of the terms of one degree, up to rounding of their terms; `None`
/// where one polynomial is dense and the other is not.
fn norms_of_sum_and_difference(
    x: &TaylorPolynomial,
    y: &TaylorPolynomial,
    degree: u32,
    ratio: f64,
) -> Option<[f64; 2]> {
    let (mut sums, mut differences, mut count) = (0.0, 0.0, 0);
    let mut add = |x: f64, y: f64| {
        let y = ratio * y;
        sums += (x + y).abs();
        differences += (x - y).abs();
        count += 1;
    };
    match (&x.form, &y.form) {
        (Form::Dense(space, x), Form::Dense(_, y)) => {
            let block = space.block(degree);
            if block.end > x.len().min(y.len()) {
                return None;
            }
            x[block.clone()].iter().zip(&y[block]).for_each(|(x, y)| add(*x, *y));
        }
        (Form::Sparse(space, x), Form::Sparse(_, y)) => {
            let of_degree = |terms: &[(u128, f64)]| {
                let below =
                    |degree| terms.partition_point(|(m, _)| space.packing.degree(*m) < degree);
                below(degree)..below(degree + 1)
            };
            merge(&x[of_degree(x)], &y[of_degree(y)], add);
        }
        _ => return None,
    }
    Some([sums, differences].map(|norm| inflated(norm, count)))
}

/// Visits the coefficients of two sorted lists, 0 where one has no such monomial.
fn merge(mut x: &[(u128, f64)], mut y: &[(u128, f64)], mut visit: impl FnMut(f64, f64)) {
    loop {
        match (x, y) {
            ([(m, a), rest @ ..], [(n, b), others @ ..]) if m == n => {
                visit(*a, *b);
                (x, y) = (rest, others);
            }
            ([(m, a), rest @ ..], [(n, _), ..]) if m < n => {
                visit(*a, 0.0);
                x = rest;
            }
            (_, [(_, b), others @ ..]) => {
                visit(0.0, *b);
                y = others;
            }
            ([(_, a), rest @ ..], []) => {
                visit(*a, 0.0);
                x = rest;
            }
            ([], []) => return,
        }
    }
}
