//! The type [`TaylorModel`]: constructors, accessors and range.

use super::bounds;
use crate::dispatch::Dispatch;
use crate::interval::closed::Interval;
use crate::powers::Powers;
use crate::taylor::polynomial::TaylorPolynomial;

/// A Taylor model: an enclosure of a function over a box by a truncated polynomial plus a remainder
/// interval, which is valid in the whole box.
///
/// The polynomial is a function of the normalised coordinates t ∈ [-1, 1]^k of the box: variable i
/// of a [`TaylorBox`](crate::TaylorBox) is mid_i + rad_i t_i. Operations truncate it at the order
/// of its [`TaylorSpace`](crate::TaylorSpace). The remainder encloses the truncation error and
/// every rounding error. A number belongs to every space, so that dynamics over
/// [`Scalar`](crate::Scalar) can be evaluated over Taylor models.
///
/// The remainder is [`Interval::ENTIRE`] where an operation has no bound, such as a quotient by a
/// model whose range contains zero. Coefficients are always finite.
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
/// Operations panic where the operands belong to spaces that differ in variables or order. A
/// quotient panics where its dense series does not fit
/// ([`TaylorSpace::check_dense`](crate::TaylorSpace::check_dense)).
///
/// # Examples
///
/// ```
/// use reachtube_scalar::{Elementary, Interval, TaylorBox, TaylorSpace};
///
/// let space = TaylorSpace::new(1, 5).unwrap();
/// let joint = TaylorBox::new(&space, &[Interval::new(0.4, 0.6).unwrap()]);
/// let (sin, cos) = joint.variable(0).sin_cos();
/// assert!(sin.remainder().mag() < 2e-9);
/// assert!(joint.evaluate(&sin, &[Interval::point(0.45)]).contains(0.45f64.sin()));
/// // Both depend on the same angle. Interval arithmetic would give a width of 0.27.
/// assert!((sin.clone() * sin + cos.clone() * cos).range().width() < 4e-7);
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

    /// Returns the number that the model equals exactly; `None` where it depends on t or has a
    /// remainder.
    pub(super) fn as_number(&self) -> Option<f64> {
        let is_exact = self.polynomial.space().is_none() && self.remainder == Interval::ZERO;
        is_exact.then(|| self.polynomial.constant_term())
    }

    /// Returns the model with `more` added to the remainder.
    pub(super) fn widened(self, more: Interval) -> Self {
        Self::new(self.polynomial, self.remainder + more)
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
    /// Returns the polynomial in t exactly, or a model without bounds where a coefficient is
    /// infinite or NaN.
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

impl Powers for TaylorModel {}

impl Dispatch for TaylorModel {}
