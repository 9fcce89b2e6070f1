//! Bounds of the product of two homogeneous parts, as a difference of squares.

use super::bounds::inflated;
use crate::interval::closed::Interval;
use crate::taylor::polynomial::{Form, TaylorPolynomial};

/// Encloses the product x y over [-1, 1]^k, where x and y are the terms of one degree of two
/// polynomials. Their norms are N(x) = Σ |x_α| and N(y) = Σ |y_α|.
///
/// For any ν > 0, x y = ((x + ν y)² - (x - ν y)²) / 4ν. With ν = N(x) / N(y), this bound is within
/// ±N(x) N(y), the bound by norms, at about the same cost. It contains few negative numbers where x
/// and y are nearly positive multiples of each other, as in a square.
///
/// # Guarantee
///
/// Outer. N(x ± ν y) is computed with two roundings per term, an error of less than
/// 2ε (N(x) + ν N(y)) in total.
pub(super) fn product_of_parts(
    x: &TaylorPolynomial,
    y: &TaylorPolynomial,
    degree: u32,
    [norm_x, norm_y]: [f64; 2],
) -> Interval {
    let by_norms = Interval::centred(0.0, norm_x) * Interval::centred(0.0, norm_y);
    let is_moderate = |norm: f64| (1e-120..1e120).contains(&norm);
    if !is_moderate(norm_x) || !is_moderate(norm_y) {
        return by_norms;
    }
    let ratio = norm_x / norm_y;
    let Some(norms) = norms_of_sum_and_difference(x, y, degree, ratio) else { return by_norms };
    let slack = 8.0 * f64::EPSILON * norm_x;
    let [above, below] =
        norms.map(|norm| (Interval::point(norm) + slack).sqr() / Interval::point(4.0 * ratio));
    Interval::new(-below.hi(), above.hi())
        .and_then(|values| values.intersection(by_norms))
        .unwrap_or(by_norms)
}

/// Returns N(x + ν y) and N(x - ν y) over the terms of one degree, up to the rounding of each term.
/// It is `None` if the polynomials have different storage forms.
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

/// Visits the coefficients of each monomial in two sorted lists, with 0 where it does not occur.
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
