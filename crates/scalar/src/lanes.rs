//! Several numbers as one: SIMD lanes.

use core::ops::{Add, AddAssign, Div, DivAssign, Mul, MulAssign, Neg, Sub, SubAssign};

use num_traits::{One, Zero};

use crate::dispatch::{Dispatch, Kernel, vectorised};
use crate::powers::Powers;
use crate::sine_cosine::SineCosine;

/// A scalar of N independent `f64` lanes for SIMD instructions.
///
/// An algorithm over [`Scalar`](crate::Scalar) evaluates N arguments at once over lanes. The
/// compiler translates the loops over lanes to the vector instructions of the target. The code does
/// not depend on the platform.
///
/// Each lane has the value of the same operation on `f64`, to the last bit. No operation crosses
/// lanes: an overflow or a division by zero in one lane does not affect the others.
///
/// # Examples
///
/// ```
/// use reachtube_scalar::Lanes;
///
/// let x = Lanes::new([1.0, 2.0, 3.0, 0.0]);
/// assert_eq!(x * x + Lanes::from(1.0), Lanes::new([2.0, 5.0, 10.0, 1.0]));
/// assert_eq!((Lanes::from(6.0) / x).to_array(), [6.0, 3.0, 2.0, f64::INFINITY]);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(align(32))]
pub struct Lanes<const N: usize>([f64; N]);

/// A scalar of one or more independent `f64`: `f64` itself and [`Lanes`].
///
/// It adds functions of single lanes to [`SineCosine`], for algorithms with branches.
///
/// # Examples
///
/// ```
/// use reachtube_scalar::{Lanes, Lanewise};
///
/// fn sign<S: Lanewise>(x: S) -> S {
///     x.map(|x| if x < 0.0 { -1.0 } else { 1.0 })
/// }
/// assert_eq!(sign(-3.0), -1.0);
/// assert_eq!(sign(Lanes::new([-3.0, 5.0])), Lanes::new([-1.0, 1.0]));
/// ```
pub trait Lanewise: SineCosine + Copy {
    /// The number of lanes, 1 or more.
    const LANES: usize;

    /// Returns a scalar whose lane i is f(i).
    fn from_lanes(f: impl FnMut(usize) -> f64) -> Self;

    /// Returns lane i.
    ///
    /// # Panics
    ///
    /// Panics if `i` is [`LANES`](Self::LANES) or more.
    fn lane(self, i: usize) -> f64;

    /// Applies f to each lane.
    #[inline(always)]
    fn map(self, mut f: impl FnMut(f64) -> f64) -> Self {
        Self::from_lanes(|i| f(self.lane(i)))
    }

    /// Applies f to each lane and the same lane of `other`.
    #[inline(always)]
    fn zip(self, other: Self, mut f: impl FnMut(f64, f64) -> f64) -> Self {
        Self::from_lanes(|i| f(self.lane(i), other.lane(i)))
    }
}

impl Lanewise for f64 {
    const LANES: usize = 1;

    #[inline(always)]
    fn from_lanes(mut f: impl FnMut(usize) -> f64) -> Self {
        f(0)
    }

    #[inline(always)]
    fn lane(self, i: usize) -> f64 {
        assert_eq!(i, 0, "an f64 has one lane");
        self
    }
}

impl<const N: usize> Lanewise for Lanes<N> {
    const LANES: usize = N;

    #[inline(always)]
    fn from_lanes(f: impl FnMut(usize) -> f64) -> Self {
        Self(core::array::from_fn(f))
    }

    #[inline(always)]
    fn lane(self, i: usize) -> f64 {
        self.0[i]
    }
}

impl<const N: usize> SineCosine for Lanes<N> {
    #[inline]
    fn sin_cos(&self) -> (Self, Self) {
        (self.map(f64::sin), self.map(f64::cos))
    }
}

impl<const N: usize> Powers for Lanes<N> {}

/// On x86-64, kernels over lanes take AVX2 if the processor has it.
impl<const N: usize> Dispatch for Lanes<N> {
    #[inline(always)]
    fn dispatch<K: Kernel>(kernel: K) -> K::Output {
        vectorised(kernel)
    }
}

impl<const N: usize> Lanes<N> {
    /// Returns a scalar whose lane i is `lanes[i]`.
    #[inline(always)]
    #[must_use]
    pub const fn new(lanes: [f64; N]) -> Self {
        Self(lanes)
    }

    /// Returns the lanes as an array.
    #[inline(always)]
    #[must_use]
    pub const fn to_array(self) -> [f64; N] {
        self.0
    }
}

impl<const N: usize> From<f64> for Lanes<N> {
    /// Returns the same number in every lane.
    #[inline(always)]
    fn from(x: f64) -> Self {
        Self([x; N])
    }
}

impl<const N: usize> Neg for Lanes<N> {
    type Output = Self;
    #[inline(always)]
    fn neg(mut self) -> Self {
        self.0.iter_mut().for_each(|x| *x = -*x);
        self
    }
}

macro_rules! lane_by_lane {
    ($($Op:ident $op:ident $OpAssign:ident $op_assign:ident)*) => {$(
        impl<const N: usize> $Op for Lanes<N> {
            type Output = Self;
            #[inline(always)]
            fn $op(mut self, rhs: Self) -> Self {
                self.$op_assign(rhs);
                self
            }
        }
        impl<const N: usize> $OpAssign for Lanes<N> {
            #[inline(always)]
            fn $op_assign(&mut self, rhs: Self) {
                for (x, y) in self.0.iter_mut().zip(&rhs.0) {
                    x.$op_assign(*y);
                }
            }
        }
    )*};
}
lane_by_lane! {
    Add add AddAssign add_assign
    Sub sub SubAssign sub_assign
    Mul mul MulAssign mul_assign
    Div div DivAssign div_assign
}

impl<const N: usize> Zero for Lanes<N> {
    #[inline(always)]
    fn zero() -> Self {
        Self([0.0; N])
    }

    /// Returns whether every lane is 0.
    #[inline(always)]
    fn is_zero(&self) -> bool {
        self.0.iter().all(|x| *x == 0.0)
    }
}

impl<const N: usize> One for Lanes<N> {
    #[inline(always)]
    fn one() -> Self {
        Self([1.0; N])
    }
}
