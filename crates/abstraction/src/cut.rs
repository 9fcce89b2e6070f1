//! Choice of the joint whose range of positions is cut.

use nalgebra::DMatrix;
use reachtube_scalar::{Interval, TaylorModel, TaylorPolynomial};

use crate::equations::position_variables;

/// Returns the two halves of a box of positions, n sides, cut at the middle of side `joint`; `None`
/// where there is no number between its ends.
pub(crate) fn halves(sides: &[Interval], joint: usize) -> Option<[Vec<Interval>; 2]> {
    let side = sides[joint];
    let middle = Interval::point(side.mid());
    let part = |end: f64| {
        let mut sides = sides.to_vec();
        sides[joint] = middle.hull(Interval::point(end));
        sides
    };
    let is_divisible = side.lo() < side.mid() && side.mid() < side.hi();
    is_divisible.then(|| [part(side.lo()), part(side.hi())])
}

/// Width above which a side is cut first, rad or m: a Taylor series in a wider angle says little.
const WIDE_SIDE: f64 = 1.0;

/// Returns the joint along whose position the mass matrix, row-major n x n, changes most.
///
/// The change is measured on P M, where P is the inverse of M in the middle of the box. Entry (i,
/// j) is scaled by the inertias of the joints, because it maps an acceleration of j to one of i.
pub(crate) fn stiffest(mass: &[TaylorModel], sides: &[Interval]) -> usize {
    let n = sides.len();
    let joint = widest(sides);
    if sides[joint].width() > WIDE_SIDE {
        return joint;
    }
    let middle = DMatrix::from_fn(n, n, |i, j| mass[i * n + j].polynomial().constant_term());
    let Some(inverse) = middle.clone().try_inverse() else { return joint };
    let mut change = vec![0.0; n];
    for (i, j) in (0..n * n).map(|ij| (ij / n, ij % n)) {
        let terms = (0..n).map(|k| mass[k * n + j].polynomial().scaled(&inverse[(i, k)]));
        let product = terms.fold(TaylorPolynomial::from(0.0), |sum, term| sum + term);
        let scale = (middle[(i, i)] / middle[(j, j)]).abs().sqrt();
        add_terms_above(&product, 0, scale, &mut change);
    }
    largest(&change).unwrap_or(joint)
}

/// Returns the joint along whose position the model bends most; a linear part is bounded exactly
/// and needs no cut.
pub(crate) fn most_curved(model: &TaylorModel, sides: &[Interval]) -> usize {
    let mut curvature = vec![0.0; sides.len()];
    add_terms_above(model.polynomial(), 1, 1.0, &mut curvature);
    largest(&curvature).unwrap_or_else(|| widest(sides))
}

/// Adds `scale` |c| of each term above `degree` to the joints on whose positions it depends. The
/// positions are the first variables of the polynomial.
fn add_terms_above(polynomial: &TaylorPolynomial, degree: u32, scale: f64, joints: &mut [f64]) {
    let positions = position_variables(joints.len());
    for term in polynomial.terms() {
        if term.exponents.iter().map(|e| u32::from(*e)).sum::<u32>() > degree {
            let factors = term.exponents.iter().zip(&mut joints[positions.clone()]);
            factors
                .filter(|(e, _)| **e > 0)
                .for_each(|(_, sum)| *sum += scale * term.coefficient.abs());
        }
    }
}

/// Returns the index of the largest value, where it is above 0.
fn largest(values: &[f64]) -> Option<usize> {
    let index = (0..values.len()).max_by(|i, j| values[*i].total_cmp(&values[*j]))?;
    (values[index] > 0.0).then_some(index)
}

/// Returns the joint with the widest side among the joints that M_m depends on.
fn widest(sides: &[Interval]) -> usize {
    let width = |i: &usize| sides[*i].width();
    position_variables(sides.len()).max_by(|i, j| width(i).total_cmp(&width(j))).unwrap_or(0)
}
