use core::fmt::Debug;
use core::ops::{AddAssign, Div, DivAssign, MulAssign, Neg, SubAssign};
use num_traits::{One, Zero};

use crate::dispatch::Dispatch;

/// A number type over which the dynamics of a robot can be evaluated.
///
/// `f64`, [`Interval`](crate::Interval), SIMD [`Lanes`](crate::Lanes) and
/// [`TaylorPolynomial`](crate::TaylorPolynomial) are scalars. The trait requires ring operations,
/// division and conversion of constants.
///
/// It does not require sine and cosine. The dynamics take (sin q, cos q) as arguments and can so be
/// evaluated over independent trigonometric variables (Property A of Liu & Althoff, IROS 2018).
///
/// # Examples
///
/// ```
/// use reachtube_scalar::{Interval, Scalar};
///
/// fn horner<S: Scalar>(x: S) -> S {
///     (x.clone() + S::from(2.0)) * x
/// }
/// assert_eq!(horner(3.0), 15.0);
/// assert!(horner(Interval::point(3.0)).contains(15.0));
/// ```
pub trait Scalar:
    Clone
    + Debug
    + PartialEq
    + Zero
    + One
    + Neg<Output = Self>
    + core::ops::Sub<Output = Self>
    + Div<Output = Self>
    + AddAssign
    + SubAssign
    + MulAssign
    + DivAssign
    + From<f64>
    + Dispatch
    + 'static
{
}

impl<S> Scalar for S where
    S: Clone
        + Debug
        + PartialEq
        + Zero
        + One
        + Neg<Output = S>
        + core::ops::Sub<Output = S>
        + Div<Output = S>
        + AddAssign
        + SubAssign
        + MulAssign
        + DivAssign
        + From<f64>
        + Dispatch
        + 'static
{
}
