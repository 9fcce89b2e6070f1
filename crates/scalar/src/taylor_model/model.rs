//! The type [`TaylorModel`]: constructors, accessors and range.

use super::bounds;
use crate::interval::closed::Interval;
use crate::taylor::polynomial::TaylorPolynomial;

/// A Taylor model: an enclosure of a function over a box by a truncated polynomial plus a remainder
/// interval, which is valid in the whole box.
///
/// The polynomial is a function of the normalised coordinates t ∈ [-1, 1]^k of the box: variable i
/// of a [`TaylorBox`](crate::TaylorBox) is mid_i + rad_i t_i. Operations truncate it at the order
/// of its [`TaylorSpace`](crate::TaylorSpace). The remainder encloses the truncation error and
/// every rounding error. A number belongs to every space.
///
/// The remainder is [`Interval::ENTIRE`] if an operation has no bound. Coefficients are always
/// finite.
///
/// Makino, Berz: Taylor models and other validated functional inclusion methods, Int. J. Pure Appl.
/// Math. 4 (2003).
///
/// # Guarantee
///
/// Every operation is outer. At each point of the box, take any values that the operands enclose:
/// the exact result lies in polynomial + remainder. The polynomial is meant exactly, because the
/// remainder covers all rounding errors.
///
/// # Panics
///
/// Operations panic where the operands belong to spaces that differ in variables or order.
///
/// # Examples
///
/// ```
/// use reachtube_scalar::{Interval, TaylorBox, TaylorSpace};
///
/// let space = TaylorSpace::new(1, 3).unwrap();
/// let side = TaylorBox::new(&space, &[Interval::new(0.4, 0.6).unwrap()]);
/// let x = side.variable(0);
/// let square = &x * &x;
/// assert!(square.remainder().mag() < 1e-15);
/// assert!(side.evaluate(&square, &[Interval::point(0.45)]).contains(0.45 * 0.45));
/// // Both factors are the same number. Interval arithmetic would give a width of 0.4.
/// assert!((square - &x * &x).range().width() < 1e-14);
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct TaylorModel {
    pub(super) polynomial: TaylorPolynomial<f64>,
    pub(super) remainder: Interval,
}

impl TaylorModel {
    /// Returns the model with a polynomial in t, whose coefficients must be finite, and a
    /// remainder.
    pub(super) fn new(polynomial: TaylorPolynomial<f64>, remainder: Interval) -> Self {
        if remainder == Interval::ENTIRE { Self::entire() } else { Self { polynomial, remainder } }
    }

    /// Returns the model without bounds, with the remainder [`Interval::ENTIRE`].
    pub(super) fn entire() -> Self {
        Self { polynomial: TaylorPolynomial::constant(0.0), remainder: Interval::ENTIRE }
    }

    /// Returns the polynomial in t ∈ [-1, 1]^k; its coefficients are finite.
    pub fn polynomial(&self) -> &TaylorPolynomial<f64> {
        &self.polynomial
    }

    /// Returns the remainder, which bounds the error of the polynomial over the whole box.
    pub fn remainder(&self) -> Interval {
        self.remainder
    }

    /// Encloses the range over the box.
    ///
    /// The bound uses that a monomial with even exponents is not negative.
    ///
    /// # Guarantee
    ///
    /// Outer. The range of the polynomial is exact up to rounding where each non-linear term is the
    /// square of a variable that does not occur in any other term.
    pub fn range(&self) -> Interval {
        bounds::range(&self.polynomial) + self.remainder
    }

    /// Returns the number that the model equals exactly; `None` if it depends on t or has a
    /// remainder.
    pub(super) fn as_number(&self) -> Option<f64> {
        let is_exact = self.polynomial.space().is_none() && self.remainder == Interval::ZERO;
        is_exact.then(|| self.polynomial.constant_term())
    }
}

impl From<f64> for TaylorModel {
    /// Returns the number x exactly, or a model without bounds where x is infinite or NaN.
    fn from(x: f64) -> Self {
        if x.is_finite() {
            Self { polynomial: TaylorPolynomial::constant(x), remainder: Interval::ZERO }
        } else {
            Self::entire()
        }
    }
}

impl From<TaylorPolynomial> for TaylorModel {
    /// Returns the polynomial in t exactly, or a model without bounds if a coefficient is infinite
    /// or NaN.
    fn from(polynomial: TaylorPolynomial) -> Self {
        if polynomial.is_finite() {
            Self { polynomial, remainder: Interval::ZERO }
        } else {
            Self::entire()
        }
    }
}

impl From<Interval> for TaylorModel {
    /// Returns an unknown number of the interval, as its midpoint and a remainder.
    ///
    /// # Guarantee
    ///
    /// Outer; exact for a point.
    fn from(x: Interval) -> Self {
        if x.lo().is_infinite() || x.hi().is_infinite() {
            return Self::new(TaylorPolynomial::constant(0.0), x);
        }
        Self::new(TaylorPolynomial::constant(x.mid()), x - x.mid())
    }
}
