use core::fmt::Debug;
use core::ops::{AddAssign, Div, DivAssign, MulAssign, Neg, SubAssign};
use num_traits::{One, Zero};

/// A number that the dynamics of a robot can be evaluated over: `f64`,
/// [`Interval`](crate::Interval), SIMD [`Lanes`](crate::Lanes), and later Taylor polynomials.
///
/// Only ring operations, division and conversion of constants are asked for. Sine and cosine are
/// not: dynamics takes (sin q, cos q) as given, so that it can be evaluated over independent
/// trigonometric variables (Property A of Liu & Althoff, IROS 2018).
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
        + 'static
{
}
