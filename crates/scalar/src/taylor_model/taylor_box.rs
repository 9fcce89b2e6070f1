//! The box that Taylor models are defined over.

use std::sync::Arc;

use super::model::TaylorModel;
use crate::interval::closed::Interval;
use crate::taylor::polynomial::TaylorPolynomial;
use crate::taylor::space::TaylorSpace;

/// A box of k intervals. [`TaylorModel`]s are polynomials in its normalised coordinates.
///
/// # Examples
///
/// ```
/// use reachtube_scalar::{Interval, TaylorBox, TaylorSpace};
///
/// let space = TaylorSpace::new(2, 2).unwrap();
/// let sides = [Interval::new(1.0, 2.0).unwrap(), Interval::new(-1.0, 1.0).unwrap()];
/// let domain = TaylorBox::new(&space, &sides);
/// let f = domain.variable(0) * domain.variable(1);
/// let value = domain.evaluate(&f, &[1.5.into(), 0.5.into()]);
/// assert!(value.contains(0.75) && value.width() < 1e-14);
/// ```
#[derive(Clone, Debug)]
pub struct TaylorBox {
    space: Arc<TaylorSpace>,
    sides: Vec<Interval>,
}

impl TaylorBox {
    /// Returns the box with the given sides (k intervals, one per variable of the space), each in
    /// the unit of its variable.
    ///
    /// # Panics
    ///
    /// Panics if the number of sides differs from the number of variables.
    pub fn new(space: &Arc<TaylorSpace>, sides: &[Interval]) -> Self {
        assert_eq!(sides.len(), space.variables(), "a box needs one side per variable");
        Self { space: Arc::clone(space), sides: sides.to_vec() }
    }

    /// Returns variable i as the model mid_i + rad_i t_i.
    ///
    /// A point is a constant. An unbounded side becomes a remainder.
    ///
    /// # Guarantee
    ///
    /// Exact, with a zero remainder, where the side is bounded and the order is not 0. Every point
    /// of the side has a t_i in [-1, 1].
    ///
    /// # Panics
    ///
    /// Panics if the space has no variable i.
    pub fn variable(&self, i: usize) -> TaylorModel {
        let (side, order) = (self.sides[i], self.space.order());
        let (mid, rad) = (side.mid(), side.rad());
        if rad == 0.0 || rad == f64::INFINITY || order == 0 {
            return TaylorModel::from(side);
        }
        let mut terms = vec![(0, mid), (self.space.packing.variable(i), rad)];
        terms.retain(|(_, c)| *c != 0.0);
        TaylorModel::new(TaylorPolynomial::sparse(&self.space, terms), Interval::ZERO)
    }

    /// Returns all variables as models (k entries).
    pub fn variables(&self) -> Vec<TaylorModel> {
        (0..self.sides.len()).map(|i| self.variable(i)).collect()
    }

    /// Encloses the values of a model over the box `at` (k intervals), in the units of the sides.
    ///
    /// # Guarantee
    ///
    /// Outer, for every point of `at`. The result is [`Interval::ENTIRE`] if `at` is not a subset
    /// of this box, because a model is valid only inside it.
    ///
    /// # Panics
    ///
    /// Panics if `at` does not have one entry per variable.
    pub fn evaluate(&self, model: &TaylorModel, at: &[Interval]) -> Interval {
        assert_eq!(at.len(), self.sides.len(), "an evaluation needs one argument per variable");
        if !self.sides.iter().zip(at).all(|(side, x)| side.encloses(x)) {
            return Interval::ENTIRE;
        }
        let t: Vec<Interval> =
            self.sides.iter().zip(at).map(|(side, x)| normalised(*side, *x)).collect();
        model.polynomial().evaluate(&t) + model.remainder()
    }
}

/// Encloses the normalised coordinate t with x = mid + rad t, for x within the side.
fn normalised(side: Interval, x: Interval) -> Interval {
    let rad = side.rad();
    if rad == 0.0 || rad == f64::INFINITY {
        return Interval::ZERO; // no polynomial depends on this variable
    }
    let t = (x - side.mid()) / Interval::point(rad);
    // x is within the side, so that t can leave [-1, 1] only by rounding.
    t.max(Interval::point(-1.0)).min(Interval::ONE)
}
