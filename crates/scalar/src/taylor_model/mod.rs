//! Taylor models: polynomials with a proved bound of what they leave out.

mod arithmetic;
mod bounds;
mod division;
mod functions;
mod polarisation;
mod product;
mod taylor_box;
mod tight;

pub use taylor_box::TaylorBox;

use crate::{Interval, Powers, TaylorPolynomial};

/// A function over a box as a truncated polynomial plus an interval that holds the rest, wherever
/// in the box.
///
/// The polynomial is one in t ∈ [-1, 1]^k, the box's coordinates: variable i of a [`TaylorBox`] is
/// mid_i + rad_i t_i. Operations truncate it to the order of its
/// [`TaylorSpace`](crate::TaylorSpace) and put into the remainder what was cut off and every
/// rounding error. A number belongs to every space, so that dynamics written over
/// [`Scalar`](crate::Scalar) runs over models.
///
/// What nothing is known of, as the quotient by a model whose range holds zero, has the remainder
/// [`Interval::ENTIRE`]; coefficients are always finite.
///
/// Makino, Berz: Taylor models and other validated functional inclusion methods, Int. J. Pure Appl.
/// Math. 4 (2003).
///
/// # Guarantee
///
/// Every operation is outer: at each point of the box the exact value of the operation, on any
/// values that the operands enclose there, lies in polynomial + remainder. The polynomial is taken
/// exactly: rounding is in the remainder.
///
/// # Panics
///
/// As [`TaylorPolynomial`]: where operands belong to spaces that differ in variables or order, and
/// where a quotient would need a dense series that does not fit
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
/// // The same angle in both: intervals would give a width of 0.27.
/// assert!((sin.clone() * sin + cos.clone() * cos).range().width() < 4e-7);
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct TaylorModel {
    polynomial: TaylorPolynomial<f64>,
    remainder: Interval,
}

impl TaylorModel {
    /// A polynomial in t with finite coefficients, and a remainder.
    fn new(polynomial: TaylorPolynomial<f64>, remainder: Interval) -> Self {
        if remainder == Interval::ENTIRE { Self::unknown() } else { Self { polynomial, remainder } }
    }

    /// All that is known is that it is real.
    fn unknown() -> Self {
        Self { polynomial: TaylorPolynomial::constant(0.0), remainder: Interval::ENTIRE }
    }

    /// The polynomial in t ∈ [-1, 1]^k; its coefficients are finite.
    pub fn polynomial(&self) -> &TaylorPolynomial<f64> {
        &self.polynomial
    }

    /// What the polynomial leaves out, over the whole box.
    pub fn remainder(&self) -> Interval {
        self.remainder
    }

    /// The values over the box.
    ///
    /// # Guarantee
    ///
    /// Outer; of the polynomial alone, exact but for rounding where its non-linear terms are
    /// squares of variables of their own. Terms whose exponents are all even are not negative,
    /// which is used.
    pub fn range(&self) -> Interval {
        bounds::range(&self.polynomial) + self.remainder
    }

    /// The number that the model is, exactly; `None` where it depends on t or is not exact.
    fn as_number(&self) -> Option<f64> {
        let is_exact = self.polynomial.space().is_none() && self.remainder == Interval::ZERO;
        is_exact.then(|| self.polynomial.constant_term())
    }

    /// The same polynomial with `more` in the remainder.
    fn widened(self, more: Interval) -> Self {
        Self::new(self.polynomial, self.remainder + more)
    }
}

impl From<f64> for TaylorModel {
    /// The number x exactly; nothing is known where it is infinite or NaN.
    fn from(x: f64) -> Self {
        if x.is_finite() {
            Self { polynomial: TaylorPolynomial::constant(x), remainder: Interval::ZERO }
        } else {
            Self::unknown()
        }
    }
}

impl From<TaylorPolynomial> for TaylorModel {
    /// The polynomial in t exactly; nothing is known where a coefficient is infinite or NaN.
    fn from(polynomial: TaylorPolynomial) -> Self {
        if polynomial.is_finite() {
            Self { polynomial, remainder: Interval::ZERO }
        } else {
            Self::unknown()
        }
    }
}

impl From<Interval> for TaylorModel {
    /// An unknown number of the interval, as its middle and a remainder.
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
