//! The box that models are made over.

use std::sync::Arc;

use super::TaylorModel;
use crate::{Interval, TaylorPolynomial, TaylorSpace};

/// A box of k intervals, in the coordinates of which [`TaylorModel`]s are polynomials.
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
    /// The box with the given sides, one a variable of the space, in the user's units.
    ///
    /// # Panics
    ///
    /// Where there is not one side a variable.
    pub fn new(space: &Arc<TaylorSpace>, sides: &[Interval]) -> Self {
        assert_eq!(sides.len(), space.variables(), "one side a variable");
        Self { space: Arc::clone(space), sides: sides.to_vec() }
    }

    /// The space of the models' polynomials.
    pub fn space(&self) -> &Arc<TaylorSpace> {
        &self.space
    }

    /// The sides, one a variable.
    pub fn sides(&self) -> &[Interval] {
        &self.sides
    }

    /// Variable i: mid + rad t_i. A point is a constant; of a side without end nothing more is
    /// known.
    ///
    /// # Guarantee
    ///
    /// Exact, without a remainder, where the side is bounded and the order not 0; t_i in [-1, 1]
    /// reaches every point of the side.
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

    /// All variables.
    pub fn variables(&self) -> Vec<TaylorModel> {
        (0..self.sides.len()).map(|i| self.variable(i)).collect()
    }

    /// The values of a model at points of the box, given in the coordinates of its sides.
    ///
    /// # Guarantee
    ///
    /// Outer, for every point of `at` as a box; [`Interval::ENTIRE`] where that is not part of this
    /// box, for a model says nothing beyond.
    ///
    /// # Panics
    ///
    /// Where `at` has not one entry a variable.
    pub fn evaluate(&self, model: &TaylorModel, at: &[Interval]) -> Interval {
        assert_eq!(at.len(), self.sides.len(), "one argument a variable");
        if !self.sides.iter().zip(at).all(|(side, x)| side.encloses(x)) {
            return Interval::ENTIRE;
        }
        let t: Vec<Interval> =
            self.sides.iter().zip(at).map(|(side, x)| coordinate(*side, *x)).collect();
        model.polynomial().evaluate(&t) + model.remainder()
    }
}

/// t with x = mid + rad t, for x within the side.
fn coordinate(side: Interval, x: Interval) -> Interval {
    let rad = side.rad();
    if rad == 0.0 || rad == f64::INFINITY {
        return Interval::ZERO; // no polynomial depends on it
    }
    let t = (x - side.mid()) / Interval::point(rad);
    // Rounding alone can leave [-1, 1], for x is within the side.
    t.max(Interval::point(-1.0)).min(Interval::ONE)
}
